// Blocks of motions that are more than their command: a stop that holds, a jog by keys, a touch that slows down; and
// those of commands that never end, with the standard's name for having reached what they are for.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "takt/plcopen/block.h"

namespace takt::plcopen {

// Brakes to standstill. The axis stays in Stopping, and takes no other motion, as long as Execute is true, through
// power off, faults and emergency stops, too. All stops of an axis are done when it stands, whichever of them brakes.
class MC_Stop : public Block<axis::Stop> {
 public:
  using Block::Block;
  void operator()() noexcept;
};

// Moves as long as JogPos or JogNeg is held, while Enable is true. The direction pressed first wins; both must be let
// go before the next jog, so a key that is held while Enable becomes true does nothing. Velocities and ramps count when
// a key is pressed or let go; a jog that cannot go on with them ends.
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
  std::array<Feedback, 2> feedbacks_;  // of the jog in progress, and of the one before until that is accepted
  std::size_t current_ = 0;
  bool up_ = true;    // both keys were, Enable or not
  bool seen_ = true;  // the error of the one in progress, if any
  ErrorId error_ = ErrorId::kNone;
};
using MC_Jog = GT_Jog;

// Moves a standing axis by one increment on each rising edge of Execute.
class MC_Inch : public Block<axis::Inch> {
 public:
  using Block::Block;
  bool Active() const noexcept { return Busy(); }
};

// Whether the set point of an axis whose command has reached `velocity` [u/s] has it now, as the override in force
// scales it, up to the largest velocity of the axis. What is on top of the motion is published together with it: then
// the axis only must not be held.
bool HasVelocity(AxisRef axis, double velocity) noexcept;

class MC_MoveVelocity : public UpdatedBlock<axis::MoveVelocity> {
 public:
  using UpdatedBlock::UpdatedBlock;
  bool InVelocity() const noexcept { return Reached() && HasVelocity(axis(), given().velocity); }
};

class MC_MoveSuperimposed : public UpdatedBlock<axis::MoveSuperimposed> {
 public:
  using UpdatedBlock::UpdatedBlock;
  // How much of it was added so far, or at last.
  double CoveredDistance() const noexcept { return Active() ? axis().outputs().covered_distance : ValueAtEnd(); }
};

// How much of the shift was added so far, or at last.
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

// Couplings. The axis of the block is the slave; its masters go by their names: gear.master = Name::Of("x"). In step as
// long as it follows exactly.
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
  // Getting into step has begun.
  bool StartSync() const noexcept { return Active() && !EverReached() && axis().outputs().synchronizing; }
  bool InSync() const noexcept { return InStep(); }
};

// cam.master and cam.cam are names, of an axis and of a cam of the machine.
class MC_CamIn : public CouplingBlock<axis::CamIn> {
 public:
  using CouplingBlock::CouplingBlock;
  void operator()() noexcept;
  bool InSync() const noexcept { return InStep(); }
  // The end of the cam was passed since the call before, while this command was in control; also in the call in which
  // the next command has taken over.
  bool EndOfProfile() const noexcept { return end_of_profile_; }

 private:
  std::optional<std::uint32_t> ends_;  // profile_ends in the last call; unset: the command was not in control then
  bool level_ = false;                 // Execute in the last call
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

// Waits for the touch probe, then ends the motion in progress, stops and goes to where the probe was touched. With mode
// kSlow it slows down whatever moves while the probe is on instead, no longer than Execute is true.
class GT_Touch : public Block<axis::Touch> {
 public:
  explicit GT_Touch(AxisRef axis) : Block(axis) {}
  void operator()() noexcept;
  double RecordedPosition() const noexcept { return Value(); }

 private:
  bool slows_ = false;  // the command given
};

}  // namespace takt::plcopen
