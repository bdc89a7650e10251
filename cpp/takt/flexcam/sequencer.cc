#include "takt/flexcam/sequencer.h"

#include <array>

#include "takt/core/describe.h"

namespace takt::flexcam {

namespace {

constexpr std::array<SequenceStep, 3> kIn123 = {{{1, false}, {2, false}, {3, true}}};
constexpr std::array<SequenceStep, 2> kIn13 = {{{1, false}, {3, true}}};
constexpr std::array<SequenceStep, 1> kIn1 = {{{1, true}}};
constexpr std::array<SequenceStep, 1> kIn3 = {{{3, true}}};
constexpr std::array<SequenceStep, 1> kOut1 = {{{1, false}}};
constexpr std::array<SequenceStep, 2> kOut41 = {{{4, false}, {1, true}}};

// Begins a part; skips its first cam if that is already running.
SequenceStep Begin(const SequencerInputs& in, SequencePart part, SequencerState& s) {
  const std::span<const SequenceStep> steps = StepsOf(in.mode, part);
  s.part = part;
  s.step = 0;
  if (steps.front().slot != in.running.slot || steps.front().cyclic) return steps.front();
  s.step = 1;
  return steps.size() > 1 ? steps[1] : steps[0];  // its end is held
}

}  // namespace

std::span<const SequenceStep> StepsOf(SequenceMode mode, SequencePart part) noexcept {
  if (part == SequencePart::kNone) return {};
  const bool in = part == SequencePart::kIn;
  switch (mode) {
    case SequenceMode::kCam1:
      return in ? std::span<const SequenceStep>(kIn1) : std::span<const SequenceStep>();
    case SequenceMode::kCam3:
      return in ? std::span<const SequenceStep>(kIn3) : std::span<const SequenceStep>();
    case SequenceMode::kCam1Cam3:
      return in ? std::span<const SequenceStep>(kIn13) : std::span<const SequenceStep>(kOut1);
    case SequenceMode::kCam1Cam2Cam3:
      return in ? std::span<const SequenceStep>(kIn123) : std::span<const SequenceStep>(kOut41);
  }
  return {};
}

bool IsActive(const SequencerInputs& in, const SequencerState& s) noexcept {
  const std::span<const SequenceStep> steps = StepsOf(in.mode, s.part);
  // A cyclic cam of the exit is no sequence any more.
  return s.part == SequencePart::kIn ||
         (s.part == SequencePart::kOut && s.step < steps.size() && !steps[s.step].cyclic);
}

SequenceStep First(const SequencerInputs& in, SequencerState& s) noexcept {
  s = {};
  if (!in.on) return in.selected;
  s.part = SequencePart::kIn;
  return StepsOf(in.mode, s.part).front();
}

SequenceStep Next(const SequencerInputs& in, SequencerState& s) noexcept {
  if (in.on && s.part != SequencePart::kIn) return Begin(in, SequencePart::kIn, s);
  if (!in.on && s.part == SequencePart::kIn) {
    if (StepsOf(in.mode, SequencePart::kOut).empty()) {
      s = {};
      return in.selected;
    }
    return Begin(in, SequencePart::kOut, s);
  }
  const std::span<const SequenceStep> steps = StepsOf(in.mode, s.part);
  if (s.part == SequencePart::kNone || s.step >= steps.size()) return in.selected;
  const SequenceStep now = steps[s.step];
  if (!now.cyclic) {
    ++s.step;  // beyond the last one, its end is held
    return s.step < steps.size() ? steps[s.step] : now;
  }
  if (s.part == SequencePart::kOut && in.selected.slot != now.slot) {
    s = {};
    return in.selected;
  }
  return now;
}

std::optional<SequenceStep> FromHeld(const SequencerInputs& in, SequencerState& s) noexcept {
  const bool in_sequence = IsActive(in, s) && s.part == SequencePart::kIn;
  if (in.on) return in_sequence ? std::nullopt : std::optional(First(in, s));
  const bool same = in.selected.slot == in.running.slot;
  if (same && (!in.selected.cyclic || s.part == SequencePart::kOut)) return std::nullopt;
  s = {};
  return in.selected;
}

void describe(Enumeration<SequencePart>& e) {
  e.about("Part of a sequence of cams that is being run.");
  e.value(SequencePart::kNone, "none", "No sequence is run.");
  e.value(SequencePart::kIn, "in", "Cams that are run while the sequencer is on.");
  e.value(SequencePart::kOut, "out", "Cams that follow when it is switched off.");
}

void describe(Description<SequencerState>& d) {
  d.about("A sequence of cams.");
  d.internal<&SequencerState::part>("Part of the sequence.");
  d.internal<&SequencerState::step>("Cam in that part, from 0.");
}

}  // namespace takt::flexcam
