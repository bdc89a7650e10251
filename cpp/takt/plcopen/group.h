// Blocks for groups of axes (PLCopen Part 4).
#pragma once

#include <array>
#include <optional>

#include "takt/group/commands.h"
#include "takt/group/outputs.h"
#include "takt/plcopen/administration.h"
#include "takt/plcopen/block.h"
#include "takt/plcopen/reading.h"

namespace takt::plcopen {

class GroupBlock : public BlockOf<GroupRef> {
 public:
  using BlockOf::BlockOf;
  GroupRef AxesGroup() const noexcept { return subject(); }
};

// The block of a group command. Axes and paths are given by name: add.axis = Name::Of("x").
template <typename C>
class BlockOfGroup : public CommandBlock<GroupBlock, group::Command, C> {
 public:
  using CommandBlock<GroupBlock, group::Command, C>::CommandBlock;
};

using MC_AddAxisToGroup = BlockOfGroup<group::AddAxis>;
using MC_RemoveAxisFromGroup = BlockOfGroup<group::RemoveAxis>;
using MC_UngroupAllAxes = BlockOfGroup<group::UngroupAllAxes>;
using MC_GroupEnable = BlockOfGroup<group::Enable>;
using MC_GroupDisable = BlockOfGroup<group::Disable>;
using MC_GroupReset = BlockOfGroup<group::Reset>;
using GT_GroupPower = BlockOfGroup<group::Power>;
using MC_GroupHome = BlockOfGroup<group::Home>;
using MC_GroupSetPosition = BlockOfGroup<group::SetPosition>;
using MC_GroupSetOverride = OverrideBlock<GroupRef, group::Command, group::SetOverride>;
using MC_SetKinTransform = BlockOfGroup<group::SetKinTransform>;
using MC_SetCartesianTransform = BlockOfGroup<group::SetCartesianTransform>;
using MC_SetCoordinateTransform = BlockOfGroup<group::SetCoordinateTransform>;

// `carrier` is the MasterAxesGroup, or whatever else the coordinate system moves with.
using MC_SetDynCoordTransform = BlockOfGroup<group::SetDynCoordTransform>;

using MC_GroupHalt = BlockOfGroup<group::Halt>;
using MC_GroupInterrupt = BlockOfGroup<group::Interrupt>;
using MC_GroupContinue = BlockOfGroup<group::Continue>;
using MC_MoveLinearAbsolute = BlockOfGroup<group::MoveLinearAbsolute>;
using MC_MoveLinearRelative = BlockOfGroup<group::MoveLinearRelative>;
using MC_MoveCircularAbsolute = BlockOfGroup<group::MoveCircularAbsolute>;
using MC_MoveCircularRelative = BlockOfGroup<group::MoveCircularRelative>;
using MC_MoveDirectAbsolute = BlockOfGroup<group::MoveDirectAbsolute>;
using MC_MoveDirectRelative = BlockOfGroup<group::MoveDirectRelative>;
// Moves along the path that MC_PathSelect names; here the name is an input.
using MC_MovePath = BlockOfGroup<group::MovePath>;

// Brakes to standstill on the path. The group stays in GroupStopping while Execute is true.
class MC_GroupStop : public BlockOfGroup<group::Stop> {
 public:
  using BlockOfGroup::BlockOfGroup;
  void operator()() noexcept;
};

class MC_SyncAxisToGroup : public BlockOfGroup<group::SyncAxis> {
 public:
  using BlockOfGroup::BlockOfGroup;
  void operator()() noexcept;
  // The set point of the slave is in step with the path.
  bool InSync() const noexcept;

 private:
  std::uint32_t slave_ = axis::kNoAxis;  // index, among the axes, of the slave of the last command
};

class MC_MovePathSynchronized : public BlockOfGroup<group::MovePathSynchronized> {
 public:
  using BlockOfGroup::BlockOfGroup;
  // The path is in step with the master.
  bool InSync() const noexcept { return Active() && AxesGroup().outputs().synchronized; }
};

// The tool follows an object, from the first position where it may to the last one; moves in the object's coordinate
// system are superimposed. Done when the object has left.
template <typename C>
class TrackingBlock : public BlockOfGroup<C> {
 public:
  using BlockOfGroup<C>::BlockOfGroup;
  // The tool is in step with the object; it has the velocity of the object only if no move is superimposed.
  bool InSync() const noexcept {
    return this->EverReached() && this->AxesGroup().outputs().track_state == group::TrackState::kInSync;
  }
};
using MC_TrackConveyorBelt = TrackingBlock<group::TrackConveyorBelt>;
using MC_TrackRotaryTable = TrackingBlock<group::TrackRotaryTable>;

class GroupReadBlock : public ReadBlockOf<GroupRef, group::Outputs> {
 public:
  using ReadBlockOf::ReadBlockOf;

 protected:
  bool Is(group::GroupState state) const noexcept { return Valid() && shown().state == state; }
};

class MC_GroupReadStatus : public GroupReadBlock {
 public:
  using GroupReadBlock::GroupReadBlock;
  bool GroupMoving() const noexcept { return Is(group::GroupState::kMoving); }
  bool GroupHoming() const noexcept { return Is(group::GroupState::kHoming); }
  bool GroupErrorStop() const noexcept { return Is(group::GroupState::kErrorStop); }
  bool GroupDisabled() const noexcept { return Is(group::GroupState::kDisabled); }
  bool GroupStopping() const noexcept { return Is(group::GroupState::kStopping); }
  bool GroupStandby() const noexcept { return Is(group::GroupState::kStandby); }
  bool ConstantVelocity() const noexcept { return shown().path_velocity > 0 && shown().path_acceleration == 0; }
  bool Accelerating() const noexcept { return shown().path_acceleration > 0; }
  bool Decelerating() const noexcept { return shown().path_acceleration < 0; }
  bool InPosition() const noexcept { return shown().in_position; }
  // The tool follows a moving object, or gets into or out of step with it; or its path follows a master.
  bool SynchronizedMotion() const noexcept { return GroupMoving() && (Rides() || shown().synchronized); }
  // A move is in control, possibly on top of a moving object; or the tool comes to rest.
  bool DiscreteMotion() const noexcept { return GroupMoving() && (shown().command != 0 || !Rides()); }

 private:
  bool Rides() const noexcept { return shown().track_state >= group::TrackState::kSynchronizing; }
};

// The reason for GroupErrorStop. The block itself has no error; Error and ErrorID also give that of the group.
class MC_GroupReadError : public GroupReadBlock {
 public:
  using GroupReadBlock::GroupReadBlock;
  bool Error() const noexcept { return GroupErrorID() != ErrorId::kNone; }
  ErrorId ErrorID() const noexcept { return GroupErrorID(); }
  ErrorId GroupErrorID() const noexcept { return shown().error; }
};

// The actual pose of the tool in the machine coordinate system: X, Y, Z [mm], A, B, C [degrees]. NaN without
// kinematics.
class MC_GroupReadActualPosition : public GroupReadBlock {
 public:
  using GroupReadBlock::GroupReadBlock;
  std::array<double, 6> Position() const noexcept;
};

class MC_GroupReadActualVelocity : public GroupReadBlock {
 public:
  using GroupReadBlock::GroupReadBlock;
  double PathVelocity() const noexcept { return shown().actual_velocity; }  // [mm/s]
};

// As commanded: it is not measured.
class MC_GroupReadActualAcceleration : public GroupReadBlock {
 public:
  using GroupReadBlock::GroupReadBlock;
  double PathAcceleration() const noexcept { return shown().acceleration; }  // [mm/s²]
};

class MC_ReadKinTransform : public GroupReadBlock {
 public:
  using GroupReadBlock::GroupReadBlock;
  // The group has kinematics, and they are switched on.
  bool KinTransform() const noexcept { return shown().kinematics_on; }
};

// The present pose of product coordinate system Pcs, from 1, in another one: MCS, WCS, or PCS number ReferencePcs.
// [mm], and [degrees] about X, Y, Z.
class MC_ReadCoordinateTransform : public GroupReadBlock {
 public:
  using GroupReadBlock::GroupReadBlock;
  std::uint32_t Pcs = 1;
  group::CoordinateSystem Reference = group::CoordinateSystem::kMcs;
  std::uint32_t ReferencePcs = 1;
  void operator()() noexcept;
  bool Valid() const noexcept { return GroupReadBlock::Valid() && found_; }
  bool Error() const noexcept { return GroupReadBlock::Valid() && !found_; }
  ErrorId ErrorID() const noexcept { return Error() ? ErrorId::kParameter : ErrorId::kNone; }
  kinematics::Pose CoordTransform() const noexcept { return found_.value_or(kinematics::Pose{}); }

 private:
  std::optional<kinematics::Pose> found_;
};

// The same transform as six numbers.
class MC_ReadCartesianTransform : public MC_ReadCoordinateTransform {
 public:
  using MC_ReadCoordinateTransform::MC_ReadCoordinateTransform;
  double TransX() const noexcept { return CoordTransform().x; }
  double TransY() const noexcept { return CoordTransform().y; }
  double TransZ() const noexcept { return CoordTransform().z; }
  double RotAngle1() const noexcept { return CoordTransform().a; }
  double RotAngle2() const noexcept { return CoordTransform().b; }
  double RotAngle3() const noexcept { return CoordTransform().c; }
};

// The axis of the machine with index IdentInGroup in the group, both from 1; 0: none.
class MC_GroupReadConfiguration : public GroupReadBlock {
 public:
  using GroupReadBlock::GroupReadBlock;
  std::uint32_t IdentInGroup = 1;
  std::uint32_t Axis() const noexcept;
};

}  // namespace takt::plcopen
