#include "takt/core/in_range.h"

#include <cmath>

namespace takt {

namespace {

bool InRange(const Field& field, const Type& type, const void* value) {
  switch (type.kind) {
    case Kind::kReal: {
      const double number = *static_cast<const double*>(value);
      return std::isfinite(number) && field.range.Holds(number / field.unit.scale);
    }
    case Kind::kInteger:
      return field.range.Holds(static_cast<double>(IntegerAt(type, value)));
    case Kind::kEnum:
      return type.FindEnumerator(IntegerAt(type, value)) != nullptr;
    default:
      return true;
  }
}

}  // namespace

const Field* FirstOutOfRange(const Type& type, const void* object) noexcept {
  for (const Field& field : type.fields) {
    const void* value = FieldAt(field, object);
    const Type* inner = field.type;
    if (inner->kind == Kind::kOptional) {
      value = inner->optional_value(value);
      inner = inner->element;
    }
    if (value != nullptr && !InRange(field, *inner, value)) return &field;
  }
  return nullptr;
}

}  // namespace takt
