// All cams of a machine: first those of its file, then those made at run time (CAM-88). Axes and modules refer to a cam
// by its index, which never changes while they use it. Nothing here allocates, locks, throws or reads a clock, except
// the construction.
//
// A table is immutable: a new cam of the same name gets a free index, and the earlier one is superseded, i.e. no longer
// found by its name. Its index is free again when no axis and no module refers to it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "takt/cam/builder.h"
#include "takt/cam/commands.h"
#include "takt/cam/params.h"
#include "takt/cam/table.h"
#include "takt/core/cycle.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/feedback.h"
#include "takt/core/spsc_queue.h"

namespace takt::cam {

// Maximum number of cams made at run time, including superseded ones in use.
inline constexpr std::size_t kMadeCams = 64;

struct Draft {
  std::uint64_t number = 0;  // 0: unused
  Name name;
  Ticket ticket = 0;        // of BuildCam
  std::uint32_t count = 0;  // number of points or segments
  bool broken = false;      // a piece was refused
  bool building = false;
};

struct StoreState {
  std::array<Draft, kDrafts> drafts;
  std::array<std::uint64_t, kMadeCams> made{};  // number of the draft of each cam made at run time; 0: free
  std::uint64_t drafts_begun = 0;
};

struct Store {
  explicit Store(const std::vector<CamParams>& of_machine);
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  std::vector<Table> tables;  // of the machine file, then kMadeCams, of which those without pieces are free
  std::size_t of_machine = 0;
  StoreState state;
  std::array<CamParams, kDrafts> drafts;  // of the state, with capacity for all points and segments
  BuildQueues queues;
  SpscQueue<CamPiece> pieces{64};  // that were read; what does not fit is lost, and must be read again
};

struct Context {
  Store& store;
  std::uint64_t cycle;
  FeedbackSink& feedback;
  // Returns true if an axis or a module refers to this index.
  bool (*in_use)(const void* owner, std::uint32_t index) noexcept;
  const void* owner;
};

// Stage Apply: carries the command out or refuses it.
void Apply(const Context& c, Ticket ticket, const BeginCam& command) noexcept;
void Apply(const Context& c, Ticket ticket, const AddCamPoints& command) noexcept;
void Apply(const Context& c, Ticket ticket, const AddCamSegments& command) noexcept;
void Apply(const Context& c, Ticket ticket, const BuildCam& command) noexcept;
void Apply(const Context& c, Ticket ticket, const DropCam& command) noexcept;
void Apply(const Context& c, Ticket ticket, const ReadCam& command) noexcept;
void Apply(const Context& c, Ticket ticket, const CamBuilt& result) noexcept;

void describe(Description<Draft>&);
void describe(Description<StoreState>&);

}  // namespace takt::cam
