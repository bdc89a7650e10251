#include "takt/kinematics/carrier.h"

#include "takt/core/describe.h"
#include "takt/kinematics/rotations.h"

namespace takt::kinematics {

namespace {

MovingFrame Travelled(CarrierKind kind, const KinematicState& travel) {
  MovingFrame moved = MovingFrame::Identity();
  if (kind == CarrierKind::kStraight) {
    moved.p = KDL::VectorAcc(KDL::Vector(travel.position, 0, 0), KDL::Vector(travel.velocity, 0, 0),
                             KDL::Vector(travel.acceleration, 0, 0));
  } else if (kind == CarrierKind::kTurning) {
    moved.M = KDL::RotationAcc(AboutZ(travel.position), KDL::Vector(0, 0, travel.velocity),
                               KDL::Vector(0, 0, travel.acceleration));
  }
  return moved;
}

}  // namespace

MovingFrame PoseOn(const Carrier& carrier, double from, const Frame& on) noexcept {
  if (carrier.kind == CarrierKind::kFree) return carrier.pose * on;
  KinematicState travel = carrier.travel;
  travel.position -= from;
  return carrier.origin * Travelled(carrier.kind, travel) * on;
}

Carrier Ahead(const Carrier& carrier, double time_s) noexcept {
  Carrier later = carrier;
  later.travel.acceleration = 0;
  later.travel.position += carrier.travel.velocity * time_s;
  if (carrier.kind == CarrierKind::kFree) {
    MovingFrame& pose = later.pose;
    pose.p.p += time_s * pose.p.v;
    pose.p.dv = pose.M.dw = KDL::Vector::Zero();
    const double rate = pose.M.w.Norm();
    if (rate > 0) pose.M.R = About(pose.M.w / rate, rate * time_s) * pose.M.R;
  }
  return later;
}

void describe(Enumeration<CarrierKind>& e) {
  e.about("Kind of carrier.");
  e.value(CarrierKind::kNone, "none", "No carrier: at rest.");
  e.value(CarrierKind::kStraight, "straight", "A belt, along X of its origin.");
  e.value(CarrierKind::kTurning, "turning", "A table, about Z of its origin.");
  e.value(CarrierKind::kFree, "free", "A pose from another source.");
}

}  // namespace takt::kinematics
