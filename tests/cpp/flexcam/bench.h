// A web (master) and a knife (slave) with a cam module between them, on an engine in virtual time.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "../engine/cam_rig.h"
#include "takt/engine/engine.h"

namespace takt::flexcam {

using engine::Machine;

inline axis::AxisParams Axis(const char* name, axis::AxisKind kind) {
  axis::AxisParams a;
  a.name = name;
  a.kind = kind;
  a.limits = {.velocity = 5000, .acceleration = 100000, .deceleration = {}, .jerk = 5e6, .lower = {}, .upper = {}};
  a.encoder.increments_per_unit = 10000;
  return a;
}

// Rises by `height` and falls again within a turn of 360.
inline cam::CamParams UpAndDown(const char* name, double height, double length = 360) {
  cam::CamParams p;
  p.name = name;
  p.cyclic = true;
  p.points = {engine::Rest(0, 0), engine::Rest(length / 2, height), engine::Rest(length, 0)};
  return p;
}
// Returns the value at x of a cam that rises and falls.
inline double Hill(double x, double height = 50, double length = 360) {
  const double in = x - length * std::floor(x / length);
  return height * engine::Polynomial345::Y(in < length / 2 ? in / (length / 2) : (length - in) / (length / 2));
}
// Advances by `stroke` within `length`, at rest at its ends.
inline cam::CamParams Onward(const char* name, double stroke, double length = 360) {
  cam::CamParams p;
  p.name = name;
  p.cyclic = true;
  p.points = {engine::Rest(0, 0), engine::Rest(length, stroke)};
  return p;
}
// y = slope * x.
inline cam::CamParams Straight(const char* name, double slope, double length = 360) {
  cam::CamParams p;
  p.name = name;
  p.cyclic = true;
  p.interpolation = cam::Interpolation::kLinear;
  p.points = {{0, 0, {}, {}}, {length, slope * length, {}, {}}};
  return p;
}

inline Machine MachineOf(std::vector<cam::CamParams> cams, const Settings& settings = {},
                         axis::AxisKind master = axis::AxisKind::kRotary,
                         axis::AxisKind slave = axis::AxisKind::kLinear) {
  Machine m;
  m.name = "cutter";
  m.axes = {Axis("knife", slave), Axis("web", master)};
  m.cams = std::move(cams);
  FlexCamParams module;
  module.name = "cutter";
  module.slave = "knife";
  module.master = "web";
  module.settings = settings;
  for (const cam::CamParams& cam : m.cams) {
    if (module.cams.size() < kSlots) module.cams.push_back(cam.name);
  }
  m.flex_cams = {module};
  return m;
}

// Closes and opens by a ramp of a short time.
inline Settings Quick() {
  Settings s;
  s.sync_mode = ClutchMode::kRampTime;
  s.sync_in_time_s = 0.1;
  s.slave_absolute = true;
  return s;
}
inline Settings QuickBothWays() {
  Settings s = Quick();
  s.sync_out_time_s = 0.1;
  return s;
}

inline Machine OneHill(const Settings& s = QuickBothWays()) {
  return MachineOf({UpAndDown("hill", 50)}, s);
}

// Returns the distance of two positions on a turn.
inline double Apart(double a, double b, double turn = 360) {
  return std::abs(a - b - turn * std::round((a - b) / turn));
}

class Bench {
 public:
  static constexpr std::size_t kKnife = 0, kWeb = 1;

  explicit Bench(const Machine& m) : machine(m), engine(machine) {
    Give(kWeb, axis::Power{});
    Tell(Control{.regulator_on = true});
    Run(200);
  }

  Ticket Give(std::size_t axis, const axis::Command& body) {
    return engine.Submit({0, static_cast<std::uint32_t>(axis + 1), 0, body});
  }
  Ticket Tell(const Command& body, double lease_s = 0) {
    return engine.Submit({0, static_cast<std::uint32_t>(machine.axes.size() + 1), lease_s, body});
  }
  // Sets the velocity of the web, at once if `cycles` is 0, else after this number of cycles.
  void Web(double velocity) {
    axis::MoveVelocity move{.velocity = std::abs(velocity)};
    move.direction = velocity < 0 ? axis::Direction::kNegative : axis::Direction::kPositive;
    Give(kWeb, move);
  }
  void Step() {
    engine.RunCycle();
    for (FeedbackEvent event; engine.feedback().TryPop(event);) last[event.ticket] = event;
    if (each) each();
  }
  void Run(int cycles) {
    for (int i = 0; i < cycles; ++i) Step();
  }
  // Runs until the condition holds; returns false if it does not within this number of cycles.
  bool Until(const std::function<bool()>& holds, int most = 20000) {
    for (int i = 0; i < most; ++i) {
      if (holds()) return true;
      Step();
    }
    return holds();
  }
  const axis::Outputs& Knife() const { return engine.outputs(kKnife); }
  const axis::Outputs& TheWeb() const { return engine.outputs(kWeb); }
  const Outputs& Module() const { return engine.flex_cam_outputs(0); }
  FeedbackState Of(Ticket ticket) const { return last.at(ticket).state; }
  ErrorId ErrorOf(Ticket ticket) const { return last.at(ticket).error; }
  bool Sync(int most = 20000) {
    const Ticket ticket = Tell(Control{.sync_cam = true});
    Step();
    const bool done = Until([&] { return IsFinal(Of(ticket)); }, most) && Of(ticket) == FeedbackState::kDone;
    EXPECT_TRUE(done) << "state " << int(Module().state) << " error " << int(ErrorOf(ticket)) << " synchronised "
                      << Module().cam_synchronised;
    return done;
  }

  Machine machine;
  engine::Engine engine;
  std::map<Ticket, FeedbackEvent> last;
  std::function<void()> each;
};

}  // namespace takt::flexcam
