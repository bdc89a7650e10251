#include "takt/group/carrier_bindings.h"

#include <algorithm>
#include <cmath>

#include "takt/path/turn.h"
#include "takt/trajectory/quintic.h"

namespace takt::group {

namespace {

// Relative rounding error of arc lengths, which accumulate while the tool does not come to rest: within it from the
// ends of a transition the weight is 0 or 1.
constexpr double kOfPlace = 1e-14;
constexpr double kLeastRounded = 1e5;  // [mm] least arc length for which rounding is assumed
constexpr double kUnsteady_s = 3;      // after a change of velocity a carrier counts as unsteady
constexpr double kSteady = 1e-3;       // [mm/s² or rad/s²]: less is rounding

// Converts a motion over arc length to one over time.
MovingFrame InTime(const MovingFrame& over_way, const KinematicState& way) {
  const double v = way.velocity, square = v * v, a = way.acceleration;
  MovingFrame out;
  out.p = KDL::VectorAcc(over_way.p.p, over_way.p.v * v, over_way.p.dv * square + over_way.p.v * a);
  out.M = KDL::RotationAcc(over_way.M.R, over_way.M.w * v, over_way.M.dw * square + over_way.M.w * a);
  return out;
}

MovingFrame Still(const MovingFrame& frame) {
  return MovingFrame(frame.GetFrame());
}

// Interpolates between two moving frames with the weight `share`.
MovingFrame Mix(const MovingFrame& from, const MovingFrame& to, const KinematicState& share) {
  const double w = share.position, dw = share.velocity, ddw = share.acceleration;
  const KDL::VectorAcc apart = to.p - from.p;
  MovingFrame out;
  out.p.p = from.p.p + w * apart.p;
  out.p.v = from.p.v + w * apart.v + dw * apart.p;
  out.p.dv = from.p.dv + w * apart.dv + 2 * dw * apart.v + ddw * apart.p;
  // The rotation from the first frame to the second, and its derivatives, in the first frame.
  const KDL::Rotation back = from.M.R.Inverse();
  const KDL::Vector turn = back * kinematics::TurnBetween(from.M.R, to.M.R);
  if (turn.Norm() < 1e-12 && (to.M.w - from.M.w).Norm() < 1e-12 && (to.M.dw - from.M.dw).Norm() < 1e-12) {
    out.M = from.M;
    return out;
  }
  const KDL::Vector w0 = back * from.M.w;
  const KDL::Vector spin = back * (to.M.w - from.M.w);
  const KDL::Vector change = back * (to.M.dw - from.M.dw) - w0 * spin;  // of the spin, in the first frame
  const path::Derivatives<path::Vector> log =
      path::TurnOf(path::ToVector(turn), path::ToVector(spin), path::ToVector(change));
  const path::Turned part = path::TurnBy(
      {w * log.value, w * log.first + dw * log.value, w * log.second + 2 * dw * log.first + ddw * log.value});
  MovingFrame moved = MovingFrame::Identity();
  const Eigen::Quaterniond& q = part.rotation;
  moved.M = KDL::RotationAcc(KDL::Rotation::Quaternion(q.x(), q.y(), q.z(), q.w()), path::ToKdl(part.velocity),
                             path::ToKdl(part.acceleration));
  out.M = from.M * moved.M;
  return out;
}

const CarrierBinding& RideAt(const LookAhead& ahead, std::uint64_t number) {
  return ahead.rides[number % ahead.rides.size()];
}

// The carrier with the travel that its clutch gives the tool.
kinematics::Carrier Clutched(const State& s, std::uint64_t ride, kinematics::Carrier carrier) {
  for (const Clutch& clutch : s.clutches) {
    if (clutch.used && !clutch.coupled && clutch.ride == ride) carrier.travel = clutch.travel;
  }
  return carrier;
}

MovingFrame Displaced(const CarrierBinding& ride, const kinematics::Carrier& carrier) {
  if (!Moves(ride)) return MovingFrame(ride.reference_inverse);
  return kinematics::PoseOn(carrier, ride.cargo.from, kinematics::ToFrame(ride.cargo.lies)) * ride.reference_inverse;
}

template <typename Displacement>
MovingFrame ToolOn(const LookAhead& ahead, const Stretch& stretch, const KinematicState& way,
                   const Displacement& displacement) {
  const MovingFrame place = InTime(path::At(stretch.segment, way.position), way);
  const KinematicState share = trajectory::ComposeWithMaster(ShareAt(ahead, stretch, way.position), way);
  if (stretch.from_ride == stretch.to_ride || share.position <= 0) return displacement(stretch.from_ride) * place;
  if (share.position >= 1) return displacement(stretch.to_ride) * place;
  return Mix(displacement(stretch.from_ride) * place, displacement(stretch.to_ride) * place, share);
}

}  // namespace

kinematics::Carrier CarrierOf(const Context& c, const CarriedTarget& cargo, double ahead_s) noexcept {
  kinematics::Carrier carrier = c.carriers.At(cargo.carrier);
  if (cargo.has_origin) {
    carrier.origin = kinematics::ToFrame(cargo.origin);
  } else {
    carrier.origin = c.mounting.base_inverse * carrier.origin;
  }
  carrier.pose = c.mounting.base_inverse * carrier.pose;
  return ahead_s > 0 ? kinematics::Ahead(carrier, ahead_s) : carrier;
}

MovingFrame PlaceOf(const Context& c, const CarriedTarget& cargo, double ahead_s) noexcept {
  return kinematics::PoseOn(CarrierOf(c, cargo, ahead_s), cargo.from, kinematics::ToFrame(cargo.lies));
}

bool Moves(const CarrierBinding& ride) noexcept {
  return ride.cargo.carrier != 0;
}

double SpeedOf(const Context& c, const CarriedTarget& cargo) noexcept {
  if (cargo.carrier == 0) return 0;
  const kinematics::Carrier carrier = CarrierOf(c, cargo);
  return carrier.kind == kinematics::CarrierKind::kFree ? carrier.pose.p.v.Norm() : carrier.travel.velocity;
}

void WatchCarriers(const Context& c, const State& s) noexcept {
  for (std::size_t i = 0; i < kProductSystems; ++i) {
    Unsteady& one = c.ahead.unsteady[i];
    if (one.carrier != s.cargoes[i].carrier) one = {s.cargoes[i].carrier, 0};
    if (one.carrier == 0) continue;
    const kinematics::Carrier carrier = c.carriers.At(one.carrier);
    const bool free = carrier.kind == kinematics::CarrierKind::kFree;
    const double change = free ? carrier.pose.p.dv.Norm() : std::abs(carrier.travel.acceleration);
    one.left_s = change > kSteady ? kUnsteady_s : std::max(0.0, one.left_s - c.cycle.period_s);
  }
}

bool IsUnsteady(const Context& c, const Stretch& stretch) noexcept {
  const std::uint32_t from = RideAt(c.ahead, stretch.from_ride).cargo.carrier;
  const std::uint32_t to = RideAt(c.ahead, stretch.to_ride).cargo.carrier;
  return std::ranges::any_of(c.ahead.unsteady, [&](const Unsteady& one) {
    return one.left_s > 0 && (one.carrier == from || one.carrier == to);
  });
}

Frame ReferenceOf(const CarrierBinding& ride) noexcept {
  return ride.reference_inverse.Inverse();
}

KinematicState ApartIn(const Context& c, const CarrierBinding& ride, double ahead_s) noexcept {
  if (!ride.boarding.on) return {};
  const double since_s = static_cast<double>(c.cycle.count + 1 - ride.boarding.begin) * c.cycle.period_s;
  return ride.boarding.apart.At(since_s + ahead_s);
}

MovingFrame DisplacementOf(const Context& c, const CarrierBinding& ride, double ahead_s) noexcept {
  kinematics::Carrier carrier = CarrierOf(c, ride.cargo, ahead_s);
  carrier.travel.position += ApartIn(c, ride, ahead_s).position;
  return Displaced(ride, carrier);
}

std::uint64_t BindTo(const Context& c, const CarriedTarget& cargo, double arrival_s) noexcept {
  LookAhead& ahead = c.ahead;
  const CarrierBinding& end = RideAt(ahead, ahead.end_ride);
  if (end.cargo == cargo) return ahead.end_ride;
  CarrierBinding& ride = ahead.rides[ahead.rides_end % ahead.rides.size()];
  const Frame there = cargo.carrier != 0 ? PlaceOf(c, cargo, arrival_s).GetFrame() : Frame::Identity();
  ride.reference_inverse = there.Inverse() * DisplacementOf(c, end, arrival_s).GetFrame();
  ride.cargo = cargo;
  ride.boarding = {};
  ride.speed = SpeedOf(c, cargo);
  ride.displaces = Moves(ride) || !KDL::Equal(ride.reference_inverse, Frame::Identity(), 0);
  return ahead.rides_end;
}

CarrierBinding BindingAtRest(const Context& c, const CarriedTarget& cargo, double travel) noexcept {
  kinematics::Carrier carrier = CarrierOf(c, cargo);
  carrier.travel = {travel, 0, 0};
  CarrierBinding ride;
  ride.cargo = cargo;
  ride.reference_inverse =
      kinematics::PoseOn(carrier, cargo.from, kinematics::ToFrame(cargo.lies)).GetFrame().Inverse();
  ride.displaces = true;
  return ride;
}

bool IsCarried(const LookAhead& ahead, const Stretch& stretch) noexcept {
  if (stretch.joints) return false;
  const auto displaces = [&](std::uint64_t ride) { return RideAt(ahead, ride).displaces; };
  return displaces(stretch.to_ride) || displaces(stretch.from_ride);
}

KinematicState ShareAt(const LookAhead& ahead, const Stretch& stretch, double way) noexcept {
  if (stretch.from_ride == stretch.to_ride) return {1, 0, 0};
  const CarrierBinding& ride = RideAt(ahead, stretch.to_ride);
  const double length = ride.end - ride.begin;
  const double place = stretch.begin + way - stretch.from;
  const double rounding = kOfPlace * std::max(kLeastRounded, place);
  if (place > ride.end - rounding) return {1, 0, 0};
  if (place < ride.begin + rounding) return {0, 0, 0};
  const double x = std::clamp((place - ride.begin) / length, 0.0, 1.0);
  // Computed from the nearer end: so it is monotonic near 1, too.
  const double y = std::min(x, 1 - x);
  const double share = y * y * y * (10 + y * (6 * y - 15));
  return {x < 0.5 ? share : 1 - share, 30 * x * x * (1 - x) * (1 - x) / length,
          60 * x * (1 - x) * (1 - 2 * x) / (length * length)};
}

MovingFrame ToolNow(const Context& c, const State& s, const Stretch& stretch, const KinematicState& way) noexcept {
  return ToolOn(c.ahead, stretch, way, [&](std::uint64_t number) {
    const CarrierBinding& ride = RideAt(c.ahead, number);
    return Displaced(ride, Clutched(s, number, CarrierOf(c, ride.cargo)));
  });
}

MovingFrame PredictedTool(const Context& c, const Stretch& stretch, const KinematicState& way, bool still) noexcept {
  const double length = stretch.to - stretch.from;
  const double x = length > 0 ? std::clamp((way.position - stretch.from) / length, 0.0, 1.0) : 1;
  const double then = std::lerp(stretch.eta_begin, stretch.eta_end, x) - Now(c);
  return ToolOn(c.ahead, stretch, way, [&](std::uint64_t number) {
    const MovingFrame displacement = DisplacementOf(c, RideAt(c.ahead, number), std::max(then, 1e-9));
    return still ? Still(displacement) : displacement;
  });
}

MovingFrame ToolIn(const Context& c, const Stretch& stretch, const KinematicState& way, double ahead_s) noexcept {
  const double place = stretch.begin + way.position - stretch.from;
  return ToolOn(c.ahead, stretch, way, [&](std::uint64_t number) {
    const CarrierBinding& ride = RideAt(c.ahead, number);
    const double time_s = std::max(ahead_s, 1e-9);
    kinematics::Carrier carrier = CarrierOf(c, ride.cargo, time_s);
    // From `reach` on the tool is in sync: after a stop the path waits for that.
    const KinematicState apart = place < ride.boarding.reach ? ApartIn(c, ride, time_s) : KinematicState{};
    carrier.travel = {carrier.travel.position + apart.position, carrier.travel.velocity + apart.velocity,
                      carrier.travel.acceleration + apart.acceleration};
    return Displaced(ride, carrier);
  });
}

MovingFrame ToolSeen(const Context& c, const Stretch& stretch, const KinematicState& way, SeeCarrier see,
                     const void* owner) noexcept {
  return ToolOn(c.ahead, stretch, way, [&](std::uint64_t number) {
    const CarrierBinding& ride = RideAt(c.ahead, number);
    return Displaced(ride, see(owner, number, CarrierOf(c, ride.cargo)));
  });
}

double Now(const Context& c) noexcept {
  return static_cast<double>(c.cycle.count) * c.cycle.period_s;
}

double TimeFor(const Context& c, double length, const trajectory::AlongPath& limits) noexcept {
  if (!(length > 0)) return 0;
  trajectory::Profile profile{};
  for (std::size_t i = 0; i < c.axes.states.size(); ++i) {
    trajectory::Planner& planner = c.axes.Of(i).planner;
    const trajectory::Limits ramp = {limits.velocity, limits.acceleration, limits.deceleration, limits.jerk};
    return planner.ToPosition({}, length, 0, ramp, profile).failed() ? 0 : profile.duration();
  }
  return 0;
}

}  // namespace takt::group
