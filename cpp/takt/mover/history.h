// The last commands of a mover and what became of them (PL-70).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/feedback.h"
#include "takt/core/status.h"

namespace takt::mover {

struct Record {
  Ticket ticket = 0;          // 0: none
  std::uint64_t cycle = 0;    // that took the command
  std::uint64_t begun = 0;    // cycle in which it began; buffered ones later
  std::uint64_t changed = 0;  // cycle in which it came to be what it is
  std::uint8_t command = 0;   // place in mover::Command
  FeedbackState state = FeedbackState::kBusy;
  ErrorId error = ErrorId::kNone;
  ObjectInfo object{};                         // that was in the way
  LimitedBy limited_by = LimitedBy::kNothing;  // what of its dynamics was reduced
};

inline constexpr std::size_t kHistory = 100;

struct History {
  std::array<Record, kHistory> records;  // a ring
  std::uint64_t count = 0;               // of all commands so far

  void Begin(Ticket ticket, std::uint64_t cycle, std::uint8_t command) noexcept {
    records[count++ % kHistory] = {ticket, cycle, cycle, cycle, command, FeedbackState::kBusy, ErrorId::kNone};
  }
  // Null: it is too old, and forgotten.
  Record* Find(Ticket ticket) noexcept {
    const std::uint64_t oldest = count > kHistory ? count - kHistory : 0;
    for (std::uint64_t i = count; i-- > oldest;) {
      if (records[i % kHistory].ticket == ticket) return &records[i % kHistory];
    }
    return nullptr;
  }
  void Note(const FeedbackEvent& event) noexcept {
    Record* record = Find(event.ticket);
    if (!record) return;
    record->changed = event.cycle;
    if (event.state == FeedbackState::kActive) record->begun = event.cycle;
    record->state = event.state;
    record->error = event.error;
    record->object = event.object;
  }
};

void describe(Description<Record>&);
void describe(Description<History>&);

}  // namespace takt::mover
