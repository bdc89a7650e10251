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

// Of a command of groups. Axes and paths go by their names: add.axis = Name::Of("x").
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

// `carrier` is the MasterAxesGroup, or what else the coordinate system goes along with.
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
// With the path that MC_PathSelect names; here the name is its input.
using MC_MovePath = BlockOfGroup<group::MovePath>;

// Brakes to standstill on the path. The group stays in GroupStopping as long as Execute is true.
class MC_GroupStop : public BlockOfGroup<group::Stop> {
 public:
  using BlockOfGroup::BlockOfGroup;
  void operator()() noexcept;
};

class MC_SyncAxisToGroup : public BlockOfGroup<group::SyncAxis> {
 public:
  using BlockOfGroup::BlockOfGroup;
  void operator()() noexcept;
  // The set point of the slave is where the path has it.
  bool InSync() const noexcept;

 private:
  std::uint32_t slave_ = axis::kNoAxis;  // of the command given: its index among the axes
};

class MC_MovePathSynchronized : public BlockOfGroup<group::MovePathSynchronized> {
 public:
  using BlockOfGroup::BlockOfGroup;
  // The path is in step with the master.
  bool InSync() const noexcept { return Active() && AxesGroup().outputs().synchronized; }
};

// The tool goes along with an object, from the first place where it may to the last one; moves in the object's
// coordinate system run on top. Done when the object has left.
template <typename C>
class TrackingBlock : public BlockOfGroup<C> {
 public:
  using BlockOfGroup<C>::BlockOfGroup;
  // The tool is in step with the object; its speed is that of the object only where no move runs on top.
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
  // The tool goes along with what moves, gets into step with it or out of it; or its path follows a master.
  bool SynchronizedMotion() const noexcept { return GroupMoving() && (Rides() || shown().synchronized); }
  // A move is in control, also one on what moves; or the tool comes to rest.
  bool DiscreteMotion() const noexcept { return GroupMoving() && (shown().command != 0 || !Rides()); }

 private:
  bool Rides() const noexcept { return shown().track_state >= group::TrackState::kSynchronizing; }
};

// Why the group is in GroupErrorStop. The block itself has no error; Error and ErrorID say that of the group, too.
class MC_GroupReadError : public GroupReadBlock {
 public:
  using GroupReadBlock::GroupReadBlock;
  bool Error() const noexcept { return GroupErrorID() != ErrorId::kNone; }
  ErrorId ErrorID() const noexcept { return GroupErrorID(); }
  ErrorId GroupErrorID() const noexcept { return shown().error; }
};

// Where the tool is as measured, in the machine coordinate system: X, Y, Z in mm, A, B, C in degrees. NaN without
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

// As commanded: nothing measures it.
class MC_GroupReadActualAcceleration : public GroupReadBlock {
 public:
  using GroupReadBlock::GroupReadBlock;
  double PathAcceleration() const noexcept { return shown().acceleration; }  // [mm/s²]
};

class MC_ReadKinTransform : public GroupReadBlock {
 public:
  using GroupReadBlock::GroupReadBlock;
  // There are kinematics, and they are switched on.
  bool KinTransform() const noexcept { return shown().kinematics_on; }
};

// Where product coordinate system Pcs, from 1, is now in another one: MCS, WCS, or PCS number ReferencePcs. mm, and
// degrees about X, Y, Z.
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

// The same, number by number.
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

// Which axis of the machine is in the place IdentInGroup, from 1; 0: none.
class MC_GroupReadConfiguration : public GroupReadBlock {
 public:
  using GroupReadBlock::GroupReadBlock;
  std::uint32_t IdentInGroup = 1;
  std::uint32_t Axis() const noexcept;
};

}  // namespace takt::plcopen
