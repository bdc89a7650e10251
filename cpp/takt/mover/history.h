// The last commands of a mover and their results (PL-70).
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
  std::uint64_t cycle = 0;    // in which the command was received
  std::uint64_t begun = 0;    // in which it began; later for buffered ones
  std::uint64_t changed = 0;  // of the last change of its state
  std::uint8_t command = 0;   // index in mover::Command
  FeedbackState state = FeedbackState::kBusy;
  ErrorId error = ErrorId::kNone;
  ObjectInfo object{};                         // the obstacle, if any
  LimitedBy limited_by = LimitedBy::kNothing;  // first value of its dynamics that was reduced
};

inline constexpr std::size_t kHistory = 100;

struct History {
  std::array<Record, kHistory> records;  // ring buffer
  std::uint64_t count = 0;               // number of all commands so far

  void Begin(Ticket ticket, std::uint64_t cycle, std::uint8_t command) noexcept {
    records[count++ % kHistory] = {ticket, cycle, cycle, cycle, command, FeedbackState::kBusy, ErrorId::kNone};
  }
  // Returns the record of a command; null if it has been overwritten.
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
