#include "takt/core/hash.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <cstring>

namespace takt {
namespace {

constexpr std::size_t kMostUnrolledSteps = 64;

const void* Shift(const void* object, std::size_t offset) noexcept {
  return static_cast<const std::byte*>(object) + offset;
}

bool IsPlain(const Type& type) {
  return type.kind == Kind::kBool || type.kind == Kind::kInteger || type.kind == Kind::kReal ||
         type.kind == Kind::kEnum;
}

// Returns true if the object consists of described bytes only, without padding.
bool IsDense(const Type& type) {
  return type.hash_steps.size() == 1 && !type.hash_steps[0].type && type.hash_steps[0].bytes == type.size;
}

void Append(std::vector<HashStep>& steps, HashStep step) {
  if (!steps.empty() && !step.type && !steps.back().type && steps.back().offset + steps.back().bytes == step.offset) {
    steps.back().bytes += step.bytes;
  } else {
    steps.push_back(step);
  }
}

void AppendValue(std::vector<HashStep>& steps, std::size_t offset, const Type& type) {
  const auto append_inner = [&](const Type& inner, std::size_t at) {
    for (const HashStep& step : inner.hash_steps) Append(steps, {at + step.offset, step.bytes, step.type});
  };
  if (IsDense(type)) {
    Append(steps, {offset, type.size, nullptr});
  } else if (type.kind == Kind::kStruct) {
    append_inner(type, offset);
  } else if (type.kind == Kind::kArray && type.count * type.element->hash_steps.size() <= kMostUnrolledSteps &&
             type.element->kind == Kind::kStruct) {
    for (std::size_t i = 0; i < type.count; ++i) append_inner(*type.element, offset + i * type.element->size);
  } else {
    Append(steps, {offset, 0, &type});
  }
}

std::uint64_t Mix(std::uint64_t hash, std::uint64_t value) noexcept {
  hash = (hash ^ value) * 0x9E3779B97F4A7C15u;
  return hash ^ hash >> 32;
}

std::uint64_t HashElements(const Type& type, const void* list, std::uint64_t hash) noexcept {
  const std::size_t count = ElementCount(type, list);
  hash = Mix(hash, count);
  if (count == 0) return hash;
  const void* data = ElementAt(type, list, 0);
  if (IsDense(*type.element)) return XXH3_64bits_withSeed(data, count * type.element->size, hash);
  for (std::size_t i = 0; i < count; ++i) hash = HashOf(*type.element, Shift(data, i * type.element->size), hash);
  return hash;
}

bool EqualElements(const Type& type, const void* a, const void* b) noexcept {
  const std::size_t count = ElementCount(type, a);
  if (count != ElementCount(type, b)) return false;
  for (std::size_t i = 0; i < count; ++i) {
    if (!Equal(*type.element, ElementAt(type, a, i), ElementAt(type, b, i))) return false;
  }
  return true;
}

}  // namespace

namespace internal {

void MakeHashSteps(Type& type) {
  if (IsPlain(type)) {
    type.hash_steps = {{0, type.size, nullptr}};
  } else if (type.kind == Kind::kArray && IsDense(*type.element)) {
    type.hash_steps = {{0, type.size, nullptr}};
  } else if (type.kind == Kind::kStruct) {
    std::vector<const Field*> fields;
    for (const Field& field : type.fields) fields.push_back(&field);
    std::sort(fields.begin(), fields.end(), [](auto a, auto b) { return a->offset < b->offset; });
    for (const Field* field : fields) AppendValue(type.hash_steps, field->offset, *field->type);
  }
}

}  // namespace internal

std::uint64_t HashOf(const Type& type, const void* object, std::uint64_t seed) noexcept {
  switch (type.kind) {
    case Kind::kString: {
      const std::string_view text = type.text(object);
      return XXH3_64bits_withSeed(text.data(), text.size(), Mix(seed, text.size()));
    }
    case Kind::kOptional: {
      const void* value = type.optional_value(object);
      return value ? HashOf(*type.element, value, Mix(seed, 1)) : Mix(seed, 0);
    }
    case Kind::kVariant: {
      const std::size_t index = type.variant_index(object);
      return HashOf(*type.alternatives[index], type.variant_value(object), Mix(seed, index));
    }
    case Kind::kVector:
    case Kind::kArray:
      return HashElements(type, object, seed);
    default:
      for (const HashStep& step : type.hash_steps) {
        const void* at = Shift(object, step.offset);
        seed = step.type ? HashOf(*step.type, at, seed) : XXH3_64bits_withSeed(at, step.bytes, seed);
      }
      return seed;
  }
}

bool Equal(const Type& type, const void* a, const void* b) noexcept {
  switch (type.kind) {
    case Kind::kString:
      return type.text(a) == type.text(b);
    case Kind::kOptional: {
      const void* value_a = type.optional_value(a);
      const void* value_b = type.optional_value(b);
      return value_a && value_b ? Equal(*type.element, value_a, value_b) : value_a == value_b;
    }
    case Kind::kVariant: {
      const std::size_t index = type.variant_index(a);
      return index == type.variant_index(b) &&
             Equal(*type.alternatives[index], type.variant_value(a), type.variant_value(b));
    }
    case Kind::kVector:
    case Kind::kArray:
      return EqualElements(type, a, b);
    default:
      return std::all_of(type.hash_steps.begin(), type.hash_steps.end(), [&](const HashStep& step) {
        const void* at_a = Shift(a, step.offset);
        const void* at_b = Shift(b, step.offset);
        return step.type ? Equal(*step.type, at_a, at_b) : std::memcmp(at_a, at_b, step.bytes) == 0;
      });
  }
}

}  // namespace takt
