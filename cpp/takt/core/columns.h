// The numbers inside a described struct, by name, for recorders and plots.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "takt/core/describe.h"

namespace takt {

struct Column {
  std::string name;  // "set_position" of a struct, "voltage[2]" of a list
  std::string_view about;
  Unit unit;
  std::size_t offset = 0;      // in the object for which the columns were made
  const Type* type = nullptr;  // bool, integer, real, enum, or an optional of these
};

// Returns one column for each number, switch and enum that is stored in the struct itself, internal fields included.
// Strings and lists of variable length have no column.
std::vector<Column> ColumnsOf(const Type& type);

// Returns the value in written units; enums as their number, bools as 0 and 1, an empty optional as NaN. Does not
// allocate.
double ReadColumn(const Column& column, const void* object) noexcept;

}  // namespace takt
