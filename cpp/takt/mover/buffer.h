// Command buffer of a mover (PL-71): a buffered command begins when all commands given before it are done.
//
// When it is its turn, a command waits further (PL-72, PL-83) while an obstacle that may leave by itself blocks it: a
// part that is moving, another mover or a track that is Moving. The request is repeated in each cycle and reserves
// nothing meanwhile, so the mover stays at rest within the area that it has reserved. Only while the blocking mover is
// leaving, other waiting movers that have waited less do not get the awaited area (planar::AskTurn). The invariant of
// the guard does not depend on any of this. Movers that wait for one another in a ring report a deadlock.
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
  // Bits of the slots of Z, A, B and C whose commands were given later: this command does not wait for them.
  std::uint32_t beside = 0;
};

struct Buffer {
  std::array<Queued, kBuffered> waiting{};  // [0] is next
  std::uint32_t count = 0;
  std::uint32_t releases = 0;  // releases that no Wait has consumed
  std::uint64_t until = 0;     // cycle in which the time of a Wait is over
  bool for_release = false;    // the Wait ends with a release only
  // A move along tracks that continued into the next one without a stop is done at its own target (Slot kPassing).
  double passing_at = 0;  // [mm] over all tracks left behind
  std::int8_t direction = 1;
  // The part, mover or track that blocks the next command; for a mover, its pose when the request was refused.
  ObjectInfo held_by{};
  planar::Pose held_at{};
  std::uint64_t held_since = 0;  // cycle
};

// Returns true if the command is buffered.
bool IsBuffered(const Command& command) noexcept;
// Appends a command; returns false if the buffer is full.
bool Push(Ticket ticket, const Command& command, Buffer& buffer) noexcept;
// Brings the mover to rest for a command with kAborting that `in_the_way` blocks, and makes that command the next one
// of the buffer. The commands that it would have replaced are aborted.
void WaitInTurn(const Context& c, Ticket ticket, const Command& command, const ObjectInfo& in_the_way,
                State& s) noexcept;
// A command of Z, A, B or C has begun at once: the commands in the buffer do not wait for it.
void GoBeside(Ticket ticket, State& s) noexcept;
// Aborts all buffered commands.
void AbortBuffered(const Context& c, State& s) noexcept;
// Cycle stage move: ends a Wait that is over, and begins the next command if it is its turn.
void BeginNext(const Context& c, State& s) noexcept;
// At the end of a cycle: reports the command in kPassing done once the mover has passed its target.
void FinishPassed(const Context& c, State& s) noexcept;
// Returns the mover that this one, at rest, waits for, with its own command or the next buffered one; kNobody: none.
std::uint32_t WaitsFor(const Context& c, std::uint32_t mover) noexcept;

void describe(Description<Queued>&);
void describe(Description<Buffer>&);

}  // namespace takt::mover
