#include "takt/track/state.h"

#include "takt/core/describe.h"

namespace takt::track {

void describe(Enumeration<OperationMode>& e) {
  e.about("What a track is doing as a way for movers.");
  e.value(OperationMode::kUninitialized, "Uninitialized", "No mover can use it.");
  e.value(OperationMode::kStanding, "Standing", "All movers on it stand; they may move, join and leave.");
  e.value(OperationMode::kMoving, "Moving", "Movers move along it: none may join or leave.");
  e.value(OperationMode::kConfiguring, "Configuring", "Movers join or leave: none may move along it.");
}

void describe(Enumeration<ErrorReaction>& e) {
  e.about("What a fault does.");
  e.value(ErrorReaction::kQuickStop, "quick_stop", "A reset leads back to Enabled.");
  e.value(ErrorReaction::kAbort, "abort", "A reset leads to Disabled.");
}

void describe(Enumeration<OrderKind>& e) {
  e.about("How the geometry of a track is to change.");
  e.value(OrderKind::kAppend, "append", "An element more.");
  e.value(OrderKind::kCloseLoop, "close_loop", "It becomes a loop.");
  e.value(OrderKind::kClear, "clear", "Nothing is left.");
  e.value(OrderKind::kStartFrom, "start_from", "It starts where another one ends.");
  e.value(OrderKind::kEndAt, "end_at", "It ends where another one starts.");
}

void describe(Description<Links>& d) {
  d.about("Tracks that a track is linked with.");
  d.internal<&Links::tracks>("Their numbers.");
  d.internal<&Links::own_positions>("Of the track's part, where it is linked; 0: wherever they meet.");
  d.internal<&Links::other_positions>("Of the parts of the others.");
  d.internal<&Links::count>("So many.");
}

void describe(Description<State>& d) {
  using S = State;
  d.about("A track.");
  d.internal<&S::state>("State.");
  d.internal<&S::since>("Cycle in which it became so.");
  d.internal<&S::mode>("What it is doing.");
  d.internal<&S::ticket>("Of the command that changes the state.");
  d.internal<&S::error>("The fault.");
  d.internal<&S::reaction>("What the fault does.");
  d.internal<&S::sketch_hash>("Of what it is given by.");
  d.internal<&S::starts_from>("Tracks at whose ends it starts.");
  d.internal<&S::ends_at>("Tracks at whose starts it ends.");
  d.internal<&S::has_length>("There is a way.");
  d.internal<&S::length>("Of the way.");
}

void describe(Description<Order>& d) {
  using O = Order;
  d.about("A change of geometry that waits to be made.");
  d.internal<&O::ticket>("Of the command.");
  d.internal<&O::track>("Whose.");
  d.internal<&O::kind>("How.");
  d.internal<&O::element>("To append.");
  d.internal<&O::other>("Track to start from or end at.");
  d.internal<&O::own_position>("Of its part, for which the geometry is made.");
  d.internal<&O::other_position>("Of the other's part.");
  d.internal<&O::only_there>("The link is in force there alone.");
}

void describe(Description<PendingEdits>& d) {
  using W = PendingEdits;
  d.about("Changes of all tracks, one made after the other.");
  d.internal<&W::orders>("They.");
  d.internal<&W::first>("Which of them is the first.");
  d.internal<&W::count>("So many wait.");
  d.internal<&W::question>("Number of the last question.");
  d.internal<&W::asked>("The first waits for its answer.");
  d.internal<&W::point>("Where the track of that question starts or ends by a link.");
}

}  // namespace takt::track
