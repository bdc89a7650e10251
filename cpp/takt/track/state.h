// All memory of tracks: plain, so that it can be copied, compared, hashed and replayed.
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
inline constexpr std::size_t kOrders = 64;  // changes of geometry that wait, of all tracks

// What a track is doing as a way for movers.
enum class OperationMode : std::uint8_t {
  kUninitialized,  // no mover can use it
  kStanding,       // all movers on it stand and wait
  kMoving,         // at least one moves along it: none may join or leave
  kConfiguring,    // at least one joins or leaves: none may move along it
};

// What a fault does.
enum class ErrorReaction : std::uint8_t {
  kQuickStop,  // a reset leads back to Enabled
  kAbort,      // a reset leads to Disabled
};

struct Links {
  std::array<std::uint32_t, kLinks> tracks{};  // numbers of tracks, from 0
  // Indices of the only positions of their parts where they are linked, from 1; 0: wherever they meet.
  std::array<std::uint32_t, kLinks> own_positions{};
  std::array<std::uint32_t, kLinks> other_positions{};
  std::uint32_t count = 0;
};

struct State {
  planar::ObjectState state = planar::ObjectState::kDisabled;
  std::uint64_t since = 0;  // cycle in which it became so
  OperationMode mode = OperationMode::kUninitialized;
  Ticket ticket = 0;  // of the command that changes the state; 0: none
  ErrorId error = ErrorId::kNone;
  ErrorReaction reaction = ErrorReaction::kQuickStop;
  std::uint64_t sketch_hash = 0;  // of what it is given by (Tracks), which changes rarely and is large
  Links starts_from;              // at the ends of these tracks
  Links ends_at;                  // at the starts of these
  bool has_length = false;
  double length = 0;  // mm
};

enum class OrderKind : std::uint8_t { kAppend, kCloseLoop, kClear, kStartFrom, kEndAt };

// A change of geometry that waits to be made.
struct Order {
  Ticket ticket = 0;
  std::uint32_t track = 0;
  OrderKind kind = OrderKind::kAppend;
  planar::Element element;  // to append
  std::uint32_t other = 0;  // track to start from or end at
  // Indices of positions of the parts of both tracks, for which the geometry is made; 0: as they are.
  std::uint32_t own_position = 0;
  std::uint32_t other_position = 0;
  bool only_there = false;  // the link is in force there alone
};

// Changes of all tracks, one made after the other.
struct PendingEdits {
  std::array<Order, kOrders> orders{};  // a ring
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  std::uint64_t question = 0;  // number of the last one
  bool asked = false;          // and the first order waits for its answer
  planar::TrackPoint point;    // where the track of that question starts or ends by a link: parts may move meanwhile
};

void describe(Enumeration<OperationMode>&);
void describe(Enumeration<ErrorReaction>&);
void describe(Enumeration<OrderKind>&);
void describe(Description<Links>&);
void describe(Description<State>&);
void describe(Description<Order>&);
void describe(Description<PendingEdits>&);

}  // namespace takt::track
