// Why the axes cannot reach a pose, for the sentence of a refused move (GR-44).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "takt/kinematics/kinematics.h"

namespace takt::group {

// For each configuration of a mechanism that was tried: the reason, and the axis that would leave its range. Fits into
// FeedbackEvent::detail, five bits for each configuration besides the number of the group.
class Failures {
 public:
  Failures() = default;
  explicit Failures(std::uint64_t detail) noexcept;

  void Add(const kinematics::Configuration& in, kinematics::Reason reason) noexcept;
  // `axis`: index among the group's members.
  void AddLimit(const kinematics::Configuration& in, std::size_t axis, bool upper) noexcept;

  // Returns the code of FeedbackEvent::detail; 0 if there is no failure. `group`: its number, from 1.
  std::uint64_t Detail(std::uint32_t group) const noexcept;
  std::uint32_t group() const noexcept { return group_; }
  // Returns the sentence, without a full stop; empty if all are singular. `axes`: names of the group's members.
  std::string Sentence(std::span<const std::string> axes) const;

 private:
  std::array<std::uint8_t, 8> codes_{};  // by shoulder, elbow and wrist
  std::uint32_t group_ = 0;
};

}  // namespace takt::group
