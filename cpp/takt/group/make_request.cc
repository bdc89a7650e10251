#include "takt/group/make_request.h"

#include <algorithm>
#include <cmath>

#include "takt/core/describe.h"
#include "takt/core/in_range.h"
#include "takt/group/systems.h"

namespace takt::group {

namespace {

double OrNothing(const std::optional<double>& number) {
  return number.value_or(kNotGiven);
}

template <typename T>
Numbers NumbersOf(const T& m) {
  return {OrNothing(m.x),  OrNothing(m.y),  OrNothing(m.z),  OrNothing(m.a),  OrNothing(m.b),
          OrNothing(m.c),  OrNothing(m.a1), OrNothing(m.a2), OrNothing(m.a3), OrNothing(m.a4),
          OrNothing(m.a5), OrNothing(m.a6), OrNothing(m.a7), OrNothing(m.a8)};
}

constexpr Numbers NoNumbers() {
  Numbers numbers{};
  numbers.fill(kNotGiven);
  return numbers;
}

// Returns true if a coordinate is given for an axis that is not a member.
bool GivesNobody(const Numbers& to, const State& s) {
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] == 0 && !std::isnan(to[kToolNumbers + k])) return true;
  }
  return false;
}

struct RequestMaker {
  const Context& c;
  const State& s;
  Request& r;

  template <typename T>
  void TakeManner(const T& m) const {
    const PathLimits& own = c.params.path;
    r.system = m.coordinate_system;
    r.pcs = m.pcs - 1;
    r.limits.velocity = m.velocity.value_or(own.velocity);
    r.limits.acceleration = s.acceleration_factor * m.acceleration.value_or(own.acceleration);
    r.limits.deceleration =
        s.acceleration_factor * m.deceleration.value_or(own.deceleration.value_or(own.acceleration));
    r.limits.jerk = s.jerk_factor * m.jerk.value_or(own.jerk);
    r.transition_mode = m.transition_mode;
    r.transition_parameter = m.transition_parameter;
  }

  ErrorId TakePath(const Name& name) const {
    r.kind = MoveKind::kPath;
    r.to = NoNumbers();
    for (std::size_t i = 0; i < c.paths.size(); ++i) {
      if (c.paths[i].name != name.view()) continue;
      r.path = static_cast<std::uint32_t>(i);
      return ErrorId::kNone;
    }
    return ErrorId::kPathUnknown;
  }

  template <Reference kReference>
  ErrorId Fill(const MoveLinear<kReference>& m) const {
    r.kind = MoveKind::kLinear;
    r.relative = kReference == Reference::kRelative;
    r.to = NumbersOf(m);
    r.buffer_mode = m.buffer_mode;
    TakeManner(m);
    return ErrorId::kNone;
  }
  template <Reference kReference>
  ErrorId Fill(const MoveCircular<kReference>& m) const {
    r.kind = MoveKind::kCircular;
    r.relative = kReference == Reference::kRelative;
    r.to = NumbersOf(m);
    r.buffer_mode = m.buffer_mode;
    r.circle = {m.circ_mode,
                {m.aux_x, m.aux_y, m.aux_z},
                m.path_choice,
                {m.normal_x, m.normal_y, m.normal_z},
                static_cast<double>(m.turns)};
    TakeManner(m);
    return m.coordinate_system == CoordinateSystem::kAcs ? ErrorId::kParameter : ErrorId::kNone;
  }
  template <Reference kReference>
  ErrorId Fill(const MoveDirect<kReference>& m) const {
    r.kind = MoveKind::kDirect;
    r.configuration = {m.shoulder, m.elbow, m.wrist};
    r.relative = kReference == Reference::kRelative;
    r.to = NumbersOf(m);
    r.system = m.coordinate_system;
    r.pcs = m.pcs - 1;
    r.velocity_factor = m.velocity_factor;
    r.acceleration_factor = s.acceleration_factor * m.acceleration_factor;
    r.jerk_factor = s.jerk_factor * m.jerk_factor;
    r.buffer_mode = m.buffer_mode;
    r.transition_mode = m.transition_mode;
    r.transition_parameter = m.transition_parameter;
    return ErrorId::kNone;
  }
  ErrorId Fill(const MoveArch& m) const {
    r.kind = MoveKind::kArch;
    r.to = NumbersOf(m);
    r.height = m.height;
    r.buffer_mode = m.buffer_mode;
    TakeManner(m);
    return m.coordinate_system == CoordinateSystem::kAcs ? ErrorId::kParameter : ErrorId::kNone;
  }
  ErrorId Fill(const Jog& m) const {
    r.kind = MoveKind::kJog;
    r.to = {m.x, m.y, m.z, m.a, m.b, m.c, m.a1, m.a2, m.a3, m.a4, m.a5, m.a6, m.a7, m.a8};
    for (double& speed : r.to) speed = speed != 0 ? speed : kNotGiven;
    r.jog_system = m.coordinate_system;
    const bool axes = m.coordinate_system == JogSystem::kAcs;
    r.system = axes ? CoordinateSystem::kAcs : CoordinateSystem::kMcs;
    r.pcs = m.pcs - 1;
    const PathLimits& own = c.params.path;
    const double deceleration = own.deceleration.value_or(own.acceleration);
    r.limits = {own.velocity, s.acceleration_factor * m.acceleration.value_or(own.acceleration),
                s.acceleration_factor * m.deceleration.value_or(deceleration),
                s.jerk_factor * m.jerk.value_or(own.jerk)};
    // Velocities of the tool belong to Cartesian systems, those of the axes that move it to ACS.
    const auto first = r.to.begin(), of_axes = first + kToolNumbers;
    const auto given = [](double speed) { return !std::isnan(speed); };
    const auto moves_tool = static_cast<std::ptrdiff_t>(InKinematics(c, s));
    const bool strange = axes ? std::any_of(first, of_axes, given) : std::any_of(of_axes, of_axes + moves_tool, given);
    return strange ? ErrorId::kParameter : ErrorId::kNone;
  }
  ErrorId Fill(const MovePath& m) const {
    r.buffer_mode = m.buffer_mode;
    TakeManner(m);
    return m.coordinate_system == CoordinateSystem::kAcs ? ErrorId::kParameter : TakePath(m.path);
  }
  ErrorId Fill(const MovePathSynchronized& m) const {
    TakeManner(m);
    r.ratio = m.ratio;
    if (m.coordinate_system == CoordinateSystem::kAcs) return ErrorId::kParameter;
    const std::uint32_t master = axis::FindAxis(c.axes.params, m.master.view());
    if (master == axis::kNoAxis) return ErrorId::kUnknownTarget;
    r.master = master + 1;
    return c.group_of[master] == c.number ? ErrorId::kParameter : TakePath(m.path);
  }
};

template <typename T>
concept IsMove = requires(const RequestMaker& maker, const T& command) {
  maker.Fill(command);
};

}  // namespace

std::optional<MadeRequest> MakeRequest(const Context& c, const State& s, const Command& command) noexcept {
  return std::visit(
      [&]<typename T>(const T& m) -> std::optional<MadeRequest> {
        if constexpr (IsMove<T>) {
          MadeRequest made;
          made.error = RequestMaker{c, s, made.move}.Fill(m);
          if (GivesNobody(made.move.to, s)) made.error = ErrorId::kNotGroupMember;
          if (!HasTool(c, s) && made.move.system != CoordinateSystem::kAcs) made.error = ErrorId::kState;
          return made;
        } else {
          return std::nullopt;
        }
      },
      command);
}

}  // namespace takt::group
