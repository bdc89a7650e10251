// All memory of a pick and place module: plain, so that it can be copied, compared, hashed and replayed.
#pragma once

#include <array>
#include <cstdint>

#include "takt/conveyor/state.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/feedback.h"
#include "takt/core/status.h"
#include "takt/group/state.h"
#include "takt/kinematics/joints.h"
#include "takt/pickplace/commands.h"
#include "takt/pickplace/outputs.h"
#include "takt/pickplace/profile.h"
#include "takt/pickplace/settings.h"
#include "takt/pickplace/state_table.h"
#include "takt/trajectory/path_pace.h"

namespace takt::pickplace {

inline constexpr std::size_t kOrders = 8;  // profiles that may wait, with the one that is gone
inline constexpr std::size_t kPickTimes = 8;
inline constexpr std::size_t kLeft = 32;  // workpieces that were left and are known
inline constexpr std::size_t kHeld = 8;   // products whose attributes are known

// Where an order has got to.
enum class Phase : std::uint8_t {
  kNew,      // nothing of it is given to the group
  kWaiting,  // for a workpiece
  kGoing,    // its moves are given
  kStaying,  // on the workpiece
  kHeld,     // its path was left; the moves from `next_leg` on are to be given again
};

// A target that was accepted, with all that was set then: later settings do not change it (PP-16).
struct Order {
  Ticket ticket = 0;
  std::uint32_t belt = 0;  // of the module's list, from 1; 0: static
  bool picks = false;      // a workpiece is picked there; else placed
  Place target;            // static
  Place start;             // where it began
  Shape shape;
  BeltSettings own;  // of the belt, as it was accepted
  PathRamps ramps;
  WorkpieceRule rule = WorkpieceRule::kFirst;
  double gripper_time = 0;  // s
  Phase phase = Phase::kNew;
  Profile profile;
  std::uint32_t next_leg = 0;       // the first one given
  std::uint64_t first = 0;          // number of its first move ...
  std::uint64_t last = 0;           // ... and of its last one, in the group
  std::uint32_t workpiece = 0;      // its number; 0: none is taken
  conveyor::Attributes attributes;  // of it, as it was taken
  bool from_belt = false;           // it began on a workpiece, or low over a belt
  std::uint64_t begin_cycle = 0;
  std::uint64_t stay_cycle = 0;  // when it arrived
  double expected_s = 0;         // the way was thought to take
  bool gripper_off = false;      // it was stopped, or the override changed
  bool pulse_at_end = false;     // it was interrupted
  bool pulsed = false;
};

// A workpiece that was taken and left behind on its belt: it is missed once it has left the range. Known by its number
// until it is taken again or gone.
struct LeftWorkpiece {
  std::uint32_t belt = 0;  // of the module's list, from 1
  std::uint32_t number = 0;
  bool refused = false;  // there was no path to it; else the path was stopped
  bool counted = false;  // as missed: it has left the module's range, and not the belt's
};

// A tracking mode that goes round and round.
struct Loop {
  bool active = false;
  bool ends = false;    // behind the order that is gone
  bool places = false;  // the next order is to place
  Ticket ticket = 0;
  TrackingMode mode = TrackingMode::kProgram;
  std::uint32_t pick_belt = 0;
  std::uint32_t place_belt = 0;
};

struct JogKeys {
  Ticket ticket = 0;  // 0: none is held
  Jog keys;
  double lease_s = 0;  // > 0: a dead man's lease ...
  std::uint64_t lease_end_cycle = 0;
};

// A path that was left.
struct Hold {
  bool held = false;  // the group rests on it, or it is to be given again
  bool off = false;   // the tool was moved away
  bool returning = false;
  Ticket ticket = 0;      // of the way back
  kinematics::Pose pose;  // in the MCS: where it was left
  double aux1 = 0;
  std::uint32_t legs = 0;  // of the order, from its first one given on, that were done then
  std::uint64_t move = 0;  // of the way back
};

struct HomingState {
  Ticket ticket = 0;
  std::uint32_t place = 0;  // in the order: these axes are looking
};

// Goes ahead of the group on its path, to know when a profile will be over.
struct Scout {
  bool known = false;           // when the profile ends
  std::uint64_t end_cycle = 0;  // then
  bool running = false;
  std::uint64_t order_last = 0;  // number of the move that it looks for
  std::uint64_t cycle = 0;       // where it has got to
  trajectory::PathPace pace;
};

struct State {
  Inputs inputs;
  Inputs before;  // inputs of the cycle before, for their edges
  Settings settings;
  std::array<BeltSettings, kBelts> belts;
  PickPlaceState state = PickPlaceState::kInit;
  PickPlaceState back = PickPlaceState::kReady;  // from a jog
  ErrorId error = ErrorId::kNone;
  ErrorId warning = ErrorId::kNone;
  std::uint32_t error_axes = 0;  // mask: those that the module stopped for
  bool reset = false;            // edges of this cycle
  bool abort = false;
  bool ack = false;
  bool done = false;
  bool halting = false;               // the group comes to rest because the module told it to
  bool enables = false;               // the group, as soon as its axes are on and stand
  bool powers = false;                // the group, as soon as it is no longer being switched off
  std::array<Order, kOrders> orders;  // [0] is the one that is gone
  std::uint32_t order_count = 0;
  Loop loop;
  // Where the moves given end.
  bool at_known = false;  // else where the tool stands
  Place at;
  double at_distance = 0;       // mm, that the way up from there is long
  std::uint32_t at_belt = 0;    // on a workpiece of that belt; 0: static
  bool low = false;             // it was left where the next profile has to rise first ...
  Place over;                   // ... as high as this
  bool may_be_low = false;      // it is low over a belt, or will be when it comes to rest now: ...
  Place over_now;               // ... lower than this
  std::uint32_t parked_at = 0;  // the parking position of that belt, from 1
  bool parking = false;         // on the way there
  std::uint64_t parking_move = 0;
  bool parking_lifts = false;  // the first move of that leads up from a belt ...
  Place parking_over;          // ... to this
  bool lifting = false;        // in step, before the tool leaves the belt
  bool rises = false;          // while it is still braked; then the rest of the way up
  PathRamps lifting_ramps;     // of that
  std::uint64_t given = 0;     // number that the next move gets: fewer in the group mean that it refused some
  bool second_pcs = false;     // workpieces get the second one next
  Hold hold;
  JogKeys jog;
  std::int8_t jog_sense = 0;
  SelectAxis jog_axis = SelectAxis::kNone;
  group::Directions jog_end;  // SW limits at which the jog ends
  bool jog_released = false;  // the jog's move was halted because its key was released
  HomingState homing;
  double override_given = 1;
  bool pulse = false;
  Scout scout;
  Scout next_scout;                 // of the second order, from where that of the first one has got to
  double profile_time = 0;          // s
  double preparation_time = 0;      // s
  std::uint64_t prepare_cycle = 0;  // when it began
  double slowness = 1.1;            // the real time of profiles to the expected one
  std::uint32_t searched = 0;       // number of the workpiece that was tried last; 0: the search begins anew
  std::uint32_t out_of_window = 0;  // cycles since the measured tool was too far away: counts down
  bool in_target = false;
  Counters counters;
  std::array<conveyor::Attributes, kHeld> held{};  // of what was picked and is not placed yet, the oldest first
  std::uint32_t held_count = 0;                    // all that is held; may be more than kHeld
  std::uint32_t warning_belt = 0;                  // that the warning is about, from 1; 0: none
  std::array<LeftWorkpiece, kLeft> left{};         // the oldest first
  std::uint32_t left_count = 0;
  std::array<std::uint32_t, kBelts> refused_before{};   // of the belts
  std::array<std::uint64_t, kPickTimes> pick_cycles{};  // a ring
  std::uint32_t pick_count = 0;
  std::array<std::uint32_t, kBelts> lost_before{};  // of the belts
  std::array<std::uint64_t, kBelts> taken_cycle{};  // when a workpiece was taken last; 0: none was
  std::uint64_t illegal_transitions = 0;            // always 0: the state table holds
};

void describe(Enumeration<Phase>&);
void describe(Description<Order>&);
void describe(Description<LeftWorkpiece>&);
void describe(Description<Loop>&);
void describe(Description<JogKeys>&);
void describe(Description<Hold>&);
void describe(Description<HomingState>&);
void describe(Description<Scout>&);
void describe(Description<State>&);

}  // namespace takt::pickplace
