#include "takt/core/status.h"

#include <array>

#include "takt/core/describe.h"

namespace takt {

namespace {

constexpr std::array kErrors = {
    ErrorInfo{ErrorId::kNone, "none", "no error"},
    ErrorInfo{ErrorId::kTimeLimit, "ETime", "the time limit of the command was exceeded"},
    ErrorInfo{ErrorId::kDistanceLimit, "EDistance", "the distance limit of the command was exceeded"},
    ErrorInfo{ErrorId::kDeviationLimit, "EDev", "the axis did not get into its in-position window in time"},
    ErrorInfo{ErrorId::kBlending, "EBlanding", "the move cannot be blended into the one before it"},
    ErrorInfo{ErrorId::kParameter, "EParam", "an argument is out of range or beyond the limits of the axis"},
    ErrorInfo{ErrorId::kAxisStopping, "EAxStop", "the axis is being stopped and takes no other motion"},
    ErrorInfo{ErrorId::kAxisFault, "EAxis", "the fault of the axis is still there"},
    ErrorInfo{ErrorId::kTargetBehindLimit, "Ecil", "the target lies behind a SW limit, or an end of the track"},
    ErrorInfo{ErrorId::kNoReference, "Ehome", "the axis has no reference"},
    ErrorInfo{ErrorId::kPowerOff, "Epower", "the axis is not powered"},
    ErrorInfo{ErrorId::kErrorStop, "Eerrstop", "the axis is in ErrorStop and needs a reset"},
    ErrorInfo{ErrorId::kNoConstants, "Econst", "the constants of the axis have not been set"},
    ErrorInfo{ErrorId::kPowerOn, "EpowerOff", "the axis is powered and must not be"},
    ErrorInfo{ErrorId::kGroupMember, "EGroupMember", "the axis is a member of a group"},
    ErrorInfo{ErrorId::kGroupFull, "EGroupFull", "the group is full"},
    ErrorInfo{ErrorId::kNotGroupMember, "ENotGroupMember", "the axis is not a member of the group"},
    ErrorInfo{ErrorId::kOtherGroupMember, "EOtherGroup", "the axis is a member of another group"},
    ErrorInfo{ErrorId::kGroupEmpty, "EGroupEmpty", "the group has no axes"},
    ErrorInfo{ErrorId::kDeviation, "ERRPOS", "the following error was too large; the loop is open"},
    ErrorInfo{ErrorId::kLimitSwitchPositive, "ERRLIP", "the axis ran onto its positive limit switch"},
    ErrorInfo{ErrorId::kLimitSwitchNegative, "ERRLIN", "the axis ran onto its negative limit switch"},
    ErrorInfo{ErrorId::kSoftLimitPositive, "ERRSWP", "the axis ran onto its positive SW limit"},
    ErrorInfo{ErrorId::kSoftLimitNegative, "ERRSWN", "the axis ran onto its negative SW limit"},
    ErrorInfo{ErrorId::kEncoder, "Encoder", "the encoder reports an error or jumped further than the axis can move"},
    ErrorInfo{ErrorId::kDrive, "Drive", "the drive reports a fault or does not get ready"},
    ErrorInfo{ErrorId::kBufferFull, "BufferFull", "no more commands can wait: the buffer is full"},
    ErrorInfo{ErrorId::kPlanning, "Planning", "no motion could be planned; the one in progress is kept"},
    ErrorInfo{ErrorId::kState, "State", "the command is not legal in this state"},
    ErrorInfo{ErrorId::kAwayFromLimitOnly, "AwayFromLimitOnly",
              "a limit switch is on: only moves away from it are accepted"},
    ErrorInfo{ErrorId::kOverrun, "Overrun", "too many cycles in a row came too late; everything was stopped"},
    ErrorInfo{ErrorId::kUnknownTarget, "UnknownTarget", "there is no component or cam of this name"},
    ErrorInfo{ErrorId::kUnknownVerb, "UnknownVerb", "the component has no such command"},
    ErrorInfo{ErrorId::kQueueFull, "QueueFull", "commands arrive faster than the cycle takes them"},
    ErrorInfo{ErrorId::kClientName, "ClientName", "another client uses this name"},
    ErrorInfo{ErrorId::kLeaseExpired, "LeaseExpired",
              "the heartbeat of the client is missing; the command was released"},
    ErrorInfo{ErrorId::kShutdown, "Shutdown", "the engine is stopping"},
    ErrorInfo{ErrorId::kInternal, "Internal",
              "a number of the engine was not finite; outputs are zero and the loop is open"},
    ErrorInfo{ErrorId::kOtherRun, "OtherRun", "the command was meant for another start of the engine"},
    ErrorInfo{ErrorId::kCouplingLoop, "CouplingLoop", "the coupling would form a loop (all movers count as one node)"},
    ErrorInfo{ErrorId::kMasterOff, "MasterOff",
              "the position of the master is not known: an axis without power or with a fault, a mover that is not "
              "enabled or not on its track"},
    ErrorInfo{ErrorId::kWouldReverse, "WouldReverse", "the clutch cannot close without reversing the slave"},
    ErrorInfo{ErrorId::kUnreachable, "Unreachable",
              "no position of the axes leads there: out of reach, not turned so, or beyond the range of an axis"},
    ErrorInfo{ErrorId::kSingular, "Singular", "the axes cannot move the tool in every direction there"},
    ErrorInfo{ErrorId::kPathGeometry, "PathGeometry", "the points define no such path"},
    ErrorInfo{ErrorId::kCollision, "Collision", "there would be a collision on the path"},
    ErrorInfo{ErrorId::kGroupDisabled, "GroupDisabled", "the group is not enabled"},
    ErrorInfo{ErrorId::kPathUnknown, "PathUnknown", "there is no such path"},
    ErrorInfo{ErrorId::kTrackOrder, "TrackOrder", "tracking would begin behind the position where it ends"},
    ErrorInfo{ErrorId::kTrackShort, "TrackShort", "tracking would end before the tool is in step"},
    ErrorInfo{ErrorId::kBeltBackwards, "BeltBackwards", "the belt moves backwards"},
    ErrorInfo{ErrorId::kTooFast, "TooFast", "the carrier of the target is faster than the group can follow"},
    ErrorInfo{ErrorId::kOffPath, "OffPath", "the tool is not at the position where its path was left"},
    ErrorInfo{ErrorId::kNoWorkpiece, "NoWorkpiece", "there is no such workpiece"},
    ErrorInfo{ErrorId::kTooOld, "TooOld", "the command was not taken within its age limit (lcm.command_age_s)"},
    ErrorInfo{
        ErrorId::kTiltedEllipse, "TiltedEllipse",
        "an elliptical profile cannot lead to or from a coordinate system that is turned about A or B of the world; "
        "use path_mode linear"},
    ErrorInfo{ErrorId::kCarrierUnknown, "CarrierUnknown",
              "the carrier of the product coordinate system is not known: its pose was never given, or its group has "
              "no kinematics"},
    ErrorInfo{ErrorId::kMoverDisabled, "MoverDisabled", "the mover is not enabled"},
    ErrorInfo{ErrorId::kCommandMode, "CommandMode",
              "the mover does not accept this in its command mode, or while it moves"},
    ErrorInfo{ErrorId::kOutsideWindow, "OutsideWindow", "the mover may not turn out of its window while it moves"},
    ErrorInfo{ErrorId::kNoSetPoint, "NoSetPoint", "a set point from outside is missing"},
    ErrorInfo{ErrorId::kWildSetPoint, "WildSetPoint", "the mover cannot follow this set point from outside"},
    ErrorInfo{ErrorId::kMoverDeviation, "MoverDeviation", "the position deviation of the mover was too large"},
    ErrorInfo{ErrorId::kTrackMode, "TrackMode", "a command of a mover on the track does not allow this"},
    ErrorInfo{ErrorId::kNoRoute, "NoRoute", "no route along tracks leads there"},
    ErrorInfo{ErrorId::kTrackDisabled, "TrackDisabled", "the track is not enabled"},
    ErrorInfo{ErrorId::kMoverTooLarge, "MoverTooLarge", "the mover is larger than the track permits"},
    ErrorInfo{ErrorId::kTrackGeometry, "TrackGeometry", "the geometry of the track is invalid"},
    ErrorInfo{ErrorId::kGapTooSmall, "GapTooSmall", "movers of this size and rotation would touch at that gap"},
    ErrorInfo{ErrorId::kRoute, "Route", "the route over the free surface is not possible"},
    ErrorInfo{ErrorId::kObjectMoves, "ObjectMoves", "the object must be at rest for this command"},
    ErrorInfo{ErrorId::kStators, "Stators", "the layout of the stators is invalid"},
    ErrorInfo{ErrorId::kEnvironmentUsed, "EnvironmentUsed",
              "the environment is in an enabled group, or its boundary is being made"},
    ErrorInfo{ErrorId::kNoBoundary, "NoBoundary", "the environment has no boundary"},
    ErrorInfo{ErrorId::kOtherPlanarGroup, "OtherPlanarGroup",
              "it is in another group, or the group has another environment"},
    ErrorInfo{ErrorId::kNoPlanarGroup, "NoPlanarGroup", "it is in no group"},
    ErrorInfo{ErrorId::kTrackOutside, "TrackOutside", "the track is not in the group of the mover"},
    ErrorInfo{ErrorId::kReference, "Reference",
              "there is no such part or coordinate system, or the mover is in another one"},
    ErrorInfo{ErrorId::kOffStators, "OffStators", "the mover would leave the stators"},
    ErrorInfo{ErrorId::kPartDisabled, "PartDisabled", "the part is not enabled, or moves"},
    ErrorInfo{ErrorId::kPartMover, "PartMover", "a mover is in the way of the part"},
    ErrorInfo{ErrorId::kPartTrack, "PartTrack", "a track on the part is in use"},
    ErrorInfo{ErrorId::kPartPlace, "PartPlace", "another part is at the target of the part"},
    ErrorInfo{ErrorId::kPartFault, "PartFault", "the part has a fault"},
    ErrorInfo{ErrorId::kPartPosition, "PartPosition", "the part is not at its commanded position"},
    ErrorInfo{ErrorId::kTrackEnd, "TrackEnd",
              "the route of the mover ends before the position that its master demands"},
    ErrorInfo{ErrorId::kTrail, "Trail", "the tracks form no such trail, or the mover is not on it"},
    ErrorInfo{ErrorId::kMasterOffTrack, "MasterOffTrack", "the mover to be followed is not enabled, or not on a track"},
    ErrorInfo{ErrorId::kMasterLost, "MasterLost",
              "the master took a branch that the mover that follows it cannot take"},
    ErrorInfo{ErrorId::kFormationChain, "FormationChain",
              "a planet of a formation cannot be a star, nor a star a planet"},
    ErrorInfo{ErrorId::kStarLost, "StarLost", "the star of the formation is disabled, or has a fault"},
    ErrorInfo{ErrorId::kPlanetLost, "PlanetLost", "a planet of the formation is halted, disabled, or has a fault"},
    ErrorInfo{ErrorId::kFormationShare, "FormationShare",
              "the formation moves, or turns, with all that it can, and cannot begin the other meanwhile"},
    ErrorInfo{ErrorId::kFormationOnTrack, "FormationOnTrack", "a formation moves in the free plane alone"},
    ErrorInfo{ErrorId::kEmergencyStop, "EmergencyStop",
              "an emergency stop is on, or has switched this off: release it, then ask for power anew"},
    ErrorInfo{ErrorId::kSkew, "Skew",
              "the measured skew of the axis differs from the commanded one by more than follows.largest_skew"},
    ErrorInfo{ErrorId::kNotInStep, "NotInStep",
              "an axis that follows this one is not powered, has a fault, or is skewed"},
    ErrorInfo{ErrorId::kDirection, "Direction",
              "motion in this direction is not enabled (enable_positive and enable_negative of power)"},
    ErrorInfo{ErrorId::kMarkDistance, "MarkDistance",
              "the distance between the two marks passed matches no neighbours of encoder.coded_marks"},
    ErrorInfo{ErrorId::kNoCodedMarks, "NoCodedMarks",
              "the encoder has no distance-coded marks (encoder.coded_marks of the machine file)"},
    ErrorInfo{ErrorId::kEncodersApart, "EncodersApart",
              "the distance between motor and load has changed by more than supervision.encoders_apart"},
    ErrorInfo{
        ErrorId::kSyncPassed, "SyncPassed",
        "the master has passed the begin of the clutch's curve to master_sync_in_position, master_sync_position of "
        "cam_in, or the position of a change of cam, and moves away from it"},
    ErrorInfo{ErrorId::kSlaveLimits, "SlaveLimits",
              "the slave's limits are too low for the clutch's curve at the speed of the master"},
    ErrorInfo{ErrorId::kEmptySlot, "EmptySlot", "a slot of the sequence has no cam"},
    ErrorInfo{ErrorId::kCamMaking, "CamMaking", "the cam cannot be built"},
    ErrorInfo{ErrorId::kCamOver, "CamOver",
              "the cam has ended: this ramp, or the next x zero, has no position of a cam to refer to"},
    ErrorInfo{ErrorId::kOpenCam, "OpenCam",
              "the end of the cam does not continue at its beginning (the slopes differ): it is run once"},
    ErrorInfo{ErrorId::kStreamKey, "StreamKey", "the set point is for another stream than the one in control"},
    ErrorInfo{ErrorId::kStreamLate, "StreamLate",
              "the set point arrived after its time; a larger delay leaves more time"},
    ErrorInfo{ErrorId::kStreamJump, "StreamJump",
              "the set point is further from the previous one than the axis can move in the time between them"},
    ErrorInfo{ErrorId::kStreamEnded, "StreamEnded", "no set point of the stream has come within its timeout"},
    ErrorInfo{ErrorId::kZoneTaken, "ZoneTaken", "the tool came to a zone that another group has; it was stopped"},
    ErrorInfo{ErrorId::kZoneCircle, "ZoneCircle",
              "deadlock at zones: this group holds a zone for which the holder of the next zone waits"},
    ErrorInfo{ErrorId::kNoFrame, "NoFrame",
              "the measured positions define no frame: they coincide, or lie on one line"},
    ErrorInfo{ErrorId::kResidual, "Residual",
              "the residual of a measured position exceeds largest_residual; measure it again"},
    ErrorInfo{ErrorId::kGroupDeviation, "ERRPOSG", "an axis of the group had too large a following error"},
    ErrorInfo{ErrorId::kTooManyWorkpieces, "TooManyWorkpieces", "the belt holds its largest number of workpieces"},
    ErrorInfo{ErrorId::kModuleSoftLimitPositive, "SWLimitPos", "an axis of the module is at its upper SW limit"},
    ErrorInfo{ErrorId::kModuleSoftLimitNegative, "SWLimitNeg", "an axis of the module is at its lower SW limit"},
    ErrorInfo{ErrorId::kModuleLimitSwitchPositive, "HWLimitPos",
              "the positive limit switch of an axis of the module is on; only motion away from it is accepted"},
    ErrorInfo{ErrorId::kModuleLimitSwitchNegative, "HWLimitNeg",
              "the negative limit switch of an axis of the module is on; only motion away from it is accepted"},
};

constexpr ErrorInfo kUnknown{ErrorId::kNone, "unknown", "unknown error"};

const ErrorInfo& Find(ErrorId id) {
  for (const ErrorInfo& e : kErrors) {
    if (e.id == id) return e;
  }
  return kUnknown;
}

}  // namespace

std::span<const ErrorInfo> Errors() noexcept {
  return kErrors;
}
std::string_view ErrorText(ErrorId id) noexcept {
  return Find(id).text;
}
std::string_view ErrorName(ErrorId id) noexcept {
  return Find(id).name;
}

void describe(Enumeration<ErrorId>& e) {
  e.about("Error; 0: none.");
  for (const ErrorInfo& error : kErrors) e.value(error.id, error.name, error.text);
}

void describe(Enumeration<LimitedBy>& e) {
  e.about("Limit that restricted a motion although it was carried out.");
  e.value(LimitedBy::kNothing, "nothing", "No limit.");
  e.value(LimitedBy::kVelocity, "velocity", "The largest velocity.");
  e.value(LimitedBy::kAcceleration, "acceleration", "The largest acceleration or deceleration.");
  e.value(LimitedBy::kJerk, "jerk", "The largest jerk.");
  e.value(LimitedBy::kPosition, "position", "A position limit.");
  e.value(LimitedBy::kDistance, "distance",
          "Too little room, for instance to blend at the velocity asked for, or to stop with the command's ramps.");
  e.value(LimitedBy::kOvershoot, "overshoot", "The target is too near to stop at: the axis passes it and comes back.");
  e.value(LimitedBy::kOverride, "override", "The velocity factor of the override is 0: the axis waits.");
  e.value(LimitedBy::kTorque, "torque", "The torque limit: the drive gives all that it is allowed.");
}

void describe(Description<Status>& d) {
  d.about("Ok, limited or failed.");
  d.internal<&Status::error>("Error of the command.");
  d.internal<&Status::limited_by>("Limit that restricted the motion.");
}

}  // namespace takt
