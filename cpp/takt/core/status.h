// Results of calls within the cycle, which do not throw, and the numbers of all errors.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "takt/core/describe_fwd.h"

namespace takt {

// Error numbers. Those up to 2007 and 8001 are those of the TECOMAT GT-775x modules (appendix 12.1 of their manual),
// unchanged; from 3001 on they are ours, from 20000 on those of Lenze's FAST technology modules. ErrorText() gives a
// text for each.
enum class ErrorId : std::uint16_t {
  kNone = 0,
  // A command was refused or failed; the axis has no fault.
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
  // An axis entered ErrorStop.
  kDeviation = 2001,
  kLimitSwitchPositive = 2004,
  kLimitSwitchNegative = 2005,
  kSoftLimitPositive = 2006,
  kSoftLimitNegative = 2007,
  // Ours.
  kEncoder = 3001,            // the encoder reports an error, or jumped further than the axis can move in a cycle
  kDrive = 3002,              // the drive reports a fault or does not become ready
  kBufferFull = 3003,         // the buffer of waiting commands is full
  kPlanning = 3004,           // no trajectory could be planned; the one in progress is kept
  kState = 3005,              // the command is not legal in the axis' state
  kAwayFromLimitOnly = 3006,  // while a limit switch is on, only moves away from it are accepted
  kOverrun = 3007,            // too many consecutive cycles were late; everything was stopped
  kUnknownTarget = 3010,      // no component or cam of this name
  kUnknownVerb = 3011,        // the component has no such command
  kQueueFull = 3012,          // commands arrive faster than the cycle takes them
  kClientName = 3013,         // another client uses this name
  kLeaseExpired = 3014,       // the client's heartbeat is missing: a level-sensitive command was released
  kShutdown = 3015,           // the engine is stopping
  kInternal = 3016,           // the engine found its own values inconsistent; outputs are zero, all loops open
  kOtherRun = 3017,           // the command was meant for another run of the engine
  kCouplingLoop = 3018,       // the coupling would form a loop: the axis would follow itself through other axes
  kMasterOff = 3019,          // a master has no valid set position: its loop is open, or it has a fault
  kWouldReverse = 3020,       // a clutch that may not reverse its slave finds no curve to close
  // no position of the axes reaches it: out of reach, orientation impossible, or beyond an axis' range
  kUnreachable = 3021,
  kSingular = 3022,          // the axes cannot move the tool in every direction there
  kPathGeometry = 3023,      // the points do not form a valid path
  kCollision = 3024,         // parts would touch on the path, or touch an obstacle
  kGroupDisabled = 3025,     // the group is not enabled
  kPathUnknown = 3026,       // no such path
  kTrackOrder = 3027,        // tracking would begin behind the position where it ends
  kTrackShort = 3028,        // tracking would end before the tool is synchronised
  kBeltBackwards = 3029,     // the belt moves backwards
  kTooFast = 3030,           // the carrier of the target is faster than the group can follow
  kOffPath = 3031,           // the tool is not at the position where its path was left
  kNoWorkpiece = 3032,       // no such workpiece
  kTooOld = 3033,            // the command was not taken within its age limit
  kTiltedEllipse = 3034,     // an ellipse would lead to a pose that is rotated about A or B
  kCarrierUnknown = 3035,    // the carrier of a coordinate system is not known
  kMoverDisabled = 3040,     // the mover is not enabled
  kCommandMode = 3041,       // the mover does not accept the command in its command mode, or while it moves
  kOutsideWindow = 3042,     // the mover would rotate out of its window while it moves
  kNoSetPoint = 3043,        // an external set point is missing
  kWildSetPoint = 3044,      // a mover cannot follow an external set point
  kMoverDeviation = 3045,    // the mover is too far from its set point
  kTrackMode = 3046,         // the movers on the track are in a mode that conflicts with this
  kNoRoute = 3047,           // no route along tracks leads there
  kTrackDisabled = 3048,     // the track is not enabled
  kMoverTooLarge = 3049,     // the mover is larger than the movers that the track is for
  kTrackGeometry = 3050,     // the geometry of a track is invalid; the value of the feedback says why
  kGapTooSmall = 3051,       // movers would touch at that gap; the value of the feedback is the smallest sufficient gap
  kRoute = 3052,             // a route over the free surface is invalid; the value of the feedback says why
  kObjectMoves = 3060,       // movers must be at rest for this
  kStators = 3061,           // the arrangement of stators is invalid; the value of the feedback says why
  kEnvironmentUsed = 3062,   // the environment is in an enabled group, or its boundary is being built
  kNoBoundary = 3063,        // the environment has no boundary
  kOtherPlanarGroup = 3064,  // the object is in another group, or the group has another environment
  kNoPlanarGroup = 3065,     // the object is in no group
  kTrackOutside = 3066,      // the mover is in a group that does not contain the track
  kReference = 3070,         // no such part or coordinate system, or a position in another one than the mover's
  kOffStators = 3071,        // a mover would leave the stators
  kPartDisabled = 3072,      // a part is not enabled, or is moving
  kPartMover = 3073,         // a mover prevents a part from moving; the object of the feedback says which
  kPartTrack = 3074,         // likewise a track that is in use
  kPartPlace = 3075,         // likewise another part
  kPartFault = 3076,         // the part under a mover has a fault
  kPartPosition = 3077,      // a part is not at its commanded position
  kTrackEnd = 3080,          // the route of a geared mover ends before the position to which its master leads it
  kTrail = 3081,             // tracks do not form a connected trail, or the mover is not on it
  kMasterOffTrack = 3082,    // a mover that is to be the master is not on a track, or not enabled
  kMasterLost = 3083,        // the master turned onto a track that the mover following it cannot reach
  kFormationChain = 3090,    // a planet would be a star, too
  kStarLost = 3091,          // the star of a formation is disabled, or has a fault
  kPlanetLost = 3092,        // a planet of a formation is halted, disabled, or has a fault; the object says which
  kFormationShare = 3093,    // a formation at its full dynamics cannot translate and rotate at the same time
  kFormationOnTrack = 3094,  // a formation can only move in the free plane
  kEmergencyStop = 3100,     // an emergency stop is on, or has switched the axis off: nothing is powered or moved
  kSkew = 3101,              // a member of a gantry is too far from the position that its master gives it
  kNotInStep = 3102,         // a member of a gantry is not powered, has a fault, or is skewed
  kDirection = 3103,         // motion in this direction is not enabled (MC_Power)
  kMarkDistance = 3104,      // the distance of two coded marks of an encoder is that of no two neighbours
  kNoCodedMarks = 3105,      // the encoder has no coded marks
  kEncodersApart = 3106,     // the encoders on motor and load have moved further apart than allowed
  // A cam module did not do what was requested.
  kSyncPassed = 3110,   // the master has passed the position at which the clutch was to close
  kSlaveLimits = 3111,  // the slave cannot follow within its limits
  kEmptySlot = 3112,    // a slot that is needed has no cam
  kCamMaking = 3113,    // a cam cannot be built at run time; the value of the feedback says why
  kCamOver = 3114,      // the cam has ended: a ramp, or the next x zero, has no position on it to refer to
  kOpenCam = 3115,      // the end of the cam does not join its beginning: it is run once
  kStreamKey = 3120,    // the set point is for another stream than the one in control
  kStreamLate = 3121,   // a set point arrived after its time
  kStreamJump = 3122,   // a set point is further from the one before it than the axis can move in the time between them
  kStreamEnded = 3123,  // no further set points arrived
  kZoneTaken = 3130,    // the tool reached a zone that another group occupies
  kZoneCircle = 3131,   // groups would wait for one another at zones
  kNoFrame = 3140,      // measured points define no frame
  kResidual = 3141,     // a measured point is too far from its position in the frame
  kGroupDeviation = 8001,
  kTooManyWorkpieces = 17918,  // a belt holds the maximum number of workpieces; number of the Track Pick & Place manual
  // A cam module is in error; numbers of the Flex Cam manual.
  kModuleSoftLimitPositive = 20306,
  kModuleSoftLimitNegative = 20307,
  kModuleLimitSwitchPositive = 20500,
  kModuleLimitSwitchNegative = 20501,
};

struct ErrorInfo {
  ErrorId id;
  std::string_view name;  // the short name of the modules' list ("ETime", "ERRPOS"), or ours
  std::string_view text;  // one sentence for users, without a full stop
};
// Returns all errors, kNone first, in ascending order.
std::span<const ErrorInfo> Errors() noexcept;
// Never empty; "unknown error" for an unknown number.
std::string_view ErrorText(ErrorId id) noexcept;
std::string_view ErrorName(ErrorId id) noexcept;

// The quantity that limited a motion although it was carried out.
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

// ok, limited (done, but limited by something) or failed.
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
