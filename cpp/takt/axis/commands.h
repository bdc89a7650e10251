// The commands of an axis: each a described struct, the same for YAML, Python, LCM and function blocks.
#pragma once

#include <variant>

#include "takt/axis/commands/cam.h"
#include "takt/axis/commands/coupling.h"
#include "takt/axis/commands/homing.h"
#include "takt/axis/commands/moves.h"
#include "takt/axis/commands/overlay.h"
#include "takt/axis/commands/probe.h"
#include "takt/axis/commands/profiles.h"
#include "takt/axis/commands/settings.h"
#include "takt/axis/commands/stream.h"

namespace takt::axis {

using Command = std::variant<
    Power, Reset, Straighten, MoveAbsolute, MoveRelative, MoveAdditive, MoveVelocity, MoveContinuousAbsolute,
    MoveContinuousRelative, Inch, Halt, Stop, Jog, MoveSuperimposed, HaltSuperimposed, TorqueControl, GearIn, GearOut,
    GearInPos, PhasingAbsolute, PhasingRelative, CombineAxes, CamTableSelect, CamIn, CamAdd, CamRemove, CamOut,
    PositionProfile, VelocityProfile, AccelerationProfile, Home, StepAbsSwitch, StepLimitSwitch, StepBlock,
    StepRefPulse, StepDistanceCoded, StepDirect, StepAbsolute, FinishHoming, StepRefFlyingSwitch, StepRefFlyingRefPulse,
    AbortPassiveHoming, SetConstants, SetLoad, WriteParameter, ReadParameter, SetSoftLimits, DirectOutput, PulseOutput,
    WriteOutput, SetPosition, SetOverride, TouchProbe, AbortTrigger, Touch, DigitalCamSwitch, Stream, StreamPoint>;

}  // namespace takt::axis
