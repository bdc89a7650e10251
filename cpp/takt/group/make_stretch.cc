#include "takt/group/make_stretch.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "takt/group/boarding.h"
#include "takt/group/carrier_bindings.h"
#include "takt/group/jog.h"
#include "takt/path/arch.h"

namespace takt::group {

namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
// Tolerances for a spline that begins at the present pose: mm and rad.
constexpr double kSamePlace = 1e-3;
constexpr double kSameTurn = 1e-4;
// Factor by which a belt's velocity may change within the limits.
constexpr double kBeltChange = 1.1;
constexpr double kMostReserve = 0.9;  // of a limit
constexpr int kReserveRounds = 3;
constexpr int kBoardingRounds = 6;
constexpr double kBegins = 0.1;  // of the velocity share: acceleration and jerk kept for changes of a steady carrier
constexpr double kBends = 1e-6;  // of the acceleration limit: less is rounding

bool Given(double number) {
  return !std::isnan(number);
}
double Taken(double number, double before, bool relative) {
  return Given(number) ? (relative ? before + number : number) : before;
}

// Returns the target pose of a move in its coordinate system.
kinematics::Pose PoseOf(const Request& move, const kinematics::Pose& from) {
  const auto taken = [&](std::size_t i, double before) { return Taken(move.to[i], before, move.relative); };
  return {taken(0, from.x), taken(1, from.y), taken(2, from.z), taken(3, from.a), taken(4, from.b), taken(5, from.c)};
}

kinematics::Joints JointsOf(const Request& move, const kinematics::Joints& from) {
  kinematics::Joints joints = from;
  for (std::size_t k = 0; k < kMaxAxes; ++k) joints[k] = Taken(move.to[kToolNumbers + k], from[k], move.relative);
  return joints;
}

bool Any(const Request& move, std::size_t begin, std::size_t end) {
  return std::any_of(move.to.begin() + static_cast<std::ptrdiff_t>(begin),
                     move.to.begin() + static_cast<std::ptrdiff_t>(end), Given);
}

// Returns the auxiliary axes, which move along with the tool.
path::Auxiliaries Behind(const kinematics::Joints& joints, std::size_t count) {
  path::Auxiliaries auxiliaries{};
  std::copy(joints.begin() + static_cast<std::ptrdiff_t>(count), joints.end(), auxiliaries.begin());
  return auxiliaries;
}

path::Triple ToTriple(const KDL::Vector& v) {
  return {v.x(), v.y(), v.z()};
}
KDL::Vector ToVector(const path::Triple& t) {
  return {t[0], t[1], t[2]};
}

// Moves all axes in proportion, so that they arrive together.
ErrorId AlongJoints(const Request& move, const kinematics::Joints& to, LookAhead& ahead, State& s) {
  Stretch& stretch = ahead.next;
  stretch.joints = true;
  s.problem = path::MakeLine({Frame::Identity(), ahead.end_joints}, {Frame::Identity(), to}, stretch.segment);
  if (s.problem != path::Problem::kNone) return ErrorId::kPathGeometry;
  // Limits by the axis that is closest to its own.
  trajectory::AlongPath& limits = stretch.limits;
  limits = {kUnlimited, kUnlimited, kUnlimited, kUnlimited};
  const trajectory::CoordinateLimits& own = ahead.window.limits();
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    const double slope = std::abs(to[k] - ahead.end_joints[k]) / stretch.segment.length;
    if (s.members[k] == 0 || slope == 0) continue;
    const double acceleration = move.acceleration_factor * own.of[k].acceleration / slope;
    limits.velocity = std::min(limits.velocity, move.velocity_factor * own.of[k].velocity / slope);
    limits.acceleration = std::min(limits.acceleration, acceleration);
    limits.deceleration = std::min(limits.deceleration, acceleration);
    limits.jerk = std::min(limits.jerk, move.jerk_factor * own.of[k].jerk / slope);
  }
  if (move.kind != MoveKind::kDirect) limits = trajectory::Least(limits, move.limits);
  return ErrorId::kNone;
}

ErrorId AlongTool(const Context& c, const Request& move, const Frame& to, const path::Auxiliaries& auxiliaries,
                  const path::Circle* circle, LookAhead& ahead, State& s) {
  const path::Point begin{ahead.end_tool, Behind(ahead.end_joints, c.kinematics->count)};
  const path::Point end{to, auxiliaries};
  Stretch& stretch = ahead.next;
  stretch.limits = move.limits;
  s.problem =
      circle ? path::MakeArc(begin, *circle, end, stretch.segment) : path::MakeLine(begin, end, stretch.segment);
  return s.problem == path::Problem::kNone ? ErrorId::kNone : ErrorId::kPathGeometry;
}

// Computes the arc in the coordinate system of the command, in which a missing normal is chosen. `to`: in that system.
ErrorId AlongCircle(const Context& c, const Request& move, const Frame& system, const Frame& to,
                    const path::Auxiliaries& auxiliaries, LookAhead& ahead, State& s) {
  const path::Point begin{system.Inverse() * ahead.end_tool, Behind(ahead.end_joints, c.kinematics->count)};
  path::Circle circle = move.circle;
  if (move.relative && circle.mode != path::CircMode::kRadius) {
    circle.auxiliary_point = ToTriple(begin.frame.p + ToVector(circle.auxiliary_point));
  }
  Stretch& stretch = ahead.next;
  stretch.limits = move.limits;
  s.problem = path::MakeArc(begin, circle, {to, auxiliaries}, stretch.segment);
  if (s.problem != path::Problem::kNone) return ErrorId::kPathGeometry;
  stretch.segment = Moved(system, stretch.segment);
  return ErrorId::kNone;
}

// Keeps what a spline does not define as at its start: auxiliary axes, and the orientation unless null.
void Hold(const KDL::Rotation* orientation, const path::Auxiliaries& auxiliaries, path::Segment& segment) {
  segment.auxiliary_count = 0;
  for (std::size_t i = 0; i < path::kMaxAuxiliaries; ++i) {
    segment.auxiliaries[i] = {auxiliaries[i]};
    if (auxiliaries[i] != 0) segment.auxiliary_count = static_cast<std::uint8_t>(i + 1);
  }
  if (orientation == nullptr) return;
  segment.turning = path::Course::kStill;
  segment.turn = {};
  orientation->GetQuaternion(segment.base[0], segment.base[1], segment.base[2], segment.base[3]);
}

ErrorId AlongSpline(const PathPiece& piece, const Frame& system, const path::Auxiliaries& auxiliaries, LookAhead& ahead,
                    State& s) {
  path::Segment& segment = ahead.next.segment;
  segment = Moved(system, piece.segment);
  Hold(piece.turned ? nullptr : &ahead.end_tool.M, auxiliaries, segment);
  const Frame begin = path::PointAt(segment, 0).frame;
  const bool there = (begin.p - ahead.end_tool.p).Norm() <= kSamePlace;
  if (there && kinematics::TurnBetween(begin.M, ahead.end_tool.M).Norm() <= kSameTurn) return ErrorId::kNone;
  s.problem = path::Problem::kApart;
  return ErrorId::kPathGeometry;
}

ErrorId AlongPath(const Context& c, const Request& move, std::uint32_t element, const Frame& system, LookAhead& ahead,
                  State& s) {
  const PathPiece& piece = c.paths[move.path].pieces[element];
  Request one = move;
  if (piece.velocity > 0) one.limits.velocity = std::min(one.limits.velocity, piece.velocity);
  const path::Auxiliaries auxiliaries = Behind(ahead.end_joints, c.kinematics->count);
  if (piece.shape == ElementShape::kSpline) {
    ahead.next.limits = one.limits;
    return AlongSpline(piece, system, auxiliaries, ahead, s);
  }
  kinematics::Pose to = kinematics::ToPose(system.Inverse() * ahead.end_tool);
  to.x = piece.to.x;
  to.y = piece.to.y;
  to.z = piece.to.z;
  if (piece.turned) {
    to.a = piece.to.a;
    to.b = piece.to.b;
    to.c = piece.to.c;
  }
  path::Circle circle;
  circle.auxiliary_point = ToTriple(system * ToVector(piece.via));
  const bool arc = piece.shape == ElementShape::kArc;
  return AlongTool(c, one, system * kinematics::ToFrame(to), auxiliaries, arc ? &circle : nullptr, ahead, s);
}

// Makes one piece of an arch.
ErrorId AlongArch(const Context&, const Request& move, int piece, LookAhead& ahead, State& s) {
  Stretch& stretch = ahead.next;
  stretch.limits = move.limits;
  const auto make = [&](int i, path::Segment& out) {
    return path::MakeArchPiece(ahead.arch_begin, ahead.arch_end, move.height, ahead.arch_up, i, out);
  };
  ahead.arch_left = 0;
  for (int i = piece + 1; i < ahead.arch_pieces; ++i) {
    path::Segment other;
    if (make(i, other) == path::Problem::kNone) ahead.arch_left += other.length;
  }
  s.problem = make(piece, stretch.segment);
  return s.problem == path::Problem::kNone ? ErrorId::kNone : ErrorId::kPathGeometry;
}

// Moves the tool straight; direct moves with the limits of the axes only.
ErrorId Straight(const Context& c, const Request& move, const Frame& to, const path::Auxiliaries& auxiliaries,
                 LookAhead& ahead, State& s) {
  Request one = move;
  if (move.kind == MoveKind::kDirect) one.limits = {kUnlimited, kUnlimited, kUnlimited, kUnlimited};
  return AlongTool(c, one, to, auxiliaries, nullptr, ahead, s);
}

// Returns the coordinate system of a move in the planning frame, and sets the carrier binding that leads there.
Frame StillFrameOf(const Context& c, const Request& move, LookAhead& ahead) {
  const CarriedTarget& cargo = move.cargo;
  const CarrierBinding& end = ahead.rides[ahead.end_ride % kRides];
  Stretch& stretch = ahead.next;
  Frame frame = kinematics::ToFrame(move.frame);
  if (cargo.carrier == 0 && !end.displaces) return frame;
  if (cargo.carrier != 0) frame = Frame::Identity();
  if (cargo == end.cargo) return ReferenceOf(end) * frame;
  // The pose of the target on arrival depends on the duration of the move, which depends on that pose.
  double time = ahead.next_time_s;
  if (!(time > 0)) {
    const Frame from = DisplacementOf(c, end, 0).GetFrame() * ahead.end_tool;
    const Frame now = cargo.carrier != 0 ? PlaceOf(c, cargo).GetFrame() : frame;
    time = TimeFor(c, (now.p - from.p).Norm(), move.limits);
  }
  stretch.to_ride = BindTo(c, cargo, std::max(0.0, ahead.end_eta + time - Now(c)));
  return ReferenceOf(ahead.rides[stretch.to_ride % kRides]) * frame;
}

// From a carrier to positions of the axes: the tool moves straight, since a move of the axes would begin at rest, off
// the carrier.
ErrorId OffRide(const Context& c, const Request& move, const kinematics::Joints& to, LookAhead& ahead, State& s) {
  Frame tool;
  s.reason = ToolAt(c, to, tool);
  if (s.reason != kinematics::Reason::kNone) return ErrorId::kUnreachable;
  Request there = move;
  there.frame = {};
  there.cargo = {};
  const Frame still = StillFrameOf(c, there, ahead);
  return Straight(c, move, still * tool, Behind(to, c.kinematics->count), ahead, s);
}

}  // namespace

path::Segment Moved(const Frame& system, const path::Segment& segment) noexcept {
  path::Segment out = segment;
  out.place[0] = ToTriple(system * ToVector(segment.place[0]));
  for (std::size_t i = 1; i < out.place.size(); ++i) out.place[i] = ToTriple(system.M * ToVector(segment.place[i]));
  for (path::Triple& turn : out.turn) turn = ToTriple(system.M * ToVector(turn));
  const std::array<double, 4>& q = segment.base;
  (system.M * KDL::Rotation::Quaternion(q[0], q[1], q[2], q[3]))
      .GetQuaternion(out.base[0], out.base[1], out.base[2], out.base[3]);
  return out;
}

ErrorId MakeStretch(const Context& c, const Request& move, std::uint32_t element, LookAhead& ahead, State& s) noexcept {
  const bool rides = Moves(ahead.rides[ahead.end_ride % kRides]);
  Stretch& stretch = ahead.next;
  stretch.from_ride = stretch.to_ride = ahead.end_ride;
  if (move.kind == MoveKind::kArch && element > 0) stretch.from_ride = ahead.from_ride;
  if (move.kind == MoveKind::kJog) return MakeJog(c, move, ahead, s);
  if (move.system == CoordinateSystem::kAcs) {
    if (move.kind != MoveKind::kLinear && move.kind != MoveKind::kDirect) return ErrorId::kParameter;
    if (Any(move, 0, kToolNumbers)) return ErrorId::kParameter;
    const kinematics::Joints to = JointsOf(move, ahead.end_joints);
    return rides ? OffRide(c, move, to, ahead, s) : AlongJoints(move, to, ahead, s);
  }
  if (!HasTool(c, s)) return ErrorId::kState;
  const std::size_t count = c.kinematics->count;
  if (Any(move, kToolNumbers, kToolNumbers + count)) return ErrorId::kParameter;
  if (move.kind == MoveKind::kArch && element > 0) return AlongArch(c, move, static_cast<int>(element), ahead, s);
  const Frame system = StillFrameOf(c, move, ahead);
  if (move.kind == MoveKind::kPath) return AlongPath(c, move, element, system, ahead, s);
  const Frame target = kinematics::ToFrame(PoseOf(move, kinematics::ToPose(system.Inverse() * ahead.end_tool)));
  const Frame to = system * target;
  const kinematics::Joints joints = JointsOf(move, ahead.end_joints);
  if (move.kind == MoveKind::kArch) {
    ahead.arch_begin = {ahead.end_tool, Behind(ahead.end_joints, count)};
    ahead.arch_end = {to, Behind(joints, count)};
    const Frame world =
        DisplacementOf(c, ahead.rides[ahead.end_ride % kRides], 0).GetFrame().Inverse() * c.mounting.base_inverse;
    ahead.arch_up = ToTriple(world.M.UnitZ());
    ahead.arch_pieces = path::ArchPieces(ahead.arch_begin, ahead.arch_end, move.height, ahead.arch_up);
    return AlongArch(c, move, 0, ahead, s);
  }
  // Onto a moving carrier, and off it, the tool moves straight: the final positions of the axes are not known.
  if (move.kind == MoveKind::kDirect && !IsCarried(ahead, stretch)) {
    kinematics::Joints target = joints;
    Failures failures;
    s.reason = NearestJointsAt(c, s, to, move.configuration, ahead.end_joints, target, failures);
    if (s.reason == kinematics::Reason::kNone) return AlongJoints(move, target, ahead, s);
    ahead.failures = failures.Detail(c.number);
    return s.reason == kinematics::Reason::kSingular ? ErrorId::kSingular : ErrorId::kUnreachable;
  }
  const path::Auxiliaries auxiliaries = Behind(joints, count);
  if (move.kind == MoveKind::kDirect) return Straight(c, move, to, auxiliaries, ahead, s);
  if (move.kind == MoveKind::kCircular) return AlongCircle(c, move, system, target, auxiliaries, ahead, s);
  return AlongTool(c, move, to, auxiliaries, nullptr, ahead, s);
}

std::size_t ElementsOf(const Context& c, const Request& move) noexcept {
  if (move.kind == MoveKind::kPath) return c.paths[move.path].pieces.size();
  return move.kind == MoveKind::kArch ? static_cast<std::size_t>(std::max(1, c.ahead.arch_pieces)) : 1;
}

kinematics::Reason AxesOn(const Context& c, const State& s, const Stretch& stretch, double way,
                          const kinematics::Joints& near, kinematics::JointMotion& motion) noexcept {
  if (stretch.joints) {
    motion = path::AuxiliariesAt(stretch.segment, way);
    return WithinRanges(c, s, motion.position) ? kinematics::Reason::kNone : kinematics::Reason::kAxisLimit;
  }
  const KinematicState along = {way, 1, 0};
  const bool carried = IsCarried(c.ahead, stretch);
  const path::MovingFrame tool = carried ? PredictedTool(c, stretch, along, true) : path::At(stretch.segment, way);
  return AxesFor(c, s, stretch, tool, along, near, motion);
}

std::uint64_t FailuresOn(const Context& c, const State& s, const Stretch& stretch, double way,
                         kinematics::Reason reason, const kinematics::Joints& near) noexcept {
  const kinematics::Joints behind = path::AuxiliariesAt(stretch.segment, way).position;
  if (stretch.joints) return FailuresOf(c, s, behind).Detail(c.number);
  kinematics::Joints from = near;
  for (std::size_t k = c.kinematics->count; k < kMaxAxes; ++k) from[k] = behind[k - c.kinematics->count];
  const KinematicState along = {way, 1, 0};
  const bool carried = IsCarried(c.ahead, stretch);
  const path::MovingFrame tool = carried ? PredictedTool(c, stretch, along, true) : path::At(stretch.segment, way);
  return FailuresAt(c, s, tool.GetFrame(), reason, from).Detail(c.number);
}

kinematics::Reason AxesFor(const Context& c, const State& s, const Stretch& stretch, const path::MovingFrame& tool,
                           const KinematicState& along, const kinematics::Joints& near,
                           kinematics::JointMotion& motion) noexcept {
  const path::MovingFrame flange = tool * c.mounting.tool_inverse;
  const kinematics::Reason reason = kinematics::Inverse(*c.kinematics, flange, {}, near, motion);
  if (reason != kinematics::Reason::kNone) return reason;
  const path::AuxiliaryMotion behind = path::AuxiliariesAt(stretch.segment, along.position);
  for (std::size_t k = c.kinematics->count; k < kMaxAxes; ++k) {
    const std::size_t i = k - c.kinematics->count;
    const KinematicState at =
        trajectory::ComposeWithMaster({behind.position[i], behind.velocity[i], behind.acceleration[i]}, along);
    motion.position[k] = at.position;
    motion.velocity[k] = at.velocity;
    motion.acceleration[k] = at.acceleration;
  }
  return WithinRanges(c, s, motion.position) ? kinematics::Reason::kNone : kinematics::Reason::kAxisLimit;
}

namespace {

trajectory::PathSlopes SlopesOf(const kinematics::JointMotion& motion) {
  trajectory::PathSlopes slopes;
  std::copy(motion.velocity.begin(), motion.velocity.end(), slopes.first.begin());
  std::copy(motion.acceleration.begin(), motion.acceleration.end(), slopes.second.begin());
  return slopes;
}

// Shares of a coordinate's limits that are in use.
struct TakenShares {
  double velocity = 0;
  double acceleration = 0;
  double jerk = 0;
};

TakenShares TakenBeside(const trajectory::CoordinateLimits::One& of, const CarrierPart& part, double speed,
                        const Boarding* boarding, std::size_t k) {
  const double own = kBeltChange * std::abs(part.velocity), own_bend = kBeltChange * std::abs(part.bend);
  const double faster = boarding ? boarding->faster : 1;
  const double over = kBeltChange * faster * 2 * std::abs(part.cross) * speed;
  // Where the axes are not linear in the travel of the carrier, its share of the jerk is not known.
  const double bends = (over + own_bend) / of.acceleration;
  const double jerk = bends > kBends ? std::max(own / of.velocity, bends) : kBegins * own / of.velocity;
  if (!boarding) return {own / of.velocity, bends, jerk};
  return {std::max(own, boarding->velocity[k]) / of.velocity,
          (over + std::max(own_bend, boarding->acceleration[k])) / of.acceleration, jerk + boarding->jerk[k] / of.jerk};
}

trajectory::Left LeftOf(const TakenShares& taken) {
  const auto left = [](double share) { return 1 - std::min(share, kMostReserve); };
  return {left(taken.velocity), left(taken.acceleration + kBegins * taken.velocity), left(taken.jerk)};
}

// Computes the share of each limit that the path may use: carriers use q_t of the velocity, q = q_s v + q_t, and 2 q_st
// v + q_tt of the acceleration. An unsteady carrier may have to be braked together with the path: then the least share
// over all axes and quantities applies to all of them. Boarding takes a share of its own.
void Reserve(const Context& c, const trajectory::PathSlopes& moving, const trajectory::PathSlopes& resting,
             bool unsteady, const Boarding* boarding, trajectory::PathPoint& point) {
  const trajectory::CoordinateLimits& limits = c.ahead.window.limits();
  double speed = 0;
  for (int round = 0; round < (boarding ? kBoardingRounds : kReserveRounds); ++round) {
    const double before = speed;
    speed = std::sqrt(trajectory::SquareAt(point, limits, 1));
    if (boarding) {
      const double attained = PathSpeedBound(point, limits, c.ahead.window.build_up_s(), *boarding);
      speed = std::min(speed, round == 0 ? attained : std::sqrt(before * attained));
    }
    double most = 0;
    for (std::size_t k = 0; k < limits.count; ++k) {
      const trajectory::CoordinateLimits::One& of = limits.of[k];
      const double cross = 0.5 * (moving.second[k] - point.slopes.second[k] - resting.second[k]);
      const TakenShares taken = TakenBeside(of, {resting.first[k], resting.second[k], cross}, speed, boarding, k);
      point.left[k] = LeftOf(taken);
      most = std::max({most, taken.velocity, taken.acceleration});
      c.ahead.load = std::max(c.ahead.load, kBeltChange * std::abs(resting.first[k]) / of.velocity);
    }
    if (unsteady) {
      const double left = 1 - std::min(most, kMostReserve);
      point.left.fill({left, left, left});
    }
  }
}

}  // namespace

trajectory::Left LeftBeside(const trajectory::CoordinateLimits::One& of, const CarrierPart& part, double speed,
                            const Boarding* boarding, std::size_t k) noexcept {
  return LeftOf(TakenBeside(of, part, speed, boarding, k));
}

trajectory::PathSlopes CoordinatesOf(const Context& c, const kinematics::JointMotion& motion,
                                     const path::MovingFrame& tool) noexcept {
  trajectory::PathSlopes slopes = SlopesOf(motion);
  if (c.ahead.window.limits().count <= kMaxAxes) return slopes;
  const KDL::Rotation& world = c.mounting.base.M;
  const std::array<KDL::Vector, 4> of_tool = {world * tool.p.v, world * tool.p.dv, world * tool.M.w * kDegrees,
                                              world * tool.M.dw * kDegrees};
  for (int i = 0; i < 3; ++i) {
    const std::size_t k = kMaxAxes + static_cast<std::size_t>(i);
    slopes.first[k] = of_tool[0](i);
    slopes.second[k] = of_tool[1](i);
    slopes.first[k + 3] = of_tool[2](i);
    slopes.second[k + 3] = of_tool[3](i);
  }
  return slopes;
}

kinematics::Reason SlopesOn(const Context& c, const State& s, const Stretch& stretch, double way,
                            const kinematics::Joints& near, trajectory::PathPoint& point,
                            kinematics::JointMotion& motion) noexcept {
  kinematics::Reason reason = AxesOn(c, s, stretch, way, near, motion);
  if (reason != kinematics::Reason::kNone) return reason;
  point.left = {};
  if (stretch.joints) {
    point.slopes = SlopesOf(motion);
    return reason;
  }
  const bool carried = IsCarried(c.ahead, stretch);
  const KinematicState along = {way, 1, 0}, resting = {way, 0, 0};
  point.slopes =
      CoordinatesOf(c, motion, carried ? PredictedTool(c, stretch, along, true) : path::At(stretch.segment, way));
  if (!carried) return reason;
  std::array<trajectory::PathSlopes, 2> with;
  for (std::size_t i = 0; i < 2; ++i) {
    const KinematicState& one = i == 0 ? along : resting;
    const path::MovingFrame tool = PredictedTool(c, stretch, one, false);
    kinematics::JointMotion moved;
    reason = AxesFor(c, s, stretch, tool, one, motion.position, moved);
    if (reason != kinematics::Reason::kNone) return reason;
    with[i] = CoordinatesOf(c, moved, tool);
  }
  const Boarding* boarding = BoardingOn(c.ahead, stretch);
  const bool boards = boarding && stretch.begin + way - stretch.from < boarding->reach;
  Reserve(c, with[0], with[1], IsUnsteady(c, stretch), boards ? boarding : nullptr, point);
  return reason;
}

bool Foresee(const Context& c, const State& s, const KinematicState& along, double ahead_s,
             trajectory::PathCoordinateValues& positions, trajectory::PathCoordinateValues& velocities,
             trajectory::PathCoordinateValues& accelerations) noexcept {
  const LookAhead& ahead = c.ahead;
  if (ahead.count == 0) return false;
  const bool stands = ahead[ahead.first].from_ride == ahead.end_ride;
  if (stands && !ahead.rides[ahead.end_ride % kRides].displaces) return false;
  const Stretch& stretch = *ahead.At(along.position);
  if (!IsCarried(ahead, stretch)) return false;
  KinematicState way = along;
  way.position = std::clamp(stretch.from + along.position - stretch.begin, stretch.from, stretch.to);
  const path::MovingFrame tool = ToolIn(c, stretch, way, ahead_s);
  kinematics::Joints near = s.joints;
  if (!std::isnan(positions[0])) std::copy_n(positions.begin(), kMaxAxes, near.begin());
  kinematics::JointMotion motion;
  if (AxesFor(c, s, stretch, tool, way, near, motion) != kinematics::Reason::kNone) return false;
  std::copy(motion.position.begin(), motion.position.end(), positions.begin());
  const trajectory::PathSlopes values = CoordinatesOf(c, motion, tool);
  velocities = values.first;
  accelerations = values.second;
  return true;
}

}  // namespace takt::group
