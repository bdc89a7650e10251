// PL-32: random commands to movers and parts on two levels, at any time. The motion is checked against the outputs and
// the machine file alone: every mover is completely on stators, keeps its position on a moving part, keeps its gap on
// tracks, and overlaps no other one, in a group or not; a refused command is unsafe and an accepted one is safe. And
// the run can be replayed.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "../core/trials.h"
#include "parts_rig.h"
#include "takt/core/describe.h"

namespace takt::engine {
namespace {

using planar::ObjectState;
using planar::Place;

const std::string kTwoLevels = R"(
name: levels
axes: []
coordinate_systems: [{name: lower}, {name: upper}]
parts:
  - {name: hall, stators: [{x: 0, y: 0}, {x: 240, y: 0}, {x: 0, y: 240}], positions: [{coordinate_system: lower}]}
  - {name: attic, stators: [{x: 0, y: 0}, {x: 240, y: 0}], positions: [{coordinate_system: upper}]}
  - name: lift
    travel_time_s: 0.12
    positions:
      [{coordinate_system: lower, x: 480}, {coordinate_system: upper, x: 480}, {coordinate_system: upper, y: 240}]
  - name: shuttle
    stators: [{x: 0, y: 0}, {x: 0, y: 240}]
    positions: [{coordinate_system: lower, x: 240, y: 240}, {coordinate_system: lower, x: 480, y: 120},
                {coordinate_system: upper, x: 100, y: 240}]
  - name: drawer
    travel_time_s: 0.03
    positions: [{coordinate_system: lower, x: 0, y: 480}, {coordinate_system: lower, x: -240},
                {coordinate_system: upper, x: 240, y: 240}]
tracks:
  - {name: hall_way, part: hall, elements: [{from: {x: 40, y: 120}, to: {x: 480, y: 120}}]}
  - {name: attic_way, part: attic, elements: [{from: {x: 40, y: 120}, to: {x: 480, y: 120}}]}
  - {name: lift_way, part: lift, starts_from: [hall_way], elements: [{from: {x: 20, y: 120}, to: {x: 200, y: 120}}]}
movers:
  - {name: a, reference: hall, initial: {x: 100, y: 100}}
  - {name: b, reference: hall, initial: {x: 340, y: 100}, width: 155, height: 113}
  - {name: c, reference: attic, initial: {x: 100, y: 100}}
  - {name: d, reference: lift, initial: {x: 120, y: 120}}
planar_groups:
  - {name: cell, movers: [a, b, c, d], tracks: [hall_way, attic_way, lift_way]}
)";

// Position of a part, as last published.
struct Seen {
  std::uint32_t system = 0;  // from 1
  Place origin;
};

class RandomParts {
 public:
  RandomParts(std::uint32_t seed, bool faults, bool grouped)
      : rig(kTwoLevels, {.journal = true, .snapshot_queue = 1 << 15}),
        random_(seed),
        faults_(faults),
        grouped_(grouped) {
    for (const part::PartParams& part : rig.machine.parts) stators_.push_back(part::StatorsOf(part));
    // The lift's track continues from either.
    rig.Do("lift", "activate_position", "{index: 2}");
    EXPECT_EQ(rig.ErrorOf("lift_way", "start_from_track", "{track: attic_way}"), ErrorId::kNone);
    for (const char* track : {"hall_way", "attic_way", "lift_way"}) rig.Do(track, "enable");
    if (grouped) {
      EXPECT_EQ(rig.ErrorOf("cell", "enable"), ErrorId::kNone);
    }
    Look();
    rig.each_cycle = [this] { Check(); };
  }

  void Go(int steps) {
    for (int i = 0; i < steps && !testing::Test::HasFailure(); ++i) {
      One();
      rig.Run(Whole(0, 3) == 0 ? Whole(1, 300) : Whole(1, 20));
    }
  }

  PartsRig rig;
  int activated = 0, hindered = 0, off = 0, crossed = 0, moved = 0, carried = 0, on_track = 0, changed_track = 0;
  int collided = 0, beside = 0;  // beside: cycles with two bodies less than 20 mm apart

 private:
  double Uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
  int Whole(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }
  const Machine& machine() const { return rig.machine; }
  const mover::Outputs& MoverAt(std::size_t i) const { return rig.engine.mover_outputs(i); }
  const part::Outputs& PartAt(std::size_t i) const { return rig.engine.part_outputs(i); }

  std::vector<bool> Away() const {
    std::vector<bool> away;
    for (std::size_t i = 0; i < machine().parts.size(); ++i) away.push_back(PartAt(i).position_index == 0);
    return away;
  }

  void Look() {
    parts_.resize(machine().parts.size());
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const part::Outputs& o = PartAt(i);
      if (o.position_index != 0) parts_[i] = {o.coordinate_system, {o.x, o.y}};
    }
    movers_.clear();
    for (std::size_t i = 0; i < machine().movers.size(); ++i) movers_.push_back(MoverAt(i));
  }

  // Returns points on the outline of a mover, `step` mm apart, enlarged by `larger`.
  std::vector<Place> OutlineOf(std::size_t mover, Place at, double c, double larger, double step) const {
    const double w = machine().movers[mover].width / 2 + larger, h = machine().movers[mover].height / 2 + larger;
    const double cosine = std::cos(c * M_PI / 180), sine = std::sin(c * M_PI / 180);
    std::vector<Place> out;
    const auto add = [&](double x, double y) {
      out.push_back({at.x + cosine * x - sine * y, at.y + sine * x + cosine * y});
    };
    for (double x = -w; x <= w; x += step) add(x, -h), add(x, h);
    for (double y = -h; y <= h; y += step) add(-w, y), add(w, y);
    add(w, h), add(-w, h), add(w, -h), add(-w, -h);
    return out;
  }
  bool IsOn(std::size_t part, const Seen& where, std::uint32_t system, const Place& p, double slack) const {
    if (where.system != system) return false;
    const std::vector<Place>& stators = stators_[part];
    return std::ranges::any_of(stators, [&](const Place& corner) {
      const double x = p.x - where.origin.x - corner.x, y = p.y - where.origin.y - corner.y;
      return x > -slack && y > -slack && x < 240 + slack && y < 240 + slack;
    });
  }
  // Of all parts, with or without those in motion (at their last position).
  bool OnStators(std::uint32_t system, const std::vector<Place>& places, double slack,
                 const std::vector<bool>& away = {}) const {
    return std::ranges::all_of(places, [&](const Place& p) {
      for (std::size_t i = 0; i < parts_.size(); ++i) {
        if (!away.empty() && away[i]) continue;
        if (IsOn(i, parts_[i], system, p, slack)) return true;
      }
      return false;
    });
  }
  bool Reaches(std::size_t mover, Place at, double c, std::uint32_t system, std::size_t part, const Seen& where,
               double larger) const {
    return std::ranges::any_of(OutlineOf(mover, at, c, larger, 4),
                               [&](const Place& p) { return IsOn(part, where, system, p, -1e-9); }) ||
           IsOn(part, where, system, at, -1e-9);
  }

  // Returns the distance of two rectangles along one of their sides; below 0: an overlap of at least that.
  double Apart(std::size_t a, const mover::Outputs& at_a, std::size_t b, const mover::Outputs& at_b) const {
    double most = -1e9;
    for (const double c : {at_a.c, at_a.c + 90, at_b.c, at_b.c + 90}) {
      const double x = std::cos(c * M_PI / 180), y = std::sin(c * M_PI / 180);
      const auto half = [&](std::size_t m, double turned) {
        const double t = (turned - c) * M_PI / 180;
        return (machine().movers[m].width * std::abs(std::cos(t)) +
                machine().movers[m].height * std::abs(std::sin(t))) /
               2;
      };
      const double off = std::abs((at_b.x - at_a.x) * x + (at_b.y - at_a.y) * y);
      most = std::max(most, off - half(a, at_a.c) - half(b, at_b.c));
    }
    return most;
  }

  static bool IsOnTrack(const mover::Outputs& o) {
    return o.command_mode == mover::CommandMode::kOnTrack || o.command_mode == mover::CommandMode::kCRotationOnTrack;
  }

  void Check() {
    const std::vector<mover::Outputs> before = movers_;
    const std::vector<Seen> were = parts_;
    Look();
    for (std::size_t i = 0; i < movers_.size(); ++i) {
      const mover::Outputs& now = movers_[i];
      const std::vector<Place> body = OutlineOf(i, {now.x, now.y}, now.c, 0, 20);
      on_track += IsOnTrack(now) && now.velocity_x != 0 ? 1 : 0;
      changed_track += IsOnTrack(now) && IsOnTrack(before[i]) && now.track != before[i].track ? 1 : 0;
      for (std::size_t k = 0; k < i; ++k) {
        const mover::Outputs& other = movers_[k];
        const bool meet = IsOnTrack(now) && IsOnTrack(other) && now.coordinate_system == other.coordinate_system;
        if (meet) {
          EXPECT_GE(std::hypot(now.x - other.x, now.y - other.y), 200 - 1e-3);
        }
        if (now.coordinate_system != other.coordinate_system) continue;
        const double apart = Apart(i, now, k, other);
        beside += apart < 20 ? 1 : 0;
        EXPECT_GT(apart, -1e-3) << machine().movers[i].name << " and " << machine().movers[k].name << ", cycle "
                                << rig.engine.cycle().count;
      }
      EXPECT_TRUE(OnStators(now.coordinate_system, body, IsOnTrack(now) ? 0.01 : 1e-5))
          << machine().movers[i].name << " at " << now.x << ", " << now.y << " turned " << now.c << " in "
          << now.coordinate_system << ", cycle " << rig.engine.cycle().count;
      ASSERT_NE(now.part, 0u);
      // Relative to its part, at any position of that.
      const std::size_t on = before[i].part - 1;
      const double x = now.x - parts_[on].origin.x - (before[i].x - were[on].origin.x);
      const double y = now.y - parts_[on].origin.y - (before[i].y - were[on].origin.y);
      EXPECT_LE(std::hypot(x, y), 2000 * 0.001 + 1e-9) << machine().movers[i].name;
      if (parts_[on].system != were[on].system || parts_[on].origin.x != were[on].origin.x) {
        EXPECT_LE(std::hypot(x, y), 1e-9);
        ++carried;
      }
      EXPECT_EQ(now.coordinate_system, parts_[now.part - 1].system);
      if (now.velocity_x != 0) {
        EXPECT_EQ(before[i].part, on + 1);
      }
    }
  }

  void One() {
    const auto any = [&](const auto& list) {
      return static_cast<std::size_t>(Whole(0, static_cast<int>(list.size()) - 1));
    };
    const std::size_t m = any(machine().movers), p = any(machine().parts);
    const std::string& mover = machine().movers[m].name;
    const std::string& part = machine().parts[p].name;
    const std::string track = machine().tracks[any(machine().tracks)].name;
    switch (Whole(0, faults_ ? 20 : 16)) {
      case 0:
      case 1:
        rig.Give(mover, "enable");
        break;
      case 2:
      case 3:
      case 4:
        return Send(m);
      case 5:
      case 6:
      case 7:
      case 8:
        return Activate(p);
      case 9:
        rig.Give(mover, "halt", Whole(0, 1) ? "{}" : "{deceleration: 500, jerk: 5000}");
        break;
      case 10:
        rig.Give(mover, "move_c", "{position: " + std::to_string(Uniform(-200, 200)) + "}");
        break;
      case 11:
        rig.Give(mover, "reset");
        break;
      case 12:
        rig.Give(mover, "join_track", "{track: " + track + "}");
        break;
      case 13:
      case 14:
      case 15:
        rig.Give(mover, "move_on_track", "{track: " + track + ", position: " + std::to_string(Uniform(0, 240)) + "}");
        break;
      case 16:
        rig.Give(mover, "leave_track",
                 "{x: " + std::to_string(Uniform(60, 180)) + ", y: 120, reference: " + part + "}");
        break;
      case 17:
        rig.Give(mover, "disable");
        break;
      case 18:
        rig.Give(part, Whole(0, 3) == 0 ? "force_disable" : "allow_enable");
        break;
      case 19:
        rig.Give(part, "reset");
        break;
      default:
        rig.engine.part_faults(p).fault = Whole(0, 3) == 0;
        break;
    }
  }

  // If it starts from rest and does not rotate, the result is known.
  void Send(std::size_t m) {
    const mover::Outputs& o = MoverAt(m);
    const std::size_t r = static_cast<std::size_t>(Whole(0, static_cast<int>(machine().parts.size())));
    const bool by_part = r < machine().parts.size();
    const Seen from = by_part ? parts_[r] : Seen{o.coordinate_system, {}};
    const Place target =
        by_part ? Place{Uniform(40, 260), Uniform(40, 260)} : Place{Uniform(-200, 720), Uniform(0, 720)};
    const std::string name =
        by_part ? machine().parts[r].name : machine().coordinate_systems[o.coordinate_system - 1].name;
    const bool rests = o.velocity_x == 0 && o.velocity_y == 0 && !o.busy_xyc && !o.busy_c;
    const bool can = o.state == ObjectState::kEnabled && o.command_mode == mover::CommandMode::kFreeMovement;
    const bool here = from.system == o.coordinate_system;
    const std::vector<bool> away = Away();
    const bool stays = away[o.part - 1] || (by_part && away[r]);
    char text[200];
    std::snprintf(text, sizeof text, "{x: %.9g, y: %.9g, velocity: %.3g, reference: %s}", target.x, target.y,
                  Uniform(200, 2000), name.c_str());
    const Place to{target.x + from.origin.x, target.y + from.origin.y};
    const Ticket ticket = rig.Give(machine().movers[m].name, "move_to_position", text);
    const std::vector<Seen> were = parts_;
    rig.Run();
    if (!rests || !can || stays) return;
    const ErrorId error = rig.answers[ticket].error;
    if (!here) {
      EXPECT_EQ(error, ErrorId::kReference);
      return;
    }
    const auto free = [&](double larger) {
      const double way = std::hypot(to.x - o.x, to.y - o.y);
      for (double s = 0; s <= way; s += 0.5) {
        const Place at{o.x + (to.x - o.x) * s / way, o.y + (to.y - o.y) * s / way};
        if (!OnStators(o.coordinate_system, OutlineOf(m, at, o.c, larger, 4), 1e-5, away)) return false;
      }
      return true;
    };
    if (error == ErrorId::kNone) {
      EXPECT_TRUE(free(-0.01));
      ++moved;
      crossed += PartOf(o.coordinate_system, to) != o.part ? 1 : 0;
    } else if (error == ErrorId::kOffStators) {
      EXPECT_FALSE(free(2)) << machine().movers[m].name << " from " << o.x << ", " << o.y << " to " << to.x << ", "
                            << to.y;
      ++off;
    } else if (error == ErrorId::kCollision) {
      // With a mover of the group, or with one that a part carries.
      EXPECT_TRUE(grouped_ || std::ranges::count(away, true) > 0);
      EXPECT_NE(rig.answers[ticket].object.kind, ObjectKind::kNone);
      ++collided;
    } else {
      EXPECT_TRUE(faults_ && (error == ErrorId::kPartDisabled || error == ErrorId::kPartFault))
          << static_cast<int>(error);
    }
  }
  std::uint32_t PartOf(std::uint32_t system, const Place& at) const {
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (IsOn(i, parts_[i], system, at, 0)) return static_cast<std::uint32_t>(i + 1);
    }
    return 0;
  }

  void Activate(std::size_t p) {
    const part::PartParams& part = machine().parts[p];
    const auto index = static_cast<std::uint32_t>(Whole(1, static_cast<int>(part.positions.size())));
    const std::uint32_t was = PartAt(p).position_index;
    const bool faulty = PartAt(p).error != ErrorId::kNone;
    const std::vector<Seen> were = parts_;
    const std::vector<mover::Outputs> stood = movers_;
    std::vector<track::OperationMode> modes;
    for (const track::Outputs& o : rig.engine.tracks().outputs) modes.push_back(o.operation_mode);
    const Ticket ticket = rig.Give(part.name, "activate_position", "{index: " + std::to_string(index) + "}");
    rig.Run();
    const FeedbackEvent answer = rig.answers[ticket];
    if (faulty || index == was || was == 0) return;
    const part::PositionParams& given = part.positions[index - 1];
    const Seen to{given.coordinate_system == "lower" ? 1u : 2u, {given.x, given.y}};
    const auto busy = [&](const mover::Outputs& o) {
      return o.busy_xyc || o.busy_z || o.busy_c || o.velocity_x != 0 || o.velocity_y != 0 || o.velocity_c != 0;
    };
    const std::vector<bool> away = Away();
    const auto reaches = [&](std::size_t m, std::size_t k, double larger) {
      const mover::Outputs& o = stood[m];
      return !away[k] && Reaches(m, {o.x, o.y}, o.c, o.coordinate_system, k, were[k], larger);
    };
    const auto reaches_others = [&](std::size_t m, double larger) {
      for (std::size_t k = 0; k < were.size(); ++k) {
        if (k != p && reaches(m, k, larger)) return true;
      }
      return false;
    };
    if (answer.error == ErrorId::kNone) {
      ++activated;
      for (std::size_t m = 0; m < stood.size(); ++m) {
        if (stood[m].part == p + 1) {
          EXPECT_FALSE(busy(stood[m]));
          EXPECT_FALSE(reaches_others(m, -0.01));
        } else {
          EXPECT_FALSE(reaches(m, p, -0.01));
        }
      }
      for (std::size_t k = 0; k < were.size(); ++k) {
        if (k == p) continue;
        for (const Place& a : part::StatorsOf(part)) {
          for (const Place& b : part::StatorsOf(machine().parts[k])) {
            const bool same = were[k].system == to.system;
            const double x = to.origin.x + a.x - were[k].origin.x - b.x, y = to.origin.y + a.y - were[k].origin.y - b.y;
            EXPECT_FALSE(same && std::abs(x) < 239.99 && std::abs(y) < 239.99);
          }
        }
      }
      return;
    }
    if (faults_ && answer.error == ErrorId::kPartFault) return;  // in the same cycle
    ++hindered;
    if (answer.error == ErrorId::kPartTrack) {
      const auto mode = rig.engine.tracks().outputs.at(std::size_t{answer.object.number} - 1).operation_mode;
      EXPECT_TRUE(mode == track::OperationMode::kMoving || mode == track::OperationMode::kConfiguring ||
                  modes.at(std::size_t{answer.object.number} - 1) > track::OperationMode::kStanding);
      return;
    }
    const auto number = std::size_t{answer.object.number};
    if (answer.error == ErrorId::kPartPlace) {
      bool overlap = false;
      for (const Place& a : part::StatorsOf(part)) {
        for (const Place& b : part::StatorsOf(machine().parts.at(number - 1))) {
          for (const Seen& its : {were[number - 1], parts_[number - 1]}) {
            const double x = to.origin.x + a.x - its.origin.x - b.x, y = to.origin.y + a.y - its.origin.y - b.y;
            overlap |= its.system == to.system && std::abs(x) < 240 && std::abs(y) < 240;
          }
        }
      }
      EXPECT_TRUE(overlap || PartAt(number - 1).position_index == 0);
    } else {
      ASSERT_EQ(answer.error, ErrorId::kPartMover);
      const mover::Outputs& o = stood.at(number - 1);
      const bool on = o.part == p + 1;
      // A mover that is neither in the way now nor moving can only be under the carried movers or at the target.
      const bool reason = busy(o) || (on ? reaches_others(number - 1, 0.01) : reaches(number - 1, p, 0.01)) ||
                          o.coordinate_system == to.system || away[o.part - 1];
      EXPECT_TRUE(reason) << part.name << " to " << index << ", " << machine().movers[number - 1].name;
    }
  }

  std::mt19937 random_;
  bool faults_;
  bool grouped_;
  std::vector<std::vector<Place>> stators_;  // by part
  std::vector<Seen> parts_;
  std::vector<mover::Outputs> movers_;
};

TEST(PartsWalk, NobodyLeavesTheStators) {
  int activated = 0, hindered = 0, off = 0, crossed = 0, moved = 0, carried = 0, on_track = 0, changed_track = 0;
  int collided = 0, beside = 0;
  for (std::uint32_t seed = 0; seed < static_cast<std::uint32_t>(Trials(40)) && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    RandomParts walk(seed, seed % 2 == 1, seed % 3 == 0);
    walk.Go(400);
    collided += walk.collided;
    beside += walk.beside;
    activated += walk.activated;
    hindered += walk.hindered;
    off += walk.off;
    crossed += walk.crossed;
    moved += walk.moved;
    carried += walk.carried;
    on_track += walk.on_track;
    changed_track += walk.changed_track;
  }
  std::printf(
      "moved %d, over borders %d, off the stators %d; parts went %d, hindered %d, movers carried %d; cycles on "
      "tracks %d, from track to track %d; collisions refused %d, cycles side by side %d\n",
      moved, crossed, off, activated, hindered, carried, on_track, changed_track, collided, beside);
  EXPECT_GT(collided, Trials(10));
  EXPECT_GT(beside, Trials(100));
  EXPECT_GT(on_track, Trials(1000));
  EXPECT_GE(changed_track, Trials(4));
  EXPECT_GT(moved, Trials(80));
  EXPECT_GE(crossed, Trials(21));
  EXPECT_GT(off, Trials(150));
  EXPECT_GT(activated, Trials(300));
  EXPECT_GT(hindered, Trials(100));
  EXPECT_GT(carried, Trials(50));
}

// EN-06: the same commands give the same bits in another engine.
TEST(PartsWalk, CanBeReplayed) {
  RandomParts walk(3, false, true);
  walk.Go(500);
  ASSERT_GT(walk.carried, 3);
  Engine again(walk.rig.machine, {.journal = true, .snapshot_queue = 1 << 15});
  std::vector<JournalEntry> entries;
  for (JournalEntry entry; walk.rig.engine.journal().TryPop(entry);) entries.push_back(entry);
  std::size_t next = 0, cycles = 0;
  for (HashEntry expected; walk.rig.engine.hashes().TryPop(expected); ++cycles) {
    for (; next < entries.size() && entries[next].cycle == expected.cycle; ++next) {
      const CommandText text = ToText(walk.rig.machine, entries[next].command);
      ParsedCommand parsed = ParseCommand(walk.rig.machine, text.target, text.verb, text.arguments, Giver::kJournal);
      ASSERT_EQ(parsed.sentence, "");
      parsed.command.ticket = entries[next].command.ticket;
      ASSERT_TRUE(again.Resubmit(parsed.command));
    }
    again.RunCycle();
    ASSERT_EQ(again.figures().state_hash, expected.hash) << expected.cycle;
  }
  EXPECT_GT(cycles, 3000u);
  EXPECT_EQ(next, entries.size());
}

}  // namespace
}  // namespace takt::engine
