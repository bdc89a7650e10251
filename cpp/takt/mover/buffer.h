// Commands of a mover that wait for their turn (PL-71): each begins when all that were given before it are done.
//
// In its turn a command waits further (PL-72, PL-83) while a part on its way, another mover or a track that is Moving
// is in its way: what may be gone by itself. It is asked anew in each cycle and reserves nothing meanwhile, so the
// mover stands where it has reserved to stand. Only while the mover in its way is leaving, others that wait, too, but
// not as long, do not get what it waits for (planar::AskTurn). Nothing of the invariant of the guard depends on it.
// Movers that wait for one another in a ring say so.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/feedback.h"
#include "takt/core/object.h"
#include "takt/mover/commands.h"
#include "takt/planar/area.h"

namespace takt::mover {

struct Context;
struct State;

inline constexpr std::size_t kBuffered = 16;

struct Queued {
  Ticket ticket = 0;
  Command command;
  // Bits of the slots of Z, A, B and C whose commands were given later: it does not wait for them.
  std::uint32_t beside = 0;
};

struct Buffer {
  std::array<Queued, kBuffered> waiting{};  // the next one first
  std::uint32_t count = 0;
  std::uint32_t releases = 0;  // that nobody has taken
  std::uint64_t until = 0;     // cycle at which a Wait is over
  bool for_release = false;    // what it waits for, too
  // A way along tracks that went over into the next one is done where it was to end (Slot kPassing).
  double passing_at = 0;  // mm, with those of all tracks left behind
  std::int8_t direction = 1;
  // The part, mover or track that the next one waits for in its turn; of a mover, where that stood when it was asked.
  ObjectInfo held_by{};
  planar::Pose held_at{};
  std::uint64_t held_since = 0;  // cycle
};

// Whether this one waits for its turn.
bool IsBuffered(const Command& command) noexcept;
// Lets it wait. False: there is no room.
bool Push(Ticket ticket, const Command& command, Buffer& buffer) noexcept;
// It would take over at once, but this is in its way: the mover comes to rest, and the command is the next one. What it
// would have taken over from is aborted.
void WaitInTurn(const Context& c, Ticket ticket, const Command& command, const ObjectInfo& in_the_way,
                State& s) noexcept;
// One of Z, A, B or C has begun at once: what waits already does not wait for it.
void GoBeside(Ticket ticket, State& s) noexcept;
// None waits any more.
void AbortBuffered(const Context& c, State& s) noexcept;
// move: ends a Wait, and gives the next one its turn if it is that.
void TakeTurns(const Context& c, State& s) noexcept;
// At the end of a cycle: what was passed is done.
void LookBack(const Context& c, State& s) noexcept;
// The mover that this one, at rest, waits for: because of its own command or the next one. kNobody: none.
std::uint32_t WaitsFor(const Context& c, std::uint32_t mover) noexcept;

void describe(Description<Queued>&);
void describe(Description<Buffer>&);

}  // namespace takt::mover
