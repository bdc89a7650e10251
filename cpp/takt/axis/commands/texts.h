// Descriptions of inputs that many commands have.
#pragma once

#include "takt/core/describe.h"

namespace takt::axis {

inline constexpr std::string_view kAcceleration = "Largest acceleration; unset: the axis' limit.";
inline constexpr std::string_view kDeceleration = "Largest deceleration; unset: the axis' limit.";
inline constexpr std::string_view kJerk =
    "Largest jerk; 0: unlimited, where the axis allows it; unset: the axis' limit.";
inline constexpr std::string_view kBufferMode = "How the command follows the previous one.";

template <typename T>
void DescribeRamps(Description<T>& d) {
  d.template defaulted<&T::acceleration>(unit::u_s2, positive, kAcceleration);
  d.template defaulted<&T::deceleration>(unit::u_s2, positive, kDeceleration);
  d.template defaulted<&T::jerk>(unit::u_s3, not_negative, kJerk);
}

// For commands that ContinuousUpdate changes.
inline constexpr std::string_view kChange =
    "True: only changes the command of this kind that is in control; aborted if there is none. No effect on a command "
    "that is buffered.";
inline constexpr std::string_view kUpdate =
    "True: only changes the command of this kind that is in control, and counts from the start of that command; "
    "aborted if there is none. No effect on a command that is buffered.";

}  // namespace takt::axis
