#include <cmath>
#include <limits>

#include "takt/core/binder.h"

namespace takt {
namespace {

// A bound as users write it: without ".0" after a whole number.
std::string Bound(double value) {
  std::string text = FormatReal(value);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text;
}

std::string IntegerLimits(const Type& type) {
  if (type.size == 8) return type.is_signed ? "" : " not below 0";
  const double span = std::ldexp(1.0, static_cast<int>(8 * type.size - (type.is_signed ? 1 : 0)));
  return " from " + Bound(type.is_signed ? -span : 0) + " to " + Bound(span - 1);
}

std::string WithUnit(std::string text, const Field* field) {
  if (field && !field->unit.text.empty()) text += " in " + LongText(field->unit);
  return text;
}

}  // namespace

std::string Text(const Range& range) {
  if (range.bounded_below() && range.bounded_above()) {
    return (range.without_min ? "above " + Bound(range.min) + " up to " : "from " + Bound(range.min) + " to ") +
           Bound(range.max);
  }
  if (range.bounded_below()) return (range.without_min ? "above " : "at least ") + Bound(range.min);
  return range.bounded_above() ? "at most " + Bound(range.max) : "";
}

std::string Expectation(const Type& type, const Field* field) {
  std::string range;
  if (field && field->range.bounded()) range.append(" ").append(Text(field->range));
  switch (type.kind) {
    case Kind::kBool:
      return "true or false";
    case Kind::kInteger:
      return WithUnit("a whole number", field) + (range.empty() ? IntegerLimits(type) : range);
    case Kind::kReal:
      return WithUnit("a number", field) + range;
    case Kind::kString:
      return "text";
    case Kind::kEnum: {
      std::string text = "one of ";
      for (const Enumerator& e : type.enumerators)
        text.append(&e == type.enumerators.data() ? "" : ", ").append(e.name);
      return text;
    }
    case Kind::kStruct:
    case Kind::kVariant:
      return "a mapping";
    case Kind::kArray:
      return "a list of " + std::to_string(type.count);
    case Kind::kVector:
      return type.count > 0 ? "a list of at most " + std::to_string(type.count) : "a list";
    case Kind::kOptional:
      return Expectation(*type.element, field) + ", or null";
  }
  return {};
}

}  // namespace takt
