// The complete state of tracks: plain data that can be copied, compared, hashed and replayed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/feedback.h"
#include "takt/planar/object_state.h"
#include "takt/track/sketch.h"

namespace takt::track {

inline constexpr std::size_t kLinks = 8;    // at each end
inline constexpr std::size_t kOrders = 64;  // pending changes of geometry, of all tracks

// Operation mode of a track.
enum class OperationMode : std::uint8_t {
  kUninitialized,  // not usable by movers
  kStanding,       // all movers on it are at rest
  kMoving,         // at least one mover moves along it: none may join or leave
  kConfiguring,    // at least one mover joins or leaves: none may move along it
};

// Reaction to a fault.
enum class ErrorReaction : std::uint8_t {
  kQuickStop,  // a reset leads back to Enabled
  kAbort,      // a reset leads to Disabled
};

struct Links {
  std::array<std::uint32_t, kLinks> tracks{};  // indices, from 0
  // Indices, from 1, of the positions of the parts at which alone the link holds; 0: wherever the ends meet.
  std::array<std::uint32_t, kLinks> own_positions{};
  std::array<std::uint32_t, kLinks> other_positions{};
  std::uint32_t count = 0;
};

struct State {
  planar::ObjectState state = planar::ObjectState::kDisabled;
  std::uint64_t since = 0;  // cycle in which the state was entered
  OperationMode mode = OperationMode::kUninitialized;
  Ticket ticket = 0;  // of the command that changes the state; 0: none
  ErrorId error = ErrorId::kNone;
  ErrorReaction reaction = ErrorReaction::kQuickStop;
  std::uint64_t sketch_hash = 0;  // of its sketch (in Tracks), which is large and rarely changes
  Links starts_from;              // tracks at whose ends it starts
  Links ends_at;                  // tracks at whose starts it ends
  bool has_length = false;
  double length = 0;  // [mm]
};

enum class OrderKind : std::uint8_t { kAppend, kCloseLoop, kClear, kStartFrom, kEndAt };

// A pending change of geometry.
struct Order {
  Ticket ticket = 0;
  std::uint32_t track = 0;
  OrderKind kind = OrderKind::kAppend;
  planar::Element element;  // kAppend: the element
  std::uint32_t other = 0;  // kStartFrom, kEndAt: index of the other track
  // Indices, from 1, of the positions of both tracks' parts for which the geometry is made; 0: the current ones.
  std::uint32_t own_position = 0;
  std::uint32_t other_position = 0;
  bool only_there = false;  // the link holds at these positions only
};

// Pending changes of all tracks, carried out one after the other.
struct PendingEdits {
  std::array<Order, kOrders> orders{};  // ring buffer
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  std::uint64_t question = 0;  // number of the last request
  bool asked = false;          // the first order waits for the answer to it
  // end of the other track that the request links to, in own coordinates; kept, as parts may move meanwhile
  planar::TrackPoint point;
};

void describe(Enumeration<OperationMode>&);
void describe(Enumeration<ErrorReaction>&);
void describe(Enumeration<OrderKind>&);
void describe(Description<Links>&);
void describe(Description<State>&);
void describe(Description<Order>&);
void describe(Description<PendingEdits>&);

}  // namespace takt::track
