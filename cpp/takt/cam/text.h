// Numbers in messages.
#pragma once

#include <cmath>
#include <string>

#include "takt/core/scalar.h"

namespace takt::cam {

// Returns the number as users write it: without ".0" after a whole number; also NaN and infinity.
inline std::string Text(double value) {
  if (!std::isfinite(value)) return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
  std::string text = FormatReal(value);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text;
}

}  // namespace takt::cam
