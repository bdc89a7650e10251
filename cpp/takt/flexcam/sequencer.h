// Selects the next cam (the manual's 3.24, and the selected slot).
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "takt/core/describe_fwd.h"
#include "takt/flexcam/settings.h"

namespace takt::flexcam {

// no sequence; while the sequencer is on; the exit after it
enum class SequencePart : std::uint8_t { kNone, kIn, kOut };

struct SequencerState {
  SequencePart part = SequencePart::kNone;
  std::uint8_t step = 0;  // index within the part
};

struct SequenceStep {
  std::uint32_t slot = 1;
  bool cyclic = true;
};
// Returns the cams of a part in order; a cyclic one is repeated.
std::span<const SequenceStep> StepsOf(SequenceMode mode, SequencePart part) noexcept;

struct SequencerInputs {
  bool on = false;
  SequenceMode mode = SequenceMode::kCam1;
  SequenceStep selected;  // without a sequence: the selected slot
  SequenceStep running;
};

// Returns true if a sequence is running (sequencer_active).
bool IsActive(const SequencerInputs& in, const SequencerState& state) noexcept;
// Returns the cam to begin with when the clutch closes anew.
SequenceStep First(const SequencerInputs& in, SequencerState& state) noexcept;
// At the end of a cam: returns the next one. The same slot: it continues.
SequenceStep Next(const SequencerInputs& in, SequencerState& state) noexcept;
// While the end of a cam that is run once is held: returns the cam to run instead, if any.
std::optional<SequenceStep> FromHeld(const SequencerInputs& in, SequencerState& state) noexcept;

void describe(Enumeration<SequencePart>&);
void describe(Description<SequencerState>&);

}  // namespace takt::flexcam
