// Rules on combinations of a command's fields, beyond their ranges.
#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "takt/core/in_range.h"
#include "takt/core/problem.h"
#include "takt/group/commands.h"
#include "takt/group/texts.h"

namespace takt::group {

namespace {

// Returns the name of the first tool coordinate that is given; empty if none.
template <typename T>
std::string_view GivenOfTool(const T& c) {
  constexpr std::array<std::string_view, 6> kNames{"x", "y", "z", "a", "b", "c"};
  const std::array given{c.x.has_value(), c.y.has_value(), c.z.has_value(),
                         c.a.has_value(), c.b.has_value(), c.c.has_value()};
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (given[i]) return kNames[i];
  }
  return {};
}

template <typename T>
bool GivesAxis(const T& c) {
  return c.a1 || c.a2 || c.a3 || c.a4 || c.a5 || c.a6 || c.a7 || c.a8;
}

template <typename T>
std::string WhyNotInAcs(const T& c) {
  const std::string_view given = GivenOfTool(c);
  if (c.coordinate_system != CoordinateSystem::kAcs || given.empty()) return {};
  return std::string(given) + ": expected a1 to a8 only, with coordinate_system acs";
}

template <typename T>
std::string WhyNotTransition(const T& c) {
  const bool place =
      c.transition_mode == TransitionMode::kCornerDistance || c.transition_mode == TransitionMode::kMaxCornerDeviation;
  if (!place || c.transition_parameter > 0) return {};
  return "transition_parameter: expected mm above 0 with this transition_mode, found 0";
}

template <typename T>
std::string WhyNotAPlace(const T& c) {
  if (c.coordinate_system != CoordinateSystem::kAcs) return {};
  return "coordinate_system: expected mcs, wcs or pcs, found acs: such a path needs a tool";
}

template <typename T>
std::string WhyNotNamed(const char* field, const T& name, const char* of) {
  if (!name.empty()) return {};
  return std::string(field) + ": expected the name of " + of + ", found ''";
}

std::string FirstOf(std::string a, std::string b) {
  return a.empty() ? std::move(b) : std::move(a);
}

template <Reference kReference>
std::string WhyNotThis(const MoveLinear<kReference>& c) {
  return FirstOf(WhyNotInAcs(c), WhyNotTransition(c));
}

template <Reference kReference>
std::string WhyNotThis(const MoveDirect<kReference>& c) {
  return FirstOf(WhyNotInAcs(c), WhyNotTransition(c));
}

template <Reference kReference>
std::string WhyNotThis(const MoveCircular<kReference>& c) {
  const bool short_or_long = c.path_choice == path::PathChoice::kShort || c.path_choice == path::PathChoice::kLong;
  if (c.circ_mode == path::CircMode::kRadius && !short_or_long) {
    return "path_choice: expected short or long with circ_mode radius";
  }
  if (c.circ_mode == path::CircMode::kCenter && short_or_long) {
    return "path_choice: expected counterclockwise or clockwise with circ_mode center";
  }
  return FirstOf(WhyNotAPlace(c), WhyNotTransition(c));
}

std::string WhyNotThis(const MovePath& c) {
  return FirstOf(WhyNotNamed("path", c.path, "a path"), FirstOf(WhyNotAPlace(c), WhyNotTransition(c)));
}

std::string WhyNotThis(const MovePathSynchronized& c) {
  if (c.ratio == 0) return "ratio: expected a number other than 0";
  return FirstOf(FirstOf(WhyNotNamed("path", c.path, "a path"), WhyNotNamed("master", c.master, "an axis")),
                 FirstOf(WhyNotAPlace(c), WhyNotTransition(c)));
}

std::string WhyNotThis(const SyncAxis& c) {
  if (c.ratio_denominator == 0) return "ratio_denominator: expected a number other than 0";
  return WhyNotNamed("axis", c.axis, "an axis");
}

std::string WhyNotThis(const AddAxis& c) {
  return WhyNotNamed("axis", c.axis, "an axis");
}

std::string WhyNotThis(const SetPosition& c) {
  if (GivenOfTool(c).empty() && !GivesAxis(c)) return "x: expected at least one of x to c or a1 to a8";
  return WhyNotInAcs(c);
}

std::string WhyNotThis(const SetCoordinateTransform& c) {
  if (c.reference == CoordinateSystem::kAcs) return "reference: expected mcs, wcs or pcs, found acs";
  if (c.reference == CoordinateSystem::kPcs && c.reference_pcs == c.pcs) {
    return "reference_pcs: expected another coordinate system than pcs itself";
  }
  return {};
}

std::string WhyNotThis(const Calibrate& c) {
  const std::array<std::optional<double>, 9> seen = {c.seen_x1, c.seen_y1, c.seen_z1, c.seen_x2, c.seen_y2,
                                                     c.seen_z2, c.seen_x3, c.seen_y3, c.seen_z3};
  const auto given = [](const auto& numbers) {
    return std::ranges::count_if(numbers, [](const auto& number) { return number.has_value(); });
  };
  const auto fourth = given(std::array{c.x4, c.y4, c.z4}),
             fourth_seen = given(std::array{c.seen_x4, c.seen_y4, c.seen_z4});
  if (fourth != 0 && fourth != 3) return "x4: expected x4, y4 and z4 together";
  if (given(seen) != 0 && given(seen) != 9) return "seen_x1: expected the numbers of all places in the system, or none";
  const auto wanted = given(seen) != 0 ? fourth : 0;
  if (fourth_seen != wanted) {
    return wanted != 0 ? "seen_x4: expected the numbers of all places in the system, or none"
                       : "seen_x4: expected no value without x4, y4, z4 and all other seen values";
  }
  return {};
}

std::string WhyNotThis(const SetDynCoordTransform& c) {
  return WhyNotNamed("carrier", c.carrier, "a belt, a group or a pose");
}

std::string WhyNotThis(const Jog& c) {
  const std::array<std::pair<std::string_view, double>, 6> tool = {
      {{"x", c.x}, {"y", c.y}, {"z", c.z}, {"a", c.a}, {"b", c.b}, {"c", c.c}}};
  for (const auto& [name, speed] : tool) {
    if (c.coordinate_system != JogSystem::kAcs || speed == 0) continue;
    return std::string(name) + ": expected a1 to a8 only, with coordinate_system acs";
  }
  return {};
}

std::string WhyNotThis(const StreamPoint& c) {
  if (GivenOfTool(c).empty() && !GivesAxis(c)) return "x: expected at least one of x to c or a1 to a8";
  const bool moves = c.vx || c.vy || c.vz || c.wx || c.wy || c.wz;
  if (c.coordinate_system == CoordinateSystem::kAcs && moves) {
    return "vx: expected v1 to v8 only, with coordinate_system acs";
  }
  return WhyNotInAcs(c);
}

std::string WhyNotThis(const MoveArch& c) {
  return FirstOf(WhyNotAPlace(c), WhyNotTransition(c));
}

// Range of tracking of an object: mm or deg of its carrier.
struct Tracked {
  std::string_view begin_name, end_name, sync_in_name, unit;
  double begin = 0;
  std::optional<double> end{};
  double sync_in = 0;

  ErrorId error() const {
    if (!end) return ErrorId::kNone;
    if (*end < begin) return ErrorId::kTrackOrder;
    return *end - begin < sync_in ? ErrorId::kTrackShort : ErrorId::kNone;
  }
};

Tracked TrackedBy(const TrackConveyorBelt& c) {
  return {"start_distance",
          "end_distance",
          "sync_in_conveyor_distance",
          "mm",
          c.start_distance,
          c.end_distance,
          c.sync_in_conveyor_distance.value_or(0)};
}

Tracked TrackedBy(const TrackRotaryTable& c) {
  return {"start_angle", "end_angle", "sync_in_angle", "deg", c.start_angle, c.end_angle, c.sync_in_angle.value_or(0)};
}

template <typename T>
requires requires(const T& c) {
  TrackedBy(c);
}
std::string WhyNotThis(const T& c) {
  const Tracked t = TrackedBy(c);
  if (t.error() == ErrorId::kNone) return {};
  const bool order = t.error() == ErrorId::kTrackOrder;
  return std::string(t.end_name) + ": expected " + Text(at_least(order ? t.begin : t.begin + t.sync_in)) + " " +
         std::string(t.unit) + ", " + std::string(t.begin_name) + (order ? "" : " and " + std::string(t.sync_in_name));
}

template <typename T>
std::string WhyNotThis(const T&) {
  return {};
}

}  // namespace

std::string Diagnose(const Command& command) {
  return std::visit(
      []<typename T>(const T& c) {
        const Field* wrong = FirstOutOfRange(TypeOf<T>(), &c);
        if (wrong == nullptr) return WhyNotThis(c);
        const std::string range = Text(wrong->range);
        return std::string(wrong->name) + ": expected " + (range.empty() ? "a value of its kind" : "a number " + range);
      },
      command);
}

ErrorId ErrorOf(const Command& command) noexcept {
  ErrorId error = ErrorId::kNone;
  if (const auto* belt = std::get_if<TrackConveyorBelt>(&command); belt && InRange(*belt)) {
    error = TrackedBy(*belt).error();
  }
  if (const auto* table = std::get_if<TrackRotaryTable>(&command); table && InRange(*table)) {
    error = TrackedBy(*table).error();
  }
  return error == ErrorId::kNone ? ErrorId::kParameter : error;
}

}  // namespace takt::group
