#include "takt/pickplace/profile.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "takt/core/describe.h"
#include "takt/core/maths.h"
#include "takt/path/make.h"

namespace takt::pickplace {

namespace {

using kinematics::Frame;

// Cosine above which a system counts as upright, and below the negative of which a leg reverses.
constexpr double kUpright = 1 - 1e-9;
constexpr double kBoards = 2;  // [mm] of a leg across on which the tool gets in step

Place Above(const Place& place, double distance) {
  Place above = place;
  above.pose.z += distance;
  above.parks = false;
  return above;
}

KDL::Vector In(const Frame& system, const Place& place) {
  return system * KDL::Vector(place.pose.x, place.pose.y, place.pose.z);
}

struct ProfileBuilder {
  const Systems& systems;
  Profile profile;
  KDL::Vector at;      // end of the last leg
  KDL::Vector before;  // start of the last leg
  double last = 0;     // [mm] length of the last leg

  // `system`: coordinate system of the leg's end.
  void Add(const Leg& leg, const Frame& system, double radius) {
    const KDL::Vector to = In(system, leg.to);
    const double length = (to - at).Norm();
    Leg& added = profile.legs[profile.count];
    added = leg;
    if (profile.count > 0 && last > path::kSame && length > path::kSame) {
      const double turn = dot(at - before, to - at) / (last * length);
      // An arch begins vertically, whatever its ends.
      if (leg.arch || turn > -kUpright) added.radius = std::min({radius, last / 2, length / 2});
    }
    ++profile.count;
    before = at;
    at = to;
    last = length;
  }
};

// Returns point 2, above the target. The tool gets in step on the leg to it, before it is low: if the tool is already
// at that point, the leg leads further up (PP-61).
Place PointOver(const Place& target, const Place& start, double distance, const ProfileBuilder& m) {
  const Place over = Above(target, distance);
  const bool boards =
      target.system == group::CoordinateSystem::kPcs && (start.system != target.system || start.pcs != target.pcs);
  const double length = (In(m.systems.target, over) - m.at).Norm();
  return boards && length < kBoards ? Above(over, kBoards + length) : over;
}

Profile Refused(ErrorId error) {
  Profile profile;
  profile.error = error;
  return profile;
}

// Adds the legs to or from a parking position.
Profile Parking(const Place& start, const Place& target, const Shape& shape, ProfileBuilder& m) {
  const double up = shape.height + (target.parks ? shape.start_distance : shape.target_distance);
  const double radius = shape.height + shape.radius;
  const bool both = start.parks && target.parks;
  if (both || up <= path::kSame) {
    m.Add({.to = target, .turns = true}, m.systems.target, 0);
  } else if (target.parks) {
    m.Add({.to = Above(start, up)}, m.systems.start, 0);
    m.Add({.to = target, .turns = true}, m.systems.target, radius);
  } else {
    m.Add({.to = Above(target, up), .turns = true}, m.systems.target, 0);
    m.Add({.to = target}, m.systems.target, radius);
  }
  return m.profile;
}

template <typename Move>
void Fill(const Leg& leg, const PathRamps& ramps, bool keep_orientation, std::size_t aux1, Move& m) {
  const Place& to = leg.to;
  m.coordinate_system = to.system;
  m.pcs = to.pcs;
  m.x = to.pose.x;
  m.y = to.pose.y;
  m.z = to.pose.z;
  if (leg.turns && !keep_orientation) {
    m.a = to.pose.a;
    m.b = to.pose.b;
    m.c = to.pose.c;
  }
  const std::array aux = {&m.a1, &m.a2, &m.a3, &m.a4, &m.a5, &m.a6, &m.a7, &m.a8};
  if (leg.turns && aux1 < aux.size()) *aux[aux1] = to.aux1;
  m.velocity = ramps.velocity;
  m.acceleration = ramps.acceleration;
  m.deceleration = ramps.deceleration;
  m.jerk = ramps.jerk;
  m.buffer_mode = group::BufferMode::kBuffered;
  if (leg.radius <= 0) return;
  m.buffer_mode = group::BufferMode::kBlendingNext;
  m.transition_mode = group::TransitionMode::kCornerDistance;
  m.transition_parameter = leg.radius;
}

}  // namespace

bool IsUpright(const Frame& system) noexcept {
  return system.M.UnitZ().z() > kUpright;
}

Profile MakeProfile(const Place& start, const Place& target, const Shape& shape, const Systems& systems) noexcept {
  using group::CoordinateSystem;
  if (start.system == CoordinateSystem::kAcs || target.system == CoordinateSystem::kAcs) {
    return Refused(ErrorId::kParameter);
  }
  ProfileBuilder m{systems, {}, In(systems.start, start), {}, 0};
  if (start.parks || target.parks) return Parking(start, target, shape, m);
  const bool arch = shape.mode == PathMode::kElliptical;
  if (arch && !(IsUpright(systems.base * systems.start) && IsUpright(systems.base * systems.target))) {
    return Refused(ErrorId::kTiltedEllipse);
  }
  if (shape.start_distance > path::kSame) m.Add({.to = Above(start, shape.start_distance)}, systems.start, 0);
  const bool lowers = shape.target_distance > path::kSame;
  m.Add({.to = lowers ? PointOver(target, start, shape.target_distance, m) : target,
         .arch = arch,
         .turns = true,
         .height = arch ? shape.height : 0},
        systems.target, shape.radius);
  if (lowers) m.Add({.to = target}, systems.target, shape.radius);
  return m.profile;
}

double TimeFor(double length, const PathRamps& ramps) noexcept {
  const double v = ramps.velocity;
  const double a = std::min(ramps.acceleration, ramps.deceleration);
  const double j = ramps.jerk;
  // Accelerations build up within a / j, speeds within v / a.
  if (length >= v * v / a + v * a / j) return length / v + v / a + a / j;
  if (length >= 2 * a * a * a / (j * j)) return a / j + std::sqrt(a * a / (j * j) + 4 * length / a);
  return 4 * maths::Cbrt(length / (2 * j));
}

double TimeAlong(const Profile& profile, const Place& start, const PathRamps& ramps, const Systems& systems) noexcept {
  KDL::Vector at = In(systems.start, start);
  double time_s = 0;
  for (std::uint32_t i = 0; i < profile.count; ++i) {
    const Leg& leg = profile.legs[i];
    const bool lifts = i == 0 && !leg.turns;
    const KDL::Vector to = In(lifts ? systems.start : systems.target, leg.to);
    // Half an ellipse is shorter than its half axes together.
    time_s += TimeFor((to - at).Norm() + 2 * leg.height, ramps);
    at = to;
  }
  return time_s;
}

group::MoveLinearAbsolute LineOf(const Leg& leg, const PathRamps& ramps, bool keep_orientation,
                                 std::size_t aux1) noexcept {
  group::MoveLinearAbsolute move;
  Fill(leg, ramps, keep_orientation, aux1, move);
  return move;
}

group::MoveArch ArchOf(const Leg& leg, const PathRamps& ramps, bool keep_orientation, std::size_t aux1) noexcept {
  group::MoveArch move;
  move.height = leg.height;
  Fill(leg, ramps, keep_orientation, aux1, move);
  return move;
}

void describe(Description<Place>& d) {
  d.about("A pose of the tool, with the position of Aux1.");
  d.internal<&Place::system>("Coordinate system.");
  d.internal<&Place::pcs>("Number of the product coordinate system.");
  d.internal<&Place::pose>("Pose in that system.");
  d.internal<&Place::aux1>(unit::u, "Position of the auxiliary axis.");
  d.internal<&Place::parks>("It is a parking position.");
}

void describe(Description<Shape>& d) {
  d.about("Parameters of a profile.");
  d.internal<&Shape::mode>("Shape between its points.");
  d.internal<&Shape::start_distance>(unit::mm, "Distance from the start to point 1.");
  d.internal<&Shape::target_distance>(unit::mm, "Distance from point 2 to the target.");
  d.internal<&Shape::height>(unit::mm, "Height of the ellipse.");
  d.internal<&Shape::radius>(unit::mm, "Radius of the rounding.");
  d.internal<&Shape::keep_orientation>("The tool is not turned.");
}

void describe(Description<Leg>& d) {
  d.about("One move of a profile.");
  d.internal<&Leg::to>("End of the move.");
  d.internal<&Leg::arch>("The move is half an ellipse.");
  d.internal<&Leg::turns>("Orientation and Aux1 change during the move.");
  d.internal<&Leg::height>(unit::mm, "Height of the ellipse.");
  d.internal<&Leg::radius>(unit::mm, "Radius of the rounding at its start.");
}

void describe(Description<Profile>& d) {
  d.about("The moves of a profile.");
  d.internal<&Profile::legs>("Moves in order.");
  d.internal<&Profile::count>("Number of moves.");
  d.internal<&Profile::error>("Reason why there are no moves.");
}

void describe(Description<PathRamps>& d) {
  d.about("Limits along a profile.");
  d.internal<&PathRamps::velocity>(unit::mm_s, "Largest speed.");
  d.internal<&PathRamps::acceleration>(unit::mm_s2, "Largest acceleration.");
  d.internal<&PathRamps::deceleration>(unit::mm_s2, "Largest deceleration.");
  d.internal<&PathRamps::jerk>(unit::mm_s3, "Largest jerk.");
}

}  // namespace takt::pickplace
