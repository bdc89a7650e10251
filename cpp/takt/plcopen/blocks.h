// Includes all function blocks, and names those that are commands alone: MC_ as in PLCopen (parts 1, 4 and 5), GT_ as
// in the GT-775x modules. A new command needs one line: UpdatedBlock if its inputs may change while Execute is true
// (ContinuousUpdate), else Block. Commands without a name here are used as Block<Command>: MC_AbortPassiveHoming is
// Block<axis::AbortPassiveHoming>.
#pragma once

#include "takt/plcopen/administration.h"
#include "takt/plcopen/block.h"
#include "takt/plcopen/group.h"
#include "takt/plcopen/moves.h"
#include "takt/plcopen/program.h"
#include "takt/plcopen/reading.h"

namespace takt::plcopen {

using MC_MoveAbsolute = UpdatedBlock<axis::MoveAbsolute>;
using MC_MoveRelative = UpdatedBlock<axis::MoveRelative>;
using MC_MoveAdditive = UpdatedBlock<axis::MoveAdditive>;
using MC_Halt = Block<axis::Halt>;
using MC_HaltSuperimposed = Block<axis::HaltSuperimposed>;
using MC_MoveContinue = MC_MoveContinuousAbsolute;

using MC_PositionProfile = UpdatedBlock<axis::PositionProfile>;
using MC_VelocityProfile = UpdatedBlock<axis::VelocityProfile>;
using MC_AccelerationProfile = UpdatedBlock<axis::AccelerationProfile>;

using MC_CamTableSelect = Block<axis::CamTableSelect>;
using MC_CamOut = Block<axis::CamOut>;
using MC_GearOut = Block<axis::GearOut>;
using MC_Phasing = MC_PhasingAbsolute;

using MC_Home = Block<axis::Home>;
using MC_StepAbsSwitch = Block<axis::StepAbsSwitch>;
using MC_StepLimitSwitch = Block<axis::StepLimitSwitch>;
using MC_StepBlock = Block<axis::StepBlock>;
using MC_StepRefPulse = Block<axis::StepRefPulse>;
using MC_StepDistanceCoded = Block<axis::StepDistanceCoded>;
using MC_StepDirect = Block<axis::StepDirect>;
using MC_StepAbsolute = Block<axis::StepAbsolute>;
using MC_FinishHoming = Block<axis::FinishHoming>;
using MC_StepRefFlyingSwitch = Block<axis::StepRefFlyingSwitch>;
using MC_StepRefFlyingRefPulse = Block<axis::StepRefFlyingRefPulse>;

using GT_SetConstant = Block<axis::SetConstants>;
using GT_SWLim = Block<axis::SetSoftLimits>;
using GT_Analog = Block<axis::DirectOutput>;
using GT_Pulse = Block<axis::PulseOutput>;
using MC_SetPosition = Block<axis::SetPosition>;
using MC_WriteDigitalOutput = Block<axis::WriteOutput>;
using MC_WriteParameter = Block<axis::WriteParameter>;
using MC_AbortTrigger = Block<axis::AbortTrigger>;

// The names of PLCopen Part 5.
using MC_StepAbsoluteSwitch = MC_StepAbsSwitch;
using MC_StepReferencePulse = MC_StepRefPulse;
using MC_HomeDirect = MC_StepDirect;
using MC_HomeAbsolute = MC_StepAbsolute;
using MC_StepReferenceFlyingSwitch = MC_StepRefFlyingSwitch;
using MC_StepReferenceFlyingRefPulse = MC_StepRefFlyingRefPulse;

}  // namespace takt::plcopen
