// Which cam comes next (the manual's 3.24, and the slot that is set).
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "takt/core/describe_fwd.h"
#include "takt/flexcam/settings.h"

namespace takt::flexcam {

enum class SequencePart : std::uint8_t { kNone, kIn, kOut };  // none; while the sequencer is on; what follows it

struct SequencerState {
  SequencePart part = SequencePart::kNone;
  std::uint8_t step = 0;  // of the part
};

struct SequenceStep {
  std::uint32_t slot = 1;
  bool cyclic = true;
};
// The cams of a part, the last one first run again and again where it is cyclic.
std::span<const SequenceStep> StepsOf(SequenceMode mode, SequencePart part) noexcept;

struct SequencerInputs {
  bool on = false;
  SequenceMode mode = SequenceMode::kCam1;
  SequenceStep selected;  // without a sequence: what is set
  SequenceStep running;
};

// Whether a sequence is being run (sequencer_active).
bool IsActive(const SequencerInputs& in, const SequencerState& state) noexcept;
// Where the clutch closes anew: the cam to begin with.
SequenceStep First(const SequencerInputs& in, SequencerState& state) noexcept;
// At the end of a cam: the next one. The same slot again: it goes on.
SequenceStep Next(const SequencerInputs& in, SequencerState& state) noexcept;
// While the end of a cam is held that is run once: what is to be run instead, if anything.
std::optional<SequenceStep> FromHeld(const SequencerInputs& in, SequencerState& state) noexcept;

void describe(Enumeration<SequencePart>&);
void describe(Description<SequencerState>&);

}  // namespace takt::flexcam
