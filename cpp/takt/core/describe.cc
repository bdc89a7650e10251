#include "takt/core/describe.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace takt {

const Field* Type::FindField(std::string_view field_name) const noexcept {
  const auto found = std::find_if(fields.begin(), fields.end(), [&](const Field& f) { return f.name == field_name; });
  return found == fields.end() ? nullptr : &*found;
}

const Enumerator* Type::FindEnumerator(std::string_view enumerator_name) const noexcept {
  const auto found = std::find_if(enumerators.begin(), enumerators.end(),
                                  [&](const Enumerator& e) { return e.name == enumerator_name; });
  return found == enumerators.end() ? nullptr : &*found;
}

const Enumerator* Type::FindEnumerator(std::int64_t value) const noexcept {
  const auto found =
      std::find_if(enumerators.begin(), enumerators.end(), [&](const Enumerator& e) { return e.value == value; });
  return found == enumerators.end() ? nullptr : &*found;
}

std::int64_t IntegerAt(const Type& type, const void* object) noexcept {
  std::uint64_t bits = 0;
  std::memcpy(&bits, object, type.size);  // little-endian
  const std::size_t unused = 64 - 8 * type.size;
  const auto value = static_cast<std::int64_t>(bits << unused);
  return type.is_signed ? value >> unused : static_cast<std::int64_t>(static_cast<std::uint64_t>(value) >> unused);
}

std::string LongText(const Unit& unit) {
  std::string text(unit.text);
  if (!unit.meaning.empty()) text += " (" + std::string(unit.meaning) + ")";
  return text;
}

namespace internal {
namespace {

// A wrong description is a programming error: the program aborts at first use, which every test triggers.
[[noreturn]] void Reject(std::string_view field, const char* why) {
  std::fprintf(stderr, "takt: description of %.*s: %s\n", static_cast<int>(field.size()), field.data(), why);
  std::abort();
}

}  // namespace

void AddField(Type& type, const Field& field) {
  if (type.fields.size() == kMaxFields) Reject(field.name, "too many fields");
  if (type.FindField(field.name)) Reject(field.name, "described twice");
  type.fields.push_back(field);
}

void AddRule(Type& type, std::string_view field, std::string_view text, bool (*holds)(const void*)) {
  const Field* found = type.FindField(field);
  if (!found) Reject(field, "a rule must come behind its field");
  if (type.rules.size() == kMaxRules) Reject(field, "too many rules");
  type.rules.push_back({static_cast<std::size_t>(found - type.fields.data()), text, holds});
}

}  // namespace internal
}  // namespace takt
