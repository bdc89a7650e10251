#include "takt/core/binder.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <utility>

namespace takt {
namespace {

using Bits = std::array<std::uint64_t, kMaxFields / 64>;

bool Has(const Bits& bits, std::size_t index) {
  return bits[index / 64] >> index % 64 & 1;
}
void Set(Bits& bits, std::size_t index) {
  bits[index / 64] |= std::uint64_t{1} << index % 64;
}

std::size_t IndexOf(const Type& type, const Field& field) {
  return static_cast<std::size_t>(&field - type.fields.data());
}

std::vector<std::string_view> KnownKeys(const Type& type) {
  std::vector<std::string_view> keys;
  for (const Field& field : type.fields) {
    if (field.presence != Presence::kInternal) keys.push_back(field.name);
  }
  return keys;
}

std::string Listed(const std::vector<std::string_view>& words) {
  std::string text;
  for (const std::string_view word : words) text += (text.empty() ? "" : ", ") + std::string(word);
  return text;
}

// Returns the number at the start of a text, as in "500 mm/s" or "90deg"; empty if there is none or nothing follows it.
std::string_view LeadingNumber(std::string_view text) {
  double unused = 0;
  for (std::size_t length = text.size() - 1; length > 0; --length) {
    const std::string_view number = text.substr(0, length);
    if (ParseReal(number, unused) == NumberError::kNone) return number;
  }
  return {};
}

// Returns true for "500 mm/s": a number, followed by something like a unit.
bool HasUnit(std::string_view text) {
  if (text.empty() || text.size() > 40 || text.starts_with("0x")) return false;
  const std::string_view number = LeadingNumber(text);
  if (number.empty()) return false;
  std::string_view rest = text.substr(number.size());
  rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
  if (rest.empty()) return false;
  const auto c = static_cast<unsigned char>(rest.front());
  return std::isalpha(c) || c == '%' || c == '"' || c >= 0x80 || (c == '1' && rest.starts_with("1/"));
}

// Returns true if the end of a key ("_mm_s", " [deg]") is a unit.
bool IsUnitSuffix(std::string_view suffix) {
  if (suffix.empty() || std::string_view("_ [(/.").find(suffix.front()) == std::string_view::npos) return false;
  std::string letters;
  for (const char c : suffix) {
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '%')
      letters += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  constexpr std::array<std::string_view, 33> kUnits{
      "u",   "us",  "us2",  "us3",   "mm",    "mms", "mms2", "mms3",    "m",   "ms",  "ms2",
      "ms3", "deg", "degs", "degs2", "degs3", "rad", "rads", "rads2",   "s",   "min", "h",
      "hz",  "v",   "mv",   "nm",    "n",     "kg",  "%",    "percent", "rpm", "cm",  "um"};
  return std::find(kUnits.begin(), kUnits.end(), letters) != kUnits.end();
}

bool FitsInteger(const Type& type, const Integer& value) {
  const std::size_t bits = 8 * type.size - (type.is_signed ? 1 : 0);
  const std::uint64_t largest = bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
  if (!value.negative) return value.magnitude <= largest;
  return type.is_signed && value.magnitude <= largest + 1;
}

void StoreInteger(const Type& type, void* object, std::uint64_t bits) {
  std::memcpy(object, &bits, type.size);
}

}  // namespace

std::string Binder::Path() const {
  std::string path;
  for (std::size_t i = 0; i < depth_; ++i) {
    const Frame& frame = frames_[i];
    if (frame.type->kind != Kind::kStruct) {
      path.append("[").append(std::to_string(frame.index)).append("]");
    } else if (frame.field) {
      path.append(path.empty() ? "" : ".").append(frame.field->name);
    }
  }
  return path;
}

void Binder::Scalar(Place place, std::string_view text, bool quoted) {
  if (skipped_ > 0) return;
  if (InMap() && !Top().has_key) return Key(place, text);
  const Slot slot = Next(place);
  if (slot.type) Read(slot, place, text, quoted);
  Done();
}

void Binder::Null(Place place) {
  if (skipped_ > 0) return;
  if (InMap() && !Top().has_key) return UnknownKey(place, "");
  const Slot slot = Next(place);
  if (slot.type && slot.type->kind == Kind::kOptional) {
    slot.type->optional_reset(slot.object);
  } else if (slot.type) {
    Mismatch(place, slot, "nothing");
  }
  Done();
}

void Binder::Refuse(Place place, std::string message) {
  if (skipped_ > 0) return;
  if (InMap() && !Top().has_key) {
    Top().field = nullptr;
    Top().has_key = true;
    problems_.Add(place, Path(), std::move(message));
    return;
  }
  static_cast<void>(Next(place));
  problems_.Add(place, Path(), std::move(message));
  Done();
}

bool Binder::BeginMap(Place place) {
  return Begin(place, true);
}
bool Binder::BeginList(Place place) {
  return Begin(place, false);
}

bool Binder::Begin(Place place, bool map) {
  if (static_cast<int>(depth_) + skipped_ >= kMaxDepth) {
    problems_.Add(place, Path(),
                  "expected at most " + std::to_string(kMaxDepth) + " levels of mappings and lists, found more");
    return false;
  }
  if (skipped_ > 0) {
    ++skipped_;
    return true;
  }
  if (InMap() && !Top().has_key) {
    problems_.Add(place, Path(), std::string("expected a plain word as key, found ") + (map ? "a mapping" : "a list"));
    Top().field = nullptr;
    Top().has_key = true;
    // The brackets of the key are one extra event: their content is skipped, then the value follows.
    skipped_ = 1;
    skipped_key_ = true;
    return true;
  }
  Slot slot = Next(place);
  if (slot.type && slot.type->kind == Kind::kOptional) {
    slot.object = slot.type->optional_emplace(slot.object);
    slot.type = slot.type->element;
  }
  const bool fits = slot.type && (map ? slot.type->kind == Kind::kStruct
                                      : slot.type->kind == Kind::kArray || slot.type->kind == Kind::kVector);
  if (!fits) {
    if (slot.type) Mismatch(place, slot, map ? "a mapping" : "a list");
    skipped_ = 1;
    return true;
  }
  Frame& frame = frames_[depth_];
  frame.type = slot.type;
  frame.object = slot.object;
  frame.start = place;
  frame.problems_before = problems_.size();
  frame.has_key = false;
  frame.field = nullptr;
  frame.given = {};
  frame.excused = {};
  frame.quantity = slot.field;
  frame.index = 0;
  if (slot.type->kind == Kind::kVector) slot.type->vector_clear(slot.object);
  if (names_[depth_]) names_[depth_]->clear();
  ++depth_;
  return true;
}

void Binder::EndMap() {
  if (skipped_ > 0) return EndSkipped();
  CheckComplete(Top());
  --depth_;
  Done();
}

void Binder::EndList() {
  if (skipped_ > 0) return EndSkipped();
  const Frame& frame = Top();
  --depth_;
  if (frame.type->kind == Kind::kArray && frame.index < frame.type->count) {
    problems_.Add(frame.start, Path(),
                  "expected " + Expectation(*frame.type, frame.quantity) + ", found " + std::to_string(frame.index));
  }
  Done();
}

void Binder::EndSkipped() {
  if (--skipped_ > 0) return;
  if (!std::exchange(skipped_key_, false)) Done();
}

void Binder::CheckComplete(Frame& frame) {
  const Type& type = *frame.type;
  for (std::size_t i = 0; i < type.fields.size(); ++i) {
    const Field& field = type.fields[i];
    if (field.presence != Presence::kRequired || Has(frame.given, i) || Has(frame.excused, i)) continue;
    frame.field = &field;
    problems_.Add(frame.start, Path(),
                  "expected this key with " + Expectation(*field.type, &field) + ", found nothing");
  }
  frame.field = nullptr;
  if (problems_.size() != frame.problems_before) return;
  for (std::size_t i = 0; i < type.rules.size(); ++i) {
    const Rule& rule = type.rules[i];
    if (rule.holds(frame.object)) continue;
    frame.field = &type.fields[rule.field];
    problems_.Add(Has(frame.given, rule.field) ? frame.rule_places[i] : frame.start, Path(), std::string(rule.text));
  }
  frame.field = nullptr;
}

void Binder::Key(Place place, std::string_view text) {
  Frame& frame = Top();
  const Field* field = frame.type->FindField(text);
  if (!field || field->presence == Presence::kInternal) return UnknownKey(place, text);
  frame.has_key = true;
  frame.field = field;
  const std::size_t index = IndexOf(*frame.type, *field);
  if (Has(frame.given, index)) {
    problems_.Add(place, Path(), "expected each key once, found it again");
    frame.field = nullptr;
  }
  Set(frame.given, index);
}

void Binder::UnknownKey(Place place, std::string_view text) {
  Frame& frame = Top();
  frame.field = nullptr;
  frame.has_key = true;
  const std::string found = ", found " + Quoted(text);
  if (text == "<<")
    return problems_.Add(place, Path(), "expected a key, found '<<'; write the values out, nothing can be merged in");

  const Type& type = *frame.type;
  if (const Field* glued = type.FindField(text.substr(0, text.find(':')));
      glued && glued->presence != Presence::kInternal) {
    Set(frame.excused, IndexOf(type, *glued));
    return problems_.Add(place, Path(), "expected a blank behind the colon" + found);
  }
  for (const Field& field : type.fields) {
    if (field.presence == Presence::kInternal || !text.starts_with(field.name) ||
        !IsUnitSuffix(text.substr(field.name.size())))
      continue;
    Set(frame.excused, IndexOf(type, field));
    return problems_.Add(place, Path(),
                         "expected the key " + std::string(field.name) + " without a unit" + found + "; it takes " +
                             Expectation(*field.type, &field));
  }
  const std::vector<std::string_view> known = KnownKeys(type);
  const std::string_view nearest = Nearest(text, known);
  if (known.empty()) {
    problems_.Add(place, Path(), "expected no key" + found);
  } else if (nearest.empty()) {
    problems_.Add(place, Path(), "expected one of the keys " + Listed(known) + found);
  } else {
    Set(frame.excused, IndexOf(type, *type.FindField(nearest)));
    problems_.Add(place, Path(), "expected a known key" + found + "; did you mean " + std::string(nearest) + "?");
  }
}

Binder::Slot Binder::Next(Place place) {
  Slot slot;
  if (depth_ == 0) {
    if (!root_done_) slot = {&root_type_, root_object_, nullptr};
  } else if (Frame& frame = Top(); frame.type->kind == Kind::kStruct) {
    if (!frame.field) return {};
    const Type& type = *frame.type;
    slot = {frame.field->type, static_cast<std::byte*>(frame.object) + frame.field->offset, frame.field};
    for (std::size_t i = 0; i < type.rules.size(); ++i) {
      if (&type.fields[type.rules[i].field] == frame.field) frame.rule_places[i] = place;
    }
  } else if (const Type& type = *frame.type; type.kind == Kind::kVector) {
    void* const element = type.vector_append(frame.object);
    if (!element) {
      if (frame.index == type.count)
        problems_.Add(place, Path(), "expected " + Expectation(type, frame.quantity) + ", found more");
      return {};
    }
    slot = {type.element, element, frame.quantity};
  } else if (frame.index < type.count) {
    slot = {type.element, static_cast<std::byte*>(frame.object) + frame.index * type.element->size, frame.quantity};
  } else {
    if (frame.index == type.count)
      problems_.Add(place, Path(), "expected " + Expectation(type, frame.quantity) + ", found more");
    return {};
  }
  if (places_ && slot.type) places_->Add(Path(), place);
  return slot;
}

void Binder::Done() {
  if (depth_ == 0) {
    root_done_ = true;
  } else if (Frame& frame = Top(); frame.type->kind == Kind::kStruct) {
    frame.has_key = false;
    frame.field = nullptr;
  } else {
    ++frame.index;
  }
}

void Binder::Read(const Slot& slot, Place place, std::string_view text, bool quoted) {
  const Type& type = *slot.type;
  const std::string_view word = text;
  switch (type.kind) {
    case Kind::kBool:
      if (quoted || (word != "true" && word != "false"))
        return Mismatch(place, slot, quoted ? "text " + Quoted(text) : Quoted(text));
      *static_cast<bool*>(slot.object) = word == "true";
      return;
    case Kind::kInteger:
    case Kind::kReal:
      if (quoted && !HasUnit(text)) return Mismatch(place, slot, "text " + Quoted(text));
      return type.kind == Kind::kReal ? ReadReal(slot, place, text) : ReadInteger(slot, place, text);
    case Kind::kString:
      if (!quoted && NeedsQuotes(text)) {
        problems_.Add(
            place, Path(),
            "expected text, found " + Quoted(text) + ", which is not read as text; write it in double quotes");
        return;
      }
      if (!type.set_text(slot.object, text)) {
        problems_.Add(place, Path(),
                      "expected at most " + std::to_string(type.longest) + " bytes, found " + Quoted(text));
        return;
      }
      if (slot.field && slot.field->name == "name") CheckName(place, text);
      return;
    case Kind::kEnum: {
      const Enumerator* enumerator = type.FindEnumerator(text);
      if (!enumerator) {
        std::vector<std::string_view> names;
        for (const Enumerator& e : type.enumerators) names.push_back(e.name);
        problems_.Add(
            place, Path(),
            "expected " + Expectation(type, slot.field) + ", found " + Quoted(text) + DidYouMean(text, names));
        return;
      }
      return StoreInteger(type, slot.object, static_cast<std::uint64_t>(enumerator->value));
    }
    case Kind::kOptional:
      return Read({type.element, type.optional_emplace(slot.object), slot.field}, place, text, quoted);
    default:
      return Mismatch(place, slot, Quoted(text));
  }
}

void Binder::ReadReal(const Slot& slot, Place place, std::string_view text) {
  double written = 0;
  const NumberError error = ParseReal(text, written);
  if (error != NumberError::kNone) return BadNumber(place, slot, text, error);
  if (slot.field && !slot.field->range.Holds(written)) return Mismatch(place, slot, std::string(text));
  *static_cast<double*>(slot.object) = slot.field ? written * slot.field->unit.scale : written;
}

void Binder::ReadInteger(const Slot& slot, Place place, std::string_view text) {
  Integer value;
  NumberError error = ParseInteger(text, value);
  if (error == NumberError::kNone && !FitsInteger(*slot.type, value)) error = NumberError::kTooLarge;
  if (error != NumberError::kNone) return BadNumber(place, slot, text, error);
  const double magnitude = static_cast<double>(value.magnitude);
  if (slot.field && !slot.field->range.Holds(value.negative ? -magnitude : magnitude))
    return Mismatch(place, slot, std::string(text));
  StoreInteger(*slot.type, slot.object, value.negative ? ~value.magnitude + 1 : value.magnitude);
}

void Binder::Mismatch(Place place, const Slot& slot, const std::string& found) {
  problems_.Add(place, Path(), "expected " + Expectation(*slot.type, slot.field) + ", found " + found);
}

void Binder::BadNumber(Place place, const Slot& slot, std::string_view text, NumberError error) {
  const Field bare{};
  const Field& field = slot.field ? *slot.field : bare;
  const bool real = slot.type->kind == Kind::kReal;
  const std::string unit = field.unit.text.empty() ? "" : " in " + LongText(field.unit);
  if (HasUnit(text)) {
    return problems_.Add(place, Path(),
                         std::string("expected a ") + (real ? "" : "whole ") + "number" + unit +
                             " without the unit, found " + Quoted(text));
  }
  switch (error) {
    case NumberError::kNotFinite:
      return problems_.Add(place, Path(), "expected a finite number" + unit + ", found " + Quoted(text));
    case NumberError::kLeadingZero:
      return problems_.Add(place, Path(), "expected a number" + unit + " without leading zeros, found " + Quoted(text));
    case NumberError::kTooLarge:
      if (real)
        return problems_.Add(place, Path(),
                             "expected a number" + unit + " between 1e-307 and 1e308, found " + Quoted(text));
      [[fallthrough]];
    default:
      return Mismatch(place, slot, Quoted(text));
  }
}

void Binder::CheckName(Place place, std::string_view name) {
  if (depth_ < 2 || frames_[depth_ - 2].type->kind != Kind::kVector) return;
  if (name.empty()) return;  // unnamed
  auto& names = names_[depth_ - 2];
  if (!names) names = std::make_unique<Names>();
  const auto [first, is_new] = names->try_emplace(std::string(name), frames_[depth_ - 2].index);
  if (is_new) return;
  problems_.Add(
      place, Path(),
      "expected each name once, found " + Quoted(name) + " again, first in [" + std::to_string(first->second) + "]");
}

}  // namespace takt
