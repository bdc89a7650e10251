#include "takt/track/state.h"

#include "takt/core/describe.h"

namespace takt::track {

void describe(Enumeration<OperationMode>& e) {
  e.about("Operation mode of a track.");
  e.value(OperationMode::kUninitialized, "Uninitialized", "Not usable by movers.");
  e.value(OperationMode::kStanding, "Standing", "All movers on it are at rest; they may move, join and leave.");
  e.value(OperationMode::kMoving, "Moving", "Movers move along it: no mover may join or leave.");
  e.value(OperationMode::kConfiguring, "Configuring", "Movers join or leave: no mover may move along it.");
}

void describe(Enumeration<ErrorReaction>& e) {
  e.about("Reaction to a fault.");
  e.value(ErrorReaction::kQuickStop, "quick_stop", "A reset leads back to Enabled.");
  e.value(ErrorReaction::kAbort, "abort", "A reset leads to Disabled.");
}

void describe(Enumeration<OrderKind>& e) {
  e.about("Kind of a change of the geometry of a track.");
  e.value(OrderKind::kAppend, "append", "Appends an element.");
  e.value(OrderKind::kCloseLoop, "close_loop", "Closes the loop.");
  e.value(OrderKind::kClear, "clear", "Removes all geometry and links.");
  e.value(OrderKind::kStartFrom, "start_from", "Links the start with the end of another track.");
  e.value(OrderKind::kEndAt, "end_at", "Links the end with the start of another track.");
}

void describe(Description<Links>& d) {
  d.about("Tracks linked with one end of a track.");
  d.internal<&Links::tracks>("Indices of these tracks.");
  d.internal<&Links::own_positions>(
      "Indices of the positions of its part at which alone the links hold; 0: wherever the ends meet.");
  d.internal<&Links::other_positions>(
      "Indices of the positions of the other parts at which alone the links hold; 0: wherever the ends meet.");
  d.internal<&Links::count>("Number of links.");
}

void describe(Description<State>& d) {
  using S = State;
  d.about("A track.");
  d.internal<&S::state>("State of the track.");
  d.internal<&S::since>("Cycle in which the state was entered.");
  d.internal<&S::mode>("Operation mode of the track.");
  d.internal<&S::ticket>("Ticket of the command that changes the state.");
  d.internal<&S::error>("Error of the fault.");
  d.internal<&S::reaction>("Reaction to the fault.");
  d.internal<&S::sketch_hash>("Hash of its definition.");
  d.internal<&S::starts_from>("Tracks at whose ends it starts.");
  d.internal<&S::ends_at>("Tracks at whose starts it ends.");
  d.internal<&S::has_length>("True: it has a geometry.");
  d.internal<&S::length>("Length of the track.");
}

void describe(Description<Order>& d) {
  using O = Order;
  d.about("A pending change of geometry.");
  d.internal<&O::ticket>("Ticket of the command.");
  d.internal<&O::track>("Index of the track to change.");
  d.internal<&O::kind>("Kind of the change.");
  d.internal<&O::element>("Element to append.");
  d.internal<&O::other>("Index of the track to link with.");
  d.internal<&O::own_position>("Index of the position of its part for which the geometry is made; 0: the present one.");
  d.internal<&O::other_position>(
      "Index of the position of the other track's part for which the geometry is made; 0: the present one.");
  d.internal<&O::only_there>("True: the link holds at these positions only.");
}

void describe(Description<PendingEdits>& d) {
  using W = PendingEdits;
  d.about("Pending changes of all tracks, made one after the other.");
  d.internal<&W::orders>("Ring buffer of changes.");
  d.internal<&W::first>("Position of the first change in the ring buffer.");
  d.internal<&W::count>("Number of pending changes.");
  d.internal<&W::question>("Number of the last request to build a track.");
  d.internal<&W::asked>("True: the first change waits for the answer to it.");
  d.internal<&W::point>("Point at which the track of that request starts or ends by a link.");
}

}  // namespace takt::track
