// All memory of an axes group: plain, so that it can be copied, compared, hashed and replayed.
#pragma once

#include <array>
#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/feedback.h"
#include "takt/core/status.h"
#include "takt/group/request.h"
#include "takt/group/state_table.h"
#include "takt/kinematics/joints.h"
#include "takt/trajectory/path_pace.h"

namespace takt::group {

inline constexpr std::size_t kQueue = 128;  // moves that may wait
inline constexpr std::size_t kSynced = 4;   // axes that follow the path

// Moves in the order in which they came; a ring.
struct Queue {
  std::array<Request, kQueue> moves;
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

// Where the planning of a move has got to.
enum class Stage : std::uint8_t { kIdle, kVerify, kCheck, kJoin, kSample, kSweep };

struct Planning {
  Stage stage = Stage::kIdle;
  std::uint64_t move = 0;       // number of the move that is planned, from 0 since the start
  std::uint32_t element = 0;    // of a path
  std::uint32_t sampled = 0;    // so many samples are verified
  double s = 0;                 // so far it is sampled
  std::uint64_t digest = 0;     // of what was planned: the window itself is not part of the state
};

struct SyncedAxis {
  Ticket ticket = 0;
  std::uint32_t axis = 0;  // + 1; 0: none
  double ratio = 1;        // u per mm
  double offset = 0;       // u
};

struct State {
  GroupState state = GroupState::kDisabled;
  ErrorId error = ErrorId::kNone;
  std::array<std::uint32_t, kMaxAxes> members{};  // axis + 1 in each place; 0: none
  bool kinematics_on = true;
  std::array<kinematics::Pose, kProductSystems> product_systems{};  // in the MCS
  double velocity_factor = 1;
  double acceleration_factor = 1;
  double jerk_factor = 1;

  Queue queue;           // [first] is the one planned or moved along now
  std::uint64_t done = 0;  // number of the move at queue.first
  Planning planning;
  trajectory::PathPace pace;
  bool guides = false;        // the members go by the group's set points
  bool interrupted = false;   // rests, or comes to rest, on the path until it is continued
  bool ends = false;          // comes to rest and forgets what is left of the path
  trajectory::AlongPath brake;  // how strongly then; 0: as the path says
  bool hold = false;          // stop: until released
  Ticket ticket = 0;          // of stop, halt, interrupt, home
  double lease_s = 0;
  std::uint64_t lease_end_cycle = 0;
  kinematics::Joints joints{};  // where the members are told to be, u over all turns
  bool resetting = false;
  Ticket reset_ticket = 0;
  std::array<SyncedAxis, kSynced> synced;
  kinematics::Reason reason = kinematics::Reason::kNone;
  path::Problem problem = path::Problem::kNone;
  double blocked_at = 0;
};

void describe(Description<Queue>&);
void describe(Enumeration<Stage>&);
void describe(Description<Planning>&);
void describe(Description<SyncedAxis>&);
void describe(Description<State>&);

}  // namespace takt::group
