#include "takt/core/columns.h"

#include <limits>
#include <utility>

namespace takt {
namespace {

bool IsNumber(const Type& type) {
  return type.kind == Kind::kBool || type.kind == Kind::kInteger || type.kind == Kind::kReal ||
         type.kind == Kind::kEnum;
}

// Returns the unit of a rate: for the fields of a struct whose own unit is 1/s.
Unit PerSecond(const Unit& quantity) {
  for (const auto& [of, rate] :
       {std::pair{unit::mm, unit::mm_s}, std::pair{unit::deg, unit::deg_s}, std::pair{unit::u, unit::u_s}}) {
    if (quantity.text == of.text) return rate;
  }
  return quantity;
}

void Append(std::vector<Column>& columns, const Type& type, const std::string& path, std::size_t offset,
            const Field& field) {
  if (IsNumber(type) || (type.kind == Kind::kOptional && IsNumber(*type.element))) {
    columns.push_back({path, field.about, field.unit, offset, &type});
  } else if (type.kind == Kind::kStruct) {
    for (Field inner : type.fields) {
      if (field.unit.text == unit::one_s.text) inner.unit = PerSecond(inner.unit);
      const std::string name = (path.empty() ? "" : path + "_") + std::string(inner.name);
      Append(columns, *inner.type, name, offset + inner.offset, inner);
    }
  } else if (type.kind == Kind::kArray) {
    for (std::size_t i = 0; i < type.count; ++i) {
      Append(columns, *type.element, path + "[" + std::to_string(i) + "]", offset + i * type.element->size, field);
    }
  }
}

double ReadNumber(const Type& type, const void* number, double scale) noexcept {
  if (type.kind == Kind::kReal) return *static_cast<const double*>(number) / scale;
  const std::int64_t value = IntegerAt(type, number);
  return type.is_signed ? static_cast<double>(value) : static_cast<double>(static_cast<std::uint64_t>(value));
}

}  // namespace

std::vector<Column> ColumnsOf(const Type& type) {
  std::vector<Column> columns;
  Append(columns, type, {}, 0, {});
  return columns;
}

double ReadColumn(const Column& column, const void* object) noexcept {
  const void* at = static_cast<const std::byte*>(object) + column.offset;
  if (column.type->kind != Kind::kOptional) return ReadNumber(*column.type, at, column.unit.scale);
  const void* value = column.type->optional_value(at);
  return value ? ReadNumber(*column.type->element, value, column.unit.scale) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace takt
