// The compile-time part of describe.h: names of members and types, and the number of members of an aggregate.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace takt::internal {

template <typename T>
struct TypeMaker;

template <typename T>
struct MemberPointer;
template <typename C, typename V>
struct MemberPointer<V C::*> {
  using Class = C;
  using Value = V;
};

// Returns the last identifier of the argument for `parameter` in the signature `pretty`.
constexpr std::string_view LastName(std::string_view pretty, std::string_view parameter) {
  pretty.remove_prefix(pretty.find(parameter) + parameter.size());
  pretty = pretty.substr(0, pretty.find_first_of(";]"));
  if (pretty.ends_with(')'))
    pretty.remove_suffix(1);  // GCC's (& Class::member); Clang has (anonymous namespace) before
  const std::size_t colon = pretty.rfind(':');
  return colon == std::string_view::npos ? pretty : pretty.substr(colon + 1);
}

template <auto Member>
constexpr std::string_view MemberName() {
  return LastName(__PRETTY_FUNCTION__, "Member = ");
}

template <typename Named>
constexpr std::string_view TypeName() {
  return LastName(__PRETTY_FUNCTION__, "Named = ");
}

// Convertible to the type of any member. An optional accepts its value's type as well, which would make the conversion
// ambiguous: it has a placeholder of its own.
struct Anything {
  template <typename T>
  operator T() const;
};
struct AnyOptional {
  template <typename T>
  operator std::optional<T>() const;
};

// Adds placeholders until the aggregate accepts no more of them.
template <typename T, typename... Placeholders>
constexpr std::size_t Arity() {
  if constexpr (requires { T{Placeholders{}..., Anything{}}; }) {
    return Arity<T, Placeholders..., Anything>();
  } else if constexpr (requires { T{Placeholders{}..., AnyOptional{}}; }) {
    return Arity<T, Placeholders..., AnyOptional>();
  } else {
    return sizeof...(Placeholders);
  }
}

}  // namespace takt::internal
