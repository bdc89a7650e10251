// PL-81: with any commands, no two movers ever overlap. Random worlds and commands; the check in every cycle only uses
// rectangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "../core/trials.h"
#include "parts_rig.h"

namespace takt::engine {
namespace {

struct Box {
  double x = 0, y = 0, c = 0;  // [mm], [deg]
  double width = 0, height = 0;
};

// Returns the distance of two rectangles along one of their sides; below 0: overlap.
double Apart(const Box& a, const Box& b) {
  double most = -1e9;
  for (const double c : {a.c, a.c + 90, b.c, b.c + 90}) {
    const double x = std::cos(c * M_PI / 180), y = std::sin(c * M_PI / 180);
    const auto half = [&](const Box& box) {
      const double t = (box.c - c) * M_PI / 180;
      return (box.width * std::abs(std::cos(t)) + box.height * std::abs(std::sin(t))) / 2;
    };
    most = std::max(most, std::abs((b.x - a.x) * x + (b.y - a.y) * y) - half(a) - half(b));
  }
  return most;
}

// Lines and a ring that cross one another without a node, a fork and a track back across them all; movers of many
// sizes, rotated, on tracks and beside them.
class RandomWorld {
 public:
  // Every second world has a group of all movers, whose moves wait for their area in turn.
  explicit RandomWorld(std::uint32_t seed) : waits_(seed % 2 == 0), random_(seed), rig(MachineText()) {
    rig.each_cycle = [this] { Look(); };
    for (const track::TrackParams& track : rig.machine.tracks) rig.Give(track.name, "enable");
    for (const mover::MoverParams& mover : rig.machine.movers) rig.Give(mover.name, "enable");
    rig.Run(5);
    if (waits_ || Whole(0, 2) == 0) rig.Give("cell", "enable");
  }

  void Go(int steps) {
    for (int i = 0; i < steps && !testing::Test::HasFailure(); ++i) {
      Command();
      const int cycles = Whole(0, 3) == 0 ? Whole(1, 400) : Whole(1, 30);
      for (int k = 0; k < cycles && !testing::Test::HasFailure(); ++k) {
        Lead();
        rig.Run();
      }
    }
    for (const auto& [ticket, answer] : rig.answers) {
      if (answer.state == FeedbackState::kDone) ++done;
      if (answer.error == ErrorId::kCollision) ++refused;
    }
  }

  int in_turn = 0;  // cycles in which a command waited for its area
  int held = 0;     // cycles in which a mover in the plane waited for another one
  int waits = 0;    // likewise on tracks
  int near = 0;     // cycles with two movers less than 5 mm apart
  int done = 0, refused = 0;
  double closest = 1e9;  // [mm]

 private:
  double Uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
  int Whole(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }

  static std::string Number(double x) {
    char text[40];
    std::snprintf(text, sizeof text, "%.6g", x);
    return text;
  }

  std::string MachineText() {
    const int count = Whole(4, 12);
    std::vector<Box> boxes;
    while (static_cast<int>(boxes.size()) < count) {
      const bool square = Whole(0, 1) == 0;
      Box box{Uniform(0, 1500), Uniform(-300, 900), Whole(0, 2) == 0 ? Uniform(-15, 15) : 0, 113, 113};
      if (!square) box.width = Uniform(60, 220), box.height = Uniform(60, 220);
      if (std::ranges::all_of(boxes, [&](const Box& other) { return Apart(box, other) > 1; })) boxes.push_back(box);
    }
    std::string text = "name: world\naxes: []\nmovers:\n";
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const Box& b = boxes[i];
      const double gap = std::max(Uniform(60, 250), std::min(b.width, b.height));
      const double acceleration = Uniform(1000, 10000);
      text += "  - {name: m" + std::to_string(i) + ", width: " + Number(b.width) + ", height: " + Number(b.height) +
              ", gap: " + Number(gap + 0.01) + ", initial: {x: " + Number(b.x) + ", y: " + Number(b.y) +
              ", c: " + Number(b.c) + "}, c: {maximum: {velocity: 360, acceleration: 3600, jerk: 72000}, lower: -15, " +
              "upper: 15}, xy: {maximum: {velocity: " + Number(Uniform(300, 2000)) +
              ", acceleration: " + Number(acceleration) + ", jerk: " + Number(20 * acceleration) + "}}}\n";
    }
    const double x = Uniform(500, 900), y = Uniform(100, 400);
    text += "tracks:\n";
    const auto track = [&](const std::string& name, const std::string& rest) {
      text += "  - {name: " + name + ", mover_width: 220, mover_height: 220, " + rest + "}\n";
    };
    const auto line = [&](double x0, double y0, double x1, double y1) {
      return "{from: {x: " + Number(x0) + ", y: " + Number(y0) + "}, to: {x: " + Number(x1) + ", y: " + Number(y1) +
             "}}";
    };
    track("along", "elements: [" + line(0, y, 1600, y) + "]");
    track("across", "elements: [" + line(x, -400, x, 1000) + "]");
    track("slanted", "elements: [" + line(0, 900, 1400, -300 + Uniform(0, 200)) + "]");
    const double r = Uniform(60, 250);
    track("ring", "closed_loop: true, elements: [" + line(300 + r, 0, 900, 0) + ", " + line(900 + r, r, 900 + r, 500) +
                      ", " + line(900, 500 + r, 300 + r, 500 + r) + ", " + line(300, 500, 300, r) + "]");
    track("back", "starts_from: [along], elements: [" + line(1800, y - 200, 1800, y - 400) + ", " +
                      line(1600, -500, 1200, -500) + ", " + line(1000, -300, 1000, 900) + "]");
    track("branch", "starts_from: [along], elements: [" + line(1900, y + 100, 1900, y + 300) + "]");
    std::string movers = "m0, m1, m2";
    for (int i = 3; waits_ && i < count; ++i) movers += ", m" + std::to_string(i);
    text += "planar_groups: [{name: cell, movers: [" + movers + "], tracks: [along, back, branch]" +
            (waits_ ? ", moves_wait: true" : "") + "}]\n";
    return text;
  }

  void Command() {
    const auto any = [&](const auto& list) -> const std::string& {
      return list[static_cast<std::size_t>(Whole(0, static_cast<int>(list.size()) - 1))].name;
    };
    const std::string &mover = any(rig.machine.movers), &other = any(rig.machine.movers);
    const std::string& track = any(rig.machine.tracks);
    const std::string place = "x: " + Number(Uniform(-200, 1900)) + ", y: " + Number(Uniform(-500, 1100));
    const std::string axis = Whole(0, 1) ? "x" : "y";
    switch (Whole(0, 32)) {
      case 0:
      case 1:
        rig.Give(mover, "enable");
        break;
      case 2:
        rig.Give(mover, Whole(0, 1) ? "halt" : "reset");
        break;
      case 3:
        if (Whole(0, 3) == 0) rig.Give(mover, "disable");
        break;
      case 4:
        rig.Give(mover, "halt", "{deceleration: 500, jerk: 5000}");
        break;
      case 5:
      case 6:
      case 7:
      case 8:
        rig.Give(mover, "move_to_position", "{" + place + ", velocity: " + Number(Uniform(100, 2000)) + "}");
        break;
      case 9:
        rig.Give(mover, "move_to_position", "{" + place + ", c: " + Number(Uniform(-15, 15)) + "}");
        break;
      case 10:
        rig.Give(mover, "move_to_position", "{" + place + ", buffer_mode: buffered, blending: 60}");
        break;
      case 11:
      case 12:
        rig.Give(mover, "move_c", "{position: " + Number(Uniform(-20, 110)) + "}");
        break;
      case 13:
      case 14:
        rig.Give(mover, "join_track", "{track: " + track + (Whole(0, 1) ? ", use_orientation: false}" : "}"));
        break;
      case 15:
        rig.Give(mover, "leave_track", "{" + place + ", use_orientation: false}");
        break;
      case 16:
        if (mover != other)
          rig.Give(mover, "gear_in_pos_on_track_with_master_mover",
                   "{master: " + other + ", master_sync_position: " + Number(Uniform(0, 1000)) +
                       ", slave_sync_position: " + Number(Uniform(0, 1000)) + "}");
        break;
      case 17:
        if (mover != other) rig.Give(mover, "join_formation", "{star: " + other + "}");
        break;
      case 18:
        rig.Give(mover, "leave_formation");
        break;
      case 19:
        return StartLeading();
      case 20:
      case 21:
        rig.Give(mover, "move_" + axis, "{position: " + Number(Uniform(-500, 1900)) + "}");
        break;
      case 22:
      case 23:
        rig.Give(mover, "move_relative_" + axis, "{distance: " + Number(Uniform(-500, 500)) + "}");
        break;
      case 24:
      case 25:
        rig.Give(mover, "move_velocity_" + axis, "{velocity: " + Number(Uniform(-1000, 1000)) + "}");
        break;
      case 26:
        rig.Give(mover, Whole(0, 1) ? "halt_on_track" : "halt_" + axis, "{deceleration: 800}");
        break;
      case 27:
        if (Whole(0, 1)) rig.Give(mover, "move_velocity_c", "{velocity: " + Number(Uniform(-300, 300)) + "}");
        Whole(0, 1) ? rig.Give(mover, "halt_c", "{deceleration: 99}")
                    : rig.Give(mover, "move_relative_c", "{distance: 9}");
        break;
      default:
        rig.Give(mover, "move_on_track",
                 "{track: " + (Whole(0, 1) ? track : std::string("back")) + ", position: " + Number(Uniform(0, 1500)) +
                     (Whole(0, 1) ? ", gap: " + Number(Uniform(0, 250)) : "") + "}");
        break;
    }
  }

  // External set points: back and forth along a line.
  void StartLeading() {
    if (led_ >= 0) return;
    led_ = Whole(0, static_cast<int>(rig.machine.movers.size()) - 1);
    absolute_ = Whole(0, 2) > 0;
    const mover::Outputs& o = OutputsOf(static_cast<std::size_t>(led_));
    from_ = {o.x, o.y};
    cycle_ = 0;
    amplitude_ = absolute_ ? Uniform(20, 200) : Uniform(5, 40);
    angle_ = Uniform(-3, 3);
    rig.Give(NameOf(led_), "start_external_setpoint_generation", absolute_ ? "{mode: absolute}" : "{mode: relative}");
  }
  void Lead() {
    if (led_ < 0) return;
    const double w = 2 * M_PI / 1000, t = ++cycle_;
    const double s = amplitude_ * (1 - std::cos(w * t)), v = 1000 * amplitude_ * w * std::sin(w * t),
                 a = 1e6 * amplitude_ * w * w * std::cos(w * t);
    const double x = std::cos(angle_), y = std::sin(angle_);
    const mover::Outputs& o = OutputsOf(static_cast<std::size_t>(led_));
    if (t > 1000 || o.external == mover::SetpointMode::kNone) {
      if (t > 3) {
        rig.Give(NameOf(led_), "stop_external_setpoint_generation");
        led_ = -1;
      }
      return;
    }
    const double c = absolute_ ? o.c : 0;
    char text[400];
    std::snprintf(text, sizeof text,
                  "{x: %.12g, y: %.12g, c: %.12g, velocity_x: %.12g, velocity_y: %.12g, acceleration_x: %.12g, "
                  "acceleration_y: %.12g}",
                  (absolute_ ? from_.x : 0) + s * x, (absolute_ ? from_.y : 0) + s * y, c, v * x, v * y, a * x, a * y);
    rig.Give(NameOf(led_), "set_external_setpoint", text);
  }

  const std::string& NameOf(int mover) const { return rig.machine.movers[static_cast<std::size_t>(mover)].name; }
  const mover::Outputs& OutputsOf(std::size_t i) const { return rig.engine.mover_outputs(i); }

  void Look() {
    const std::size_t count = rig.machine.movers.size();
    bool is_near = false;
    for (std::size_t i = 0; i < count; ++i) {
      const mover::Outputs& o = OutputsOf(i);
      const bool on_track = o.command_mode == mover::CommandMode::kOnTrack;
      if (o.waits_for != 0 && o.buffered > 0) ++in_turn;
      if (o.waits_for != 0) on_track ? ++waits : ++held;
      for (std::size_t k = 0; k < i; ++k) {
        const mover::Outputs& other = OutputsOf(k);
        if (std::hypot(other.x - o.x, other.y - o.y) > 330) continue;
        const auto box = [&](std::size_t m, const mover::Outputs& at) {
          return Box{at.x, at.y, at.c, rig.machine.movers[m].width, rig.machine.movers[m].height};
        };
        const double apart = Apart(box(i, o), box(k, other));
        closest = std::min(closest, apart);
        is_near = is_near || apart < 5;
        ASSERT_GT(apart, -1e-5) << NameOf(static_cast<int>(k)) << " and " << NameOf(static_cast<int>(i)) << ", cycle "
                                << rig.engine.cycle().count;
      }
    }
    near += is_near ? 1 : 0;
  }

  bool waits_;
  std::mt19937 random_;
  PartsRig rig;
  int led_ = -1, cycle_ = 0;
  bool absolute_ = true;
  planar::Place from_;
  double amplitude_ = 0, angle_ = 0;
};

// Consecutive movers on a track keep a distance by their sizes in their orientations, not by the gap alone: the leader
// has rotated after the follower was given a gap that fits its former orientation.
TEST(MoversApart, OneAheadThatHasTurned) {
  for (const double turn : {30.0, 45.0, 90.0}) {
    PartsRig rig(R"(
name: lane
axes: []
tracks: [{name: lane, mover_width: 240, mover_height: 240, elements: [{from: {x: 0, y: 0}, to: {x: 2000, y: 0}}]}]
movers:
  - {name: behind, width: 200, height: 80, gap: 205}
  - {name: ahead, width: 200, height: 240, gap: 205, initial: {x: 1500}}
)");
    rig.Do("lane", "enable");
    for (const char* name : {"behind", "ahead"}) {
      rig.Do(name, "enable");
      EXPECT_EQ(rig.Do(name, "join_track", "{track: lane}").error, ErrorId::kNone);
    }
    const Ticket move = rig.Give("behind", "move_on_track", "{position: 1900, gap: 205, velocity: 300}");
    rig.Run(10);
    EXPECT_EQ(rig.Do("ahead", "move_c", "{position: " + std::to_string(turn) + "}").error, ErrorId::kNone);
    double least = 1e9;
    rig.each_cycle = [&] {
      const mover::Outputs &a = rig.Mover("behind"), &b = rig.Mover("ahead");
      least = std::min(least, Apart({a.x, a.y, a.c, 200, 80}, {b.x, b.y, b.c, 200, 240}));
    };
    rig.Run(8000);
    EXPECT_GT(least, -1e-4) << turn;
    EXPECT_LT(least, 60) << turn;
    EXPECT_FALSE(IsFinal(rig.answers[move].state)) << turn;
    EXPECT_EQ(rig.Mover("behind").delay, mover::Delay::kMover) << turn;
  }
}

TEST(MoversApart, WhateverTheyAreTold) {
  int in_turn = 0, held = 0, waits = 0, near = 0, done = 0, refused = 0, seeds = 0;
  double closest = 1e9;
  for (std::uint32_t seed = 1; seed <= static_cast<std::uint32_t>(Trials(12)) && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    RandomWorld world(seed);
    world.Go(220);
    in_turn += world.in_turn;
    held += world.held;
    waits += world.waits;
    near += world.near;
    done += world.done;
    refused += world.refused;
    closest = std::min(closest, world.closest);
    ++seeds;
  }
  std::printf(
      "%d worlds: %d commands done, %d refused for a collision; cycles in which movers were held %d, waited on "
      "tracks %d, for their area %d, were less than 5 mm apart %d; closest %.2e mm\n",
      seeds, done, refused, held, waits, in_turn, near, closest);
  EXPECT_GT(done, Trials(200));
  EXPECT_GT(refused, Trials(5));
  EXPECT_GT(held, Trials(1000));
  EXPECT_GT(waits, kSanitized ? -1 : 500);  // not in each world
  EXPECT_GT(near, Trials(100));
  EXPECT_GT(in_turn, Trials(500));
}

}  // namespace
}  // namespace takt::engine
