// Commands with one number made invalid.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "takt/core/describe.h"

namespace takt::engine {

template <typename Command>
struct Wrong {
  Command command;
  std::string_view field;
  std::string what;
};

// All reals of a command, one at a time, with every invalid value: not a number, infinite, outside its described range.
template <typename Command>
std::vector<Wrong<Command>> WrongVersionsOf(const Command& good) {
  std::vector<Wrong<Command>> all;
  std::visit(
      [&]<typename T>(const T& body) {
        for (const Field& field : TypeOf<T>().fields) {
          const bool optional = field.type->kind == Kind::kOptional;
          const Type& number = optional ? *field.type->element : *field.type;
          if (number.kind != Kind::kReal) continue;
          std::vector<double> values = {std::numeric_limits<double>::quiet_NaN(),
                                        std::numeric_limits<double>::infinity(),
                                        -std::numeric_limits<double>::infinity(), 1e300, -1e300};
          if (field.range.bounded_below()) values.push_back(field.range.min - 1);
          if (field.range.without_min) values.push_back(field.range.min);
          if (field.range.bounded_above()) values.push_back(field.range.max + 1);
          for (const double value : values) {
            T wrong = body;
            auto* const member = reinterpret_cast<std::byte*>(&wrong) + field.offset;
            void* const at = optional ? field.type->optional_emplace(member) : member;
            *static_cast<double*>(at) = value;
            all.push_back(
                {wrong, field.name,
                 std::string(TypeOf<T>().name) + "." + std::string(field.name) + " = " + std::to_string(value)});
          }
        }
      },
      good);
  return all;
}

}  // namespace takt::engine
