// Blocks that do more than give a command: a stop that holds, a jog by keys, a touch that slows down; and blocks of
// commands that never end, with the standard's output for having reached their goal.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "takt/plcopen/block.h"

namespace takt::plcopen {

// Brakes to standstill. The axis stays in Stopping and accepts no other motion while Execute is true, also through
// power off, faults and emergency stops. All stops of an axis are done when it is at rest, whichever of them brakes.
class MC_Stop : public Block<axis::Stop> {
 public:
  using Block::Block;
  void operator()() noexcept;
};

// Moves while JogPos or JogNeg is held and Enable is true. The direction pressed first wins; both must be released
// before the next jog, so a key that is held when Enable becomes true has no effect. Velocities and ramps are read when
// a key is pressed or released; a jog that cannot continue with them ends.
class GT_Jog : private axis::Jog {
 public:
  using axis::Jog::acceleration;
  using axis::Jog::deceleration;
  using axis::Jog::jerk;
  using axis::Jog::velocity;
  bool Enable = false;
  bool JogPos = false;
  bool JogNeg = false;

  explicit GT_Jog(AxisRef axis) : axis_(axis), feedbacks_{{Feedback(axis.program()), Feedback(axis.program())}} {}
  void operator()() noexcept;

  bool Error() const noexcept { return error_ != ErrorId::kNone; }
  ErrorId ErrorID() const noexcept { return error_; }

 private:
  void Press() noexcept;
  Feedback& current() noexcept { return feedbacks_[current_]; }
  Feedback& before() noexcept { return feedbacks_[1 - current_]; }

  AxisRef axis_;
  std::array<Feedback, 2> feedbacks_;  // of the jog in progress, and of the previous one until the new one is accepted
  std::size_t current_ = 0;
  bool up_ = true;    // both keys were up, whatever Enable is
  bool seen_ = true;  // the error of the jog in progress, if any, was shown
  ErrorId error_ = ErrorId::kNone;
};
using MC_Jog = GT_Jog;

// Moves an axis at rest by one increment at each rising edge of Execute.
class MC_Inch : public Block<axis::Inch> {
 public:
  using Block::Block;
  bool Active() const noexcept { return Busy(); }
};

// Returns true if the set point of an axis whose command has reached `velocity` [u/s] has this velocity now, scaled by
// the override in force and limited to the axis' velocity. With a superimposed motion, whose sum is published: returns
// true unless the axis is held.
bool HasVelocity(AxisRef axis, double velocity) noexcept;

class MC_MoveVelocity : public UpdatedBlock<axis::MoveVelocity> {
 public:
  using UpdatedBlock::UpdatedBlock;
  bool InVelocity() const noexcept { return Reached() && HasVelocity(axis(), given().velocity); }
};

class MC_MoveSuperimposed : public UpdatedBlock<axis::MoveSuperimposed> {
 public:
  using UpdatedBlock::UpdatedBlock;
  // Returns the distance [u] added so far, or at the end.
  double CoveredDistance() const noexcept { return Active() ? axis().outputs().covered_distance : ValueAtEnd(); }
};

// AbsolutePhaseShift, CoveredPhaseShift: the shift [master's u] added so far, or at the end.
class MC_PhasingAbsolute : public Block<axis::PhasingAbsolute> {
 public:
  using Block::Block;
  double AbsolutePhaseShift() const noexcept { return Active() ? axis().outputs().covered_phase_shift : ValueAtEnd(); }
};

class MC_PhasingRelative : public Block<axis::PhasingRelative> {
 public:
  using Block::Block;
  double CoveredPhaseShift() const noexcept { return Active() ? axis().outputs().covered_phase_shift : ValueAtEnd(); }
};

class MC_MoveContinuousAbsolute : public UpdatedBlock<axis::MoveContinuousAbsolute> {
 public:
  using UpdatedBlock::UpdatedBlock;
  bool InEndVelocity() const noexcept { return Reached() && HasVelocity(axis(), given().end_velocity); }
};

class MC_MoveContinuousRelative : public UpdatedBlock<axis::MoveContinuousRelative> {
 public:
  using UpdatedBlock::UpdatedBlock;
  bool InEndVelocity() const noexcept { return Reached() && HasVelocity(axis(), given().end_velocity); }
};

class MC_TorqueControl : public UpdatedBlock<axis::TorqueControl> {
 public:
  using UpdatedBlock::UpdatedBlock;
  bool InTorque() const noexcept { return Reached(); }
};

// Couplings. The axis of the block is the slave; its masters are given by name: gear.master = Name::Of("x"). In step
// while it follows exactly.
template <typename C, typename Base = UpdatedBlock<C>>
class CouplingBlock : public Base {
 public:
  using Base::Base;

 protected:
  bool InStep() const noexcept { return this->EverReached() && this->axis().outputs().in_step; }
};

class MC_GearIn : public CouplingBlock<axis::GearIn> {
 public:
  using CouplingBlock::CouplingBlock;
  bool InGear() const noexcept { return InStep(); }
};

class MC_GearInPos : public CouplingBlock<axis::GearInPos, Block<axis::GearInPos>> {
 public:
  using CouplingBlock::CouplingBlock;
  // Synchronisation has begun.
  bool StartSync() const noexcept { return Active() && !EverReached() && axis().outputs().synchronizing; }
  bool InSync() const noexcept { return InStep(); }
};

// cam.master and cam.cam are the names of an axis and of a cam of the machine.
class MC_CamIn : public CouplingBlock<axis::CamIn> {
 public:
  using CouplingBlock::CouplingBlock;
  void operator()() noexcept;
  bool InSync() const noexcept { return InStep(); }
  // An end of the cam was passed since the previous call, while this command was in control; also in the call in which
  // the next command has taken over.
  bool EndOfProfile() const noexcept { return end_of_profile_; }

 private:
  std::optional<std::uint32_t> ends_;  // profile_ends in the previous call; unset: the command was not in control
  bool level_ = false;                 // Execute in the previous call
  bool end_of_profile_ = false;
};

class MC_CombineAxes : public CouplingBlock<axis::CombineAxes> {
 public:
  using CouplingBlock::CouplingBlock;
  bool InSync() const noexcept { return InStep(); }
};

class MC_TouchProbe : public Block<axis::TouchProbe> {
 public:
  using Block::Block;
  double RecordedPosition() const noexcept { return Value(); }
};

// Waits for the touch probe, then ends the motion in progress, stops and returns to the position of the touch. In mode
// kSlow it instead slows down any motion while the probe is on, as long as Execute is true.
class GT_Touch : public Block<axis::Touch> {
 public:
  explicit GT_Touch(AxisRef axis) : Block(axis) {}
  void operator()() noexcept;
  double RecordedPosition() const noexcept { return Value(); }

 private:
  bool slows_ = false;  // mode of the last command was kSlow
};

}  // namespace takt::plcopen
