#include "takt/group/failures.h"

#include <algorithm>
#include <string_view>
#include <vector>

namespace takt::group {

namespace {

using kinematics::Reason;

constexpr unsigned kBits = 5;
constexpr unsigned kGroupAt = 40;  // the codes use the bits below
constexpr std::uint8_t kOutOfReach = 1, kOrientation = 2, kSingular = 3, kLimits = 4;

constexpr std::array kNames = {"shoulder", "elbow", "wrist"};
constexpr std::array<std::array<std::string_view, 2>, 3> kValues = {
    {{"front", "back"}, {"positive", "negative"}, {"positive", "negative"}}};

std::size_t IndexOf(const kinematics::Configuration& in) {
  const std::size_t shoulder = in.shoulder == kinematics::Shoulder::kBack ? 4 : 0;
  const std::size_t elbow = in.elbow == kinematics::Elbow::kNegative ? 2 : 0;
  const std::size_t wrist = in.wrist == kinematics::Wrist::kNegative ? 1 : 0;
  return shoulder + elbow + wrist;
}

bool ValueOf(std::size_t configuration, std::size_t name) {
  return (configuration >> (2 - name) & 1) != 0;
}

std::string Why(std::uint8_t code, std::span<const std::string> axes) {
  if (code == kOutOfReach) return "out of reach";
  if (code == kOrientation) return "the tool cannot take this orientation";
  if (code == kSingular) return "singular";
  const std::size_t axis = (code - kLimits) / 2;
  const std::string name = axis < axes.size() ? "axis '" + axes[axis] + "'" : "an axis";
  return name + " would leave its range at the " + ((code - kLimits) % 2 == 1 ? "upper" : "lower") + " end";
}

// Returns those of `used` that agree with `one` in the names of a mask.
std::vector<std::size_t> Alike(const std::vector<std::size_t>& used, std::size_t one, unsigned names) {
  std::vector<std::size_t> out;
  for (const std::size_t other : used) {
    bool alike = true;
    for (std::size_t n = 0; n < kNames.size(); ++n) {
      if ((names >> n & 1) != 0 && ValueOf(other, n) != ValueOf(one, n)) alike = false;
    }
    if (alike) out.push_back(other);
  }
  return out;
}

std::string InWords(std::size_t configuration, unsigned names) {
  std::string text;
  for (std::size_t n = 0; n < kNames.size(); ++n) {
    if ((names >> n & 1) == 0) continue;
    text += (text.empty() ? "" : ", ") + std::string(kNames[n]) + " " +
            std::string(kValues[n][ValueOf(configuration, n) ? 1 : 0]);
  }
  return text;
}

// Returns, in words, the names that distinguish `these` among those used: as few as possible.
std::string Which(const std::vector<std::size_t>& these, const std::vector<std::size_t>& used) {
  for (const unsigned names : {1U, 2U, 4U, 3U, 5U, 6U}) {
    if (Alike(used, these.front(), names) == these) return InWords(these.front(), names);
  }
  unsigned differing = 0;
  for (std::size_t n = 0; n < kNames.size(); ++n) {
    for (const std::size_t one : used) differing |= ValueOf(one, n) != ValueOf(used.front(), n) ? 1U << n : 0U;
  }
  std::string text;
  for (const std::size_t one : these) text += (text.empty() ? "" : "; or ") + InWords(one, differing);
  return text;
}

}  // namespace

Failures::Failures(std::uint64_t detail) noexcept : group_(static_cast<std::uint32_t>(detail >> kGroupAt)) {
  for (std::size_t i = 0; i < codes_.size(); ++i) {
    codes_[i] = static_cast<std::uint8_t>(detail >> (kBits * i) & ((1U << kBits) - 1));
  }
}

void Failures::Add(const kinematics::Configuration& in, Reason reason) noexcept {
  std::uint8_t& code = codes_[IndexOf(in)];
  if (reason == Reason::kOutOfReach) code = kOutOfReach;
  if (reason == Reason::kOrientation) code = kOrientation;
  if (reason == Reason::kSingular) code = kSingular;
}

void Failures::AddLimit(const kinematics::Configuration& in, std::size_t axis, bool upper) noexcept {
  codes_[IndexOf(in)] = static_cast<std::uint8_t>(kLimits + 2 * axis + (upper ? 1 : 0));
}

std::uint64_t Failures::Detail(std::uint32_t group) const noexcept {
  std::uint64_t detail = 0;
  for (std::size_t i = 0; i < codes_.size(); ++i) detail |= std::uint64_t{codes_[i]} << (kBits * i);
  return detail == 0 ? 0 : detail | std::uint64_t{group} << kGroupAt;
}

std::string Failures::Sentence(std::span<const std::string> axes) const {
  std::vector<std::size_t> used;
  for (std::size_t i = 0; i < codes_.size(); ++i) {
    if (codes_[i] != 0) used.push_back(i);
  }
  // Singular positions have a sentence of their own.
  if (std::ranges::all_of(used, [&](std::size_t i) { return codes_[i] == kSingular; })) return {};
  std::string text = "no position of the axes leads there: ";
  std::vector<std::uint8_t> told;
  for (const std::size_t first : used) {
    const std::uint8_t code = codes_[first];
    if (std::ranges::find(told, code) != told.end()) continue;
    std::vector<std::size_t> these;
    for (const std::size_t one : used) {
      if (codes_[one] == code) these.push_back(one);
    }
    text += (told.empty() ? "" : "; ") + Why(code, axes);
    told.push_back(code);
    if (these.size() == used.size()) return text + (used.size() > 1 ? ", in every configuration" : "");
    text += " (" + Which(these, used) + ")";
  }
  return text;
}

}  // namespace takt::group
