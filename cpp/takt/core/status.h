// What a call on the cycle answers instead of throwing, and the numbers of everything that can go wrong.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "takt/core/describe_fwd.h"

namespace takt {

// Error numbers. Those up to 2007 and 8001 are those of the TECOMAT GT-775x modules (appendix 12.1 of their manual),
// kept as they are; from 3001 on they are ours, from 20000 on those of Lenze's FAST technology modules. A text for
// each: ErrorText().
enum class ErrorId : std::uint16_t {
  kNone = 0,
  // A command was refused or failed; the axis itself is well.
  kTimeLimit = 1,
  kDistanceLimit = 2,
  kDeviationLimit = 3,
  kBlending = 4,
  kParameter = 5,
  kAxisStopping = 6,
  kAxisFault = 7,
  kTargetBehindLimit = 8,
  kNoReference = 9,
  kPowerOff = 10,
  kErrorStop = 11,
  kNoConstants = 12,
  kPowerOn = 13,
  kGroupMember = 1000,
  kGroupFull = 1001,
  kNotGroupMember = 1003,
  kOtherGroupMember = 1004,
  kGroupEmpty = 1005,
  // An axis went to ErrorStop.
  kDeviation = 2001,
  kLimitSwitchPositive = 2004,
  kLimitSwitchNegative = 2005,
  kSoftLimitPositive = 2006,
  kSoftLimitNegative = 2007,
  // Ours.
  kEncoder = 3001,            // the encoder reports an error, or jumped further than the axis can move in a cycle
  kDrive = 3002,              // the drive reports a fault or does not get ready
  kBufferFull = 3003,         // as many commands wait already as can be buffered
  kPlanning = 3004,           // no trajectory could be planned; the one in progress is kept
  kState = 3005,              // the command is not legal in the axis' state
  kAwayFromLimitOnly = 3006,  // while a limit switch is on, only moves away from it are accepted
  kOverrun = 3007,            // too many cycles in a row came too late; everything was stopped
  kUnknownTarget = 3010,      // no component or cam of this name
  kUnknownVerb = 3011,        // the component has no such command
  kQueueFull = 3012,          // commands arrive faster than the cycle takes them
  kClientName = 3013,         // another client uses this name
  kLeaseExpired = 3014,       // the client's heartbeat is missing: a level-sensitive command was released
  kShutdown = 3015,           // the engine is stopping
  kInternal = 3016,           // the engine found its own numbers broken; outputs are zero, all loops open
  kOtherRun = 3017,           // the command was meant for another start of the engine
  kCouplingLoop = 3018,       // the axis would follow itself, through others
  kMasterOff = 3019,          // a master has no set position that means anything: its loop is open, or it has a fault
  kWouldReverse = 3020,       // a clutch that may not reverse its slave finds no way to close
  kUnreachable = 3021,        // no position of the axes there: out of reach, not turned so, or beyond an axis' range
  kSingular = 3022,           // the axes cannot move the tool in every direction there
  kPathGeometry = 3023,       // the points do not make such a path
  kCollision = 3024,          // on the way parts would touch, or something that stands there
  kGroupDisabled = 3025,      // the group is not enabled
  kPathUnknown = 3026,        // no such path
  kTrackOrder = 3027,         // tracking would begin behind the place where it ends
  kTrackShort = 3028,         // tracking would end before the tool is in step
  kBeltBackwards = 3029,      // the belt moves backwards
  kTooFast = 3030,            // what carries the target is faster than the group can follow
  kOffPath = 3031,            // the tool is not where its path was left
  kNoWorkpiece = 3032,        // there is no such workpiece
  kTooOld = 3033,             // the command was not taken within its age limit
  kTiltedEllipse = 3034,      // an ellipse is to lead to what is turned about A or B
  kCarrierUnknown = 3035,     // what carries a coordinate system is not known
  kMoverDisabled = 3040,      // the mover is not enabled
  kCommandMode = 3041,        // the mover does not accept the command in its command mode, or while it moves
  kOutsideWindow = 3042,      // the mover would turn out of its window while it moves
  kNoSetPoint = 3043,         // a set point from outside is missing
  kWildSetPoint = 3044,       // a mover cannot follow a set point from outside
  kMoverDeviation = 3045,     // the mover is too far from where it is to be
  kTrackMode = 3046,          // movers on the track do what does not go with this
  kNoRoute = 3047,            // no way along tracks leads there
  kTrackDisabled = 3048,      // the track is not enabled
  kMoverTooLarge = 3049,      // the mover is larger than those the track is for
  kTrackGeometry = 3050,      // a track cannot be so; the value of the feedback says why
  kGapTooSmall = 3051,        // movers would touch at that gap; the value of the feedback is the least that would do
  kRoute = 3052,              // a route over the free surface cannot be so; the value of the feedback says why
  kObjectMoves = 3060,        // movers have to rest for this
  kStators = 3061,            // stators cannot be so; the value of the feedback says why
  kEnvironmentUsed = 3062,    // the environment is in an enabled group, or its boundary is being made
  kNoBoundary = 3063,         // the environment has no boundary
  kOtherPlanarGroup = 3064,   // it is in another group, or the group has another environment
  kNoPlanarGroup = 3065,      // it is in no group
  kTrackOutside = 3066,       // the mover is in a group, the track is not in it
  kReference = 3070,          // no such part or coordinate system, or a position in another one than the mover is in
  kOffStators = 3071,         // a mover would leave the stators
  kPartDisabled = 3072,       // a part is not enabled, or on its way
  kPartMover = 3073,          // a mover hinders a part from going; the object of the feedback says which
  kPartTrack = 3074,          // so does a track that is in use
  kPartPlace = 3075,          // so does another part
  kPartFault = 3076,          // of the part under a mover
  kPartPosition = 3077,       // a part is not where it is to be
  kTrackEnd = 3080,           // a geared mover's way ends where its master leads it
  kTrail = 3081,              // tracks do not make such a trail, or the mover is not on it
  kMasterOffTrack = 3082,     // a mover that is to be followed is not on a track, or not enabled
  kMasterLost = 3083,         // the master turned off where the mover that follows it cannot
  kFormationChain = 3090,     // a planet would be a star, too
  kStarLost = 3091,           // the star of a formation is disabled, or has a fault
  kPlanetLost = 3092,         // a planet of a formation is halted, disabled, or has a fault; the object says which
  kFormationShare = 3093,    // a formation moves with all that it can, and would have to turn meanwhile, or the reverse
  kFormationOnTrack = 3094,  // a formation moves in the free plane alone
  kEmergencyStop = 3100,     // an emergency stop is on, or has switched the axis off: nothing is powered or moved
  kSkew = 3101,              // a member of a gantry is too far from where its master has it
  kNotInStep = 3102,         // a member of a gantry is not powered, has a fault, or stands askew
  kDirection = 3103,         // motion in this direction is not enabled (MC_Power)
  kMarkDistance = 3104,      // two coded marks of an encoder are as far apart as no two neighbours are
  kNoCodedMarks = 3105,      // the encoder has no coded marks
  kEncodersApart = 3106,     // the encoders on motor and load have got further apart than they may
  // A cam module did not do as asked.
  kSyncPassed = 3110,   // the master has passed the position at which the clutch was to close
  kSlaveLimits = 3111,  // the slave cannot follow within its limits
  kEmptySlot = 3112,    // there is no cam in a slot that is needed
  kCamMaking = 3113,    // a cam cannot be made at run time; the value of the feedback says why
  kCamOver = 3114,      // the cam has ended: a ramp, or the next x zero, has no position of it to refer to
  kOpenCam = 3115,      // the end of the cam does not go over into its beginning: it is run once
  kStreamKey = 3120,    // a set point for another stream than the one in control
  kStreamLate = 3121,   // a set point came after its time
  kStreamJump = 3122,   // a set point is further from the one before it than the axis can move in their time
  kStreamEnded = 3123,  // set points stopped coming
  kZoneTaken = 3130,    // the tool came into a zone that another group has
  kZoneCircle = 3131,   // groups would wait for one another at zones
  kNoFrame = 3140,      // measured places define no frame
  kResidual = 3141,     // a measured place is too far from where the frame has it
  kGroupDeviation = 8001,
  kTooManyWorkpieces = 17918,  // a belt holds as many workpieces as it can; number of the Track Pick & Place manual
  // A cam module is in error; numbers of the Flex Cam manual.
  kModuleSoftLimitPositive = 20306,
  kModuleSoftLimitNegative = 20307,
  kModuleLimitSwitchPositive = 20500,
  kModuleLimitSwitchNegative = 20501,
};

struct ErrorInfo {
  ErrorId id;
  std::string_view name;  // the short name of the modules' list ("ETime", "ERRPOS"), or ours
  std::string_view text;  // one sentence for people, without a full stop
};
// All of them, kNone first, ascending.
std::span<const ErrorInfo> Errors() noexcept;
// Never empty; "unknown error" for a number that stands for nothing.
std::string_view ErrorText(ErrorId id) noexcept;
std::string_view ErrorName(ErrorId id) noexcept;

// What held a motion back although it was carried out.
enum class LimitedBy : std::uint8_t {
  kNothing,
  kVelocity,
  kAcceleration,
  kJerk,
  kPosition,
  kDistance,
  kOvershoot,
  kOverride,
  kTorque
};

// ok, limited (done, but held back by something) or failed.
struct Status {
  ErrorId error = ErrorId::kNone;
  LimitedBy limited_by = LimitedBy::kNothing;

  static constexpr Status Ok() { return {}; }
  static constexpr Status Failed(ErrorId id) { return {id, LimitedBy::kNothing}; }
  static constexpr Status Limited(LimitedBy by) { return {ErrorId::kNone, by}; }
  constexpr bool ok() const { return error == ErrorId::kNone; }
  constexpr bool failed() const { return error != ErrorId::kNone; }
  constexpr bool operator==(const Status&) const = default;
};

void describe(Enumeration<ErrorId>&);
void describe(Enumeration<LimitedBy>&);
void describe(Description<Status>&);

}  // namespace takt
