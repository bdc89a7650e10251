// A list of up to N elements without heap memory: for lists inside commands, which pass to the cycle without
// allocation. Described like a list.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "takt/core/describe.h"

namespace takt {

template <typename T, std::size_t N>
struct InlineVector {
  static constexpr std::size_t kCapacity = N;

  std::array<T, N> items{};  // default values from index `count` on
  std::uint32_t count = 0;

  std::span<const T> all() const noexcept { return {items.data(), count}; }
  // Returns false if the list is full.
  bool Add(const T& item) noexcept {
    if (count == N) return false;
    items[count++] = item;
    return true;
  }
  bool operator==(const InlineVector&) const = default;
};

namespace internal {

template <typename T, std::size_t N>
struct TypeMaker<InlineVector<T, N>> {
  using List = InlineVector<T, N>;
  static Type Make() {
    Type type;
    type.kind = Kind::kVector;
    type.element = &TypeOf<T>();
    type.count = N;
    type.vector_size = [](const void* v) noexcept -> std::size_t { return static_cast<const List*>(v)->count; };
    type.vector_data = [](const void* v) noexcept -> const void* { return static_cast<const List*>(v)->items.data(); };
    type.vector_clear = [](void* v) { *static_cast<List*>(v) = List{}; };
    type.vector_append = [](void* v) -> void* {
      List& list = *static_cast<List*>(v);
      return list.count < N ? &list.items[list.count++] : nullptr;
    };
    return type;
  }
};

}  // namespace internal

}  // namespace takt
