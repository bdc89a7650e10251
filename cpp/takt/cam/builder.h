// Builds cams outside the cycle. The cycle hands over a draft; one thread outside checks it, builds the table and hands
// it back; tables no longer used are returned to be freed. The result is a command of the journal (CamBuilt). A replay
// builds the table again: it depends on the draft alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "takt/cam/commands.h"
#include "takt/cam/table.h"
#include "takt/core/feedback.h"
#include "takt/core/spsc_queue.h"

namespace takt::cam {

// Maximum number of cams that are being sent or built.
inline constexpr std::size_t kDrafts = 2;

struct BuildRequest {
  std::uint64_t number = 0;  // of the draft
  Ticket ticket = 0;
  const CamParams* draft = nullptr;  // constant until the result is applied
};

struct BuiltTable {
  std::uint64_t number = 0;
  Table* table = nullptr;  // owned
};

struct BuildQueues {
  BuildQueues() = default;
  ~BuildQueues();
  BuildQueues(const BuildQueues&) = delete;
  BuildQueues& operator=(const BuildQueues&) = delete;

  SpscQueue<BuildRequest> requests{kDrafts};
  SpscQueue<BuiltTable> built{2 * kDrafts};
  SpscQueue<Table*> retired{4 * kDrafts};  // owned
};

struct BuildResult {
  Ticket ticket = 0;
  CamBuilt built;
  std::string sentence;  // what is wrong, for users; empty if nothing is
};

// Builds the next request and frees retired tables. Returns nothing if there is no request. Outside the cycle, from one
// thread.
std::optional<BuildResult> BuildNext(BuildQueues& queues);

}  // namespace takt::cam
