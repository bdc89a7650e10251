#include "takt/core/patch.h"

#include <cstring>

#include "takt/core/describe.h"

namespace takt {

void ApplyPatch(const Type& given_type, const void* given, const Type& whole_type, void* whole) noexcept {
  for (std::size_t i = 0; i < given_type.fields.size(); ++i) {
    const Field& from = given_type.fields[i];
    const Field& to = whole_type.fields[i];
    const void* value = from.type->optional_value(FieldAt(from, given));
    if (value != nullptr) std::memcpy(static_cast<std::byte*>(whole) + to.offset, value, to.type->size);
  }
}

}  // namespace takt
