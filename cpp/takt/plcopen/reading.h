// Blocks that show values while Enable is true.
#pragma once

#include <array>
#include <cstddef>

#include "takt/plcopen/feedback.h"

namespace takt::plcopen {

// A block that shows the values published in the cycle before the call; default values while not Valid.
template <typename Ref, typename Outputs>
class ReadBlockOf {
 public:
  bool Enable = false;

  explicit ReadBlockOf(Ref subject) : subject_(subject) {}
  void operator()() noexcept {
    valid_ = Enable;
    shown_ = Enable ? subject_.outputs() : Outputs{};
  }

  bool Valid() const noexcept { return valid_; }
  bool Busy() const noexcept { return valid_; }
  bool Error() const noexcept { return false; }
  ErrorId ErrorID() const noexcept { return ErrorId::kNone; }

 protected:
  const Outputs& shown() const noexcept { return shown_; }
  Ref subject() const noexcept { return subject_; }

 private:
  Ref subject_;
  Outputs shown_;
  bool valid_ = false;
};

class ReadBlock : public ReadBlockOf<AxisRef, axis::Outputs> {
 public:
  using ReadBlockOf::ReadBlockOf;

 protected:
  bool Is(axis::PlcState state) const noexcept { return Valid() && shown().state == state; }
};

class MC_ReadStatus : public ReadBlock {
 public:
  using ReadBlock::ReadBlock;
  bool ErrorStop() const noexcept { return Is(axis::PlcState::kErrorStop); }
  bool Disabled() const noexcept { return Is(axis::PlcState::kDisabled); }
  bool Stopping() const noexcept { return Is(axis::PlcState::kStopping); }
  bool Homing() const noexcept { return Is(axis::PlcState::kHoming); }
  bool Standstill() const noexcept { return Is(axis::PlcState::kStandstill); }
  bool DiscreteMotion() const noexcept { return Is(axis::PlcState::kDiscreteMotion); }
  bool ContinuousMotion() const noexcept { return Is(axis::PlcState::kContinuousMotion); }
  bool SynchronizedMotion() const noexcept { return Is(axis::PlcState::kSynchronizedMotion); }
  bool Ref() const noexcept { return shown().homed; }
};

// The fault of the axis. The block itself has no error; Error and ErrorID also give that of the axis.
class MC_ReadAxisError : public ReadBlock {
 public:
  using ReadBlock::ReadBlock;
  bool Error() const noexcept { return AxisErrorID() != ErrorId::kNone; }
  ErrorId ErrorID() const noexcept { return AxisErrorID(); }
  ErrorId AxisErrorID() const noexcept { return shown().error; }
};

// InputNumber: 1 LIM+, 2 LIM-, 3 REF, 4 TP.
class MC_ReadDigitalInput : public ReadBlock {
 public:
  using ReadBlock::ReadBlock;
  int InputNumber = 1;
  bool Valid() const noexcept { return ReadBlock::Valid() && !Error(); }
  bool Busy() const noexcept { return Valid(); }
  bool Error() const noexcept { return Enable && (InputNumber < 1 || InputNumber > 4); }
  ErrorId ErrorID() const noexcept { return Error() ? ErrorId::kParameter : ErrorId::kNone; }
  bool Value() const noexcept {
    const axis::Outputs& o = shown();
    const std::array inputs{o.limit_positive, o.limit_negative, o.reference, o.touch_probe};
    return Valid() && inputs[static_cast<std::size_t>(InputNumber - 1)];
  }
};

// OutputNumber: 1 to 32, outputs of MC_WriteDigitalOutput and MC_DigitalCamSwitch.
class MC_ReadDigitalOutput : public ReadBlock {
 public:
  using ReadBlock::ReadBlock;
  int OutputNumber = 1;
  bool Valid() const noexcept { return ReadBlock::Valid() && !Error(); }
  bool Busy() const noexcept { return Valid(); }
  bool Error() const noexcept { return Enable && (OutputNumber < 1 || OutputNumber > 32); }
  ErrorId ErrorID() const noexcept { return Error() ? ErrorId::kParameter : ErrorId::kNone; }
  bool Value() const noexcept { return Valid() && (shown().digital_outputs >> (OutputNumber - 1) & 1U) != 0; }
};

class MC_ReadActualPosition : public ReadBlock {
 public:
  using ReadBlock::ReadBlock;
  double Position() const noexcept { return shown().actual_position; }  // [u]
};

class MC_ReadActualVelocity : public ReadBlock {
 public:
  using ReadBlock::ReadBlock;
  double Velocity() const noexcept { return shown().actual_velocity; }  // [u/s]
};

class MC_ReadActualTorque : public ReadBlock {
 public:
  using ReadBlock::ReadBlock;
  double Torque() const noexcept { return shown().torque_nm; }  // [Nm]; [N] on linear motors
};

// How the set point of the axis moves.
class MC_ReadMotionState : public ReadBlock {
 public:
  using ReadBlock::ReadBlock;
  bool ConstantVelocity() const noexcept { return Valid() && shown().set_acceleration == 0; }
  bool Accelerating() const noexcept { return Growth() > 0; }
  bool Decelerating() const noexcept { return Growth() < 0; }
  bool DirectionPositive() const noexcept { return shown().set_velocity > 0; }
  bool DirectionNegative() const noexcept { return shown().set_velocity < 0; }

 private:
  double Growth() const noexcept {
    const double towards = shown().set_velocity != 0 ? shown().set_velocity : shown().set_acceleration;
    return shown().set_acceleration * towards;
  }
};

// The inputs of the axis and its readiness, including GT_SInfo's LIMpos, LIMneg, REF and TP.
class MC_ReadAxisInfo : public ReadBlock {
 public:
  using ReadBlock::ReadBlock;
  bool HomeAbsSwitch() const noexcept { return shown().reference; }
  bool LimitSwitchPos() const noexcept { return shown().limit_positive; }
  bool LimitSwitchNeg() const noexcept { return shown().limit_negative; }
  bool TouchProbe() const noexcept { return shown().touch_probe; }
  bool ReadyForPowerOn() const noexcept { return Valid() && shown().error == ErrorId::kNone; }
  bool PowerOn() const noexcept { return shown().loop_closed; }
  bool IsHomed() const noexcept { return shown().homed; }
  bool AxisWarning() const noexcept { return shown().limited_by != LimitedBy::kNothing; }
};

// The signals of the position loop: set points and actual values.
class GT_Show : public ReadBlock {
 public:
  using ReadBlock::ReadBlock;
  double ModelPosition() const noexcept { return shown().set_position; }  // [u]
  double Position() const noexcept { return shown().actual_position; }    // [u]
  double Deviation() const noexcept { return shown().following_error; }   // [u]
  double ModelVelocity() const noexcept { return shown().set_velocity; }  // [u/s]
  double Velocity() const noexcept { return shown().actual_velocity; }    // [u/s]
  double Voltage() const noexcept { return shown().voltage_v; }           // [V]
  double Torque() const noexcept { return shown().torque_nm; }            // [Nm]; [N] on linear motors
};

// Reads a parameter by PLCopen's number repeatedly while Enable is true. Value is valid from the first answer on, one
// or more cycles after Enable.
class MC_ReadParameter {
 public:
  bool Enable = false;
  std::int32_t ParameterNumber = 0;

  explicit MC_ReadParameter(AxisRef axis) : axis_(axis), feedback_(axis.program()) {}
  void operator()() noexcept;

  bool Valid() const noexcept { return answer_ == FeedbackState::kDone; }
  bool Busy() const noexcept { return Enable; }
  bool Error() const noexcept { return error_ != ErrorId::kNone; }
  ErrorId ErrorID() const noexcept { return error_; }
  double Value() const noexcept { return Valid() ? value_ : 0; }

 private:
  AxisRef axis_;
  Feedback feedback_;
  FeedbackState answer_ = FeedbackState::kBusy;  // the last one since Enable
  ErrorId error_ = ErrorId::kNone;
  double value_ = 0;
};

// Reads a Boolean parameter.
class MC_ReadBoolParameter : public MC_ReadParameter {
 public:
  using MC_ReadParameter::MC_ReadParameter;
  bool Value() const noexcept { return MC_ReadParameter::Value() != 0; }
};

}  // namespace takt::plcopen
