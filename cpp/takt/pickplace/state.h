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

inline constexpr std::size_t kOrders = 8;  // profiles that were accepted, including the current one
inline constexpr std::size_t kPickTimes = 8;
inline constexpr std::size_t kLeft = 32;  // workpieces that were left behind and are remembered
inline constexpr std::size_t kHeld = 8;   // products whose attributes are stored

// Progress of an order.
enum class Phase : std::uint8_t {
  kNew,      // no moves given to the group yet
  kWaiting,  // waits for a workpiece
  kGoing,    // its moves are given
  kStaying,  // on the workpiece
  kHeld,     // its path was left; the moves from `next_leg` on have to be given again
};

// An accepted target with the settings of that time: later settings do not change it (PP-16).
struct Order {
  Ticket ticket = 0;
  std::uint32_t belt = 0;  // index in the module's list, from 1; 0: static target
  bool picks = false;      // true: a workpiece is picked there; false: placed
  Place target;            // of a static order
  Place start;             // place at which its profile begins
  Shape shape;
  BeltSettings own;  // settings of the belt when the order was accepted
  PathRamps ramps;
  WorkpieceRule rule = WorkpieceRule::kFirst;
  double gripper_time = 0;  // [s] from the gripper's pulse to the end of the profile
  Phase phase = Phase::kNew;
  Profile profile;
  std::uint32_t next_leg = 0;       // leg that was given first
  std::uint64_t first = 0;          // number in the group of its first move ...
  std::uint64_t last = 0;           // ... and of its last move
  std::uint32_t workpiece = 0;      // number of the workpiece; 0: none is taken
  conveyor::Attributes attributes;  // of the workpiece when it was taken
  bool from_belt = false;           // it began on a workpiece, or low over a belt
  std::uint64_t begin_cycle = 0;
  std::uint64_t stay_cycle = 0;  // cycle of arrival
  double expected_s = 0;         // estimated duration [s]
  bool gripper_off = false;      // no pulse of the gripper: the profile was stopped, or the override changed
  bool pulse_at_end = false;     // pulse at arrival: the profile was interrupted
  bool pulsed = false;
};

// A workpiece that was taken and left behind on its belt: it is missed once it has left the range. Identified by its
// number until it is taken again or has left the belt.
struct LeftWorkpiece {
  std::uint32_t belt = 0;  // index in the module's list, from 1
  std::uint32_t number = 0;
  bool refused = false;  // there was no path to it; else the path was stopped
  bool counted = false;  // as missed: it has left the module's range, but not the belt's
};

// A tracking mode that repeats by itself.
struct Loop {
  bool active = false;
  bool ends = false;    // after the current order
  bool places = false;  // the next order places
  Ticket ticket = 0;
  TrackingMode mode = TrackingMode::kProgram;
  std::uint32_t pick_belt = 0;
  std::uint32_t place_belt = 0;
};

struct JogKeys {
  Ticket ticket = 0;  // 0: no key is held
  Jog keys;
  double lease_s = 0;  // [s] > 0: lease of a dead man's key ...
  std::uint64_t lease_end_cycle = 0;
};

// A path that was left.
struct Hold {
  bool held = false;  // the group rests on it, or it has to be given again
  bool off = false;   // the tool was moved away from it
  bool returning = false;
  Ticket ticket = 0;      // of the return
  kinematics::Pose pose;  // in the MCS, where it was left
  double aux1 = 0;
  std::uint32_t legs = 0;  // legs of the order, from the first one given on, that were done then
  std::uint64_t move = 0;  // number of the returning move
};

struct HomingState {
  Ticket ticket = 0;
  std::uint32_t place = 0;  // in the homing order: these axes are homing
};

// Runs ahead of the group on its path to find out when a profile will end.
struct EndPredictor {
  bool known = false;           // the end of the profile is known
  std::uint64_t end_cycle = 0;  // cycle of that end
  bool running = false;
  std::uint64_t order_last = 0;  // number of the move whose end is to be found
  std::uint64_t cycle = 0;       // cycle that it has reached
  trajectory::PathPace pace;
};

struct State {
  Inputs inputs;
  Inputs before;  // inputs of the previous cycle, for edges
  Settings settings;
  std::array<BeltSettings, kBelts> belts;
  PickPlaceState state = PickPlaceState::kInit;
  PickPlaceState back = PickPlaceState::kReady;  // state to return to after a jog
  ErrorId error = ErrorId::kNone;
  ErrorId warning = ErrorId::kNone;
  std::uint32_t error_axes = 0;  // mask: axes that the module stopped for
  bool reset = false;            // rising edges of this cycle
  bool abort = false;
  bool ack = false;
  bool done = false;
  bool halting = false;               // the group comes to rest by the module's command
  bool enables = false;               // enables the group as soon as its axes are on and at rest
  bool powers = false;                // powers the group as soon as it is no longer being switched off
  std::array<Order, kOrders> orders;  // [0] is the current one
  std::uint32_t order_count = 0;
  Loop loop;
  // The end of the moves given so far.
  bool at_known = false;  // false: the tool's present place counts
  Place at;
  double at_distance = 0;       // [mm] length of the way up from there
  std::uint32_t at_belt = 0;    // on a workpiece of that belt; 0: static
  bool low = false;             // the path was left where the next profile has to rise first ...
  Place over;                   // ... to this height
  bool may_be_low = false;      // the tool is low over a belt, or will be if it comes to rest now: ...
  Place over_now;               // ... lower than this
  std::uint32_t parked_at = 0;  // parking position of that belt, from 1; 0: not parked
  bool parking = false;         // moving to it
  std::uint64_t parking_move = 0;
  bool parking_lifts = false;  // the first move to it leads up from a belt ...
  Place parking_over;          // ... to this place
  bool lifting = false;        // rising in step, before the tool leaves the belt
  bool rises = false;          // rises while it is still being braked; the rest of the way up follows
  PathRamps lifting_ramps;     // limits of the lift
  std::uint64_t given = 0;     // number of the next move; fewer in the group: it has refused some
  bool second_pcs = false;     // the next workpiece gets the second product coordinate system
  Hold hold;
  JogKeys jog;
  std::int8_t jog_sense = 0;
  SelectAxis jog_axis = SelectAxis::kNone;
  group::Directions jog_end;  // SW limits at which the jog ends
  bool jog_released = false;  // the jog's move was halted because its key was released
  HomingState homing;
  double override_given = 1;
  bool pulse = false;
  EndPredictor scout;
  EndPredictor next_scout;          // of the second order, from where that of the first one ended
  double profile_time = 0;          // [s]
  double preparation_time = 0;      // [s]
  std::uint64_t prepare_cycle = 0;  // cycle in which the preparation began
  double slowness = 1.1;            // ratio of the real duration of profiles to the estimated one
  std::uint32_t searched = 0;       // number of the workpiece that was tried last; 0: the search begins anew
  std::uint32_t out_of_window = 0;  // cycles left: set when the actual tool is too far away, counts down
  bool in_target = false;
  Counters counters;
  std::array<conveyor::Attributes, kHeld> held{};  // of products picked and not placed yet, the oldest first
  std::uint32_t held_count = 0;                    // products held; may be more than kHeld
  std::uint32_t warning_belt = 0;                  // belt that the warning refers to, from 1; 0: none
  std::array<LeftWorkpiece, kLeft> left{};         // the oldest first
  std::uint32_t left_count = 0;
  std::array<std::uint32_t, kBelts> refused_before{};   // of each belt
  std::array<std::uint64_t, kPickTimes> pick_cycles{};  // ring buffer
  std::uint32_t pick_count = 0;
  std::array<std::uint32_t, kBelts> lost_before{};  // of each belt
  std::array<std::uint64_t, kBelts> taken_cycle{};  // cycle in which a workpiece was last taken; 0: never
  std::uint64_t illegal_transitions = 0;            // always 0: the state table holds
};

void describe(Enumeration<Phase>&);
void describe(Description<Order>&);
void describe(Description<LeftWorkpiece>&);
void describe(Description<Loop>&);
void describe(Description<JogKeys>&);
void describe(Description<Hold>&);
void describe(Description<HomingState>&);
void describe(Description<EndPredictor>&);
void describe(Description<State>&);

}  // namespace takt::pickplace
