#include "takt/core/writer.h"

#include <algorithm>
#include <cstring>

#include "takt/core/scalar.h"

namespace takt {
namespace {

std::string QuotedText(std::string_view text) {
  constexpr std::string_view kHex = "0123456789ABCDEF";
  std::string out = "\"";
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<std::uint8_t>(text[i]);
    const auto next = i + 1 < text.size() ? static_cast<std::uint8_t>(text[i + 1]) : std::uint8_t{0};
    const auto escape = [&](std::uint8_t code) { out += {'\\', 'x', kHex[code >> 4], kHex[code & 15]}; };
    if (byte == '"' || byte == '\\') {
      out += {'\\', text[i]};
    } else if (byte < 0x20 || byte == 0x7F) {
      escape(byte);
    } else if (byte == 0xC2 && next >= 0x80 && next < 0xA0) {  // control characters in two bytes
      escape(next);
      ++i;
    } else if (text.substr(i).starts_with("\xE2\x80\xA8") ||
               text.substr(i).starts_with("\xE2\x80\xA9")) {  // other line breaks
      out += text[i + 2] == '\xA8' ? "\\u2028" : "\\u2029";
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out + "\"";
}

bool IsPlainWord(std::string_view text) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const auto allowed = [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '-' || c == '.' || c == '/'; };
  if (text == "y" || text == "Y" || text == "n" || text == "N") return false;  // yes and no in YAML 1.1
  return !text.empty() && letter(text.front()) && std::all_of(text.begin(), text.end(), allowed) && !NeedsQuotes(text);
}

std::string TextOf(std::string_view text) {
  return IsPlainWord(text) ? std::string(text) : QuotedText(text);
}

// Returns the value inside an optional, otherwise the value itself; null if it is empty.
const void* Inner(const Type*& type, const void* object) {
  while (object && type->kind == Kind::kOptional) {
    object = type->optional_value(object);
    type = type->element;
  }
  return object;
}

std::string ScalarText(const Type& type, const void* object, const Field* field) {
  switch (type.kind) {
    case Kind::kBool:
      return *static_cast<const bool*>(object) ? "true" : "false";
    case Kind::kInteger: {
      const std::int64_t value = IntegerAt(type, object);
      return type.is_signed ? std::to_string(value) : std::to_string(static_cast<std::uint64_t>(value));
    }
    case Kind::kReal:
      return FormatReal(Written(*static_cast<const double*>(object), field ? field->unit.scale : 1));
    case Kind::kEnum: {
      const Enumerator* enumerator = type.FindEnumerator(IntegerAt(type, object));
      return enumerator ? TextOf(enumerator->name) : std::to_string(IntegerAt(type, object));
    }
    default:
      return TextOf(std::string(type.text(object)));
  }
}

// Calls the function with each field that is written, and the type and address of its value.
template <typename Function>
void ForEachWritten(const Type& type, const void* object, Function function) {
  for (const Field& field : type.fields) {
    if (field.presence == Presence::kInternal) continue;
    const Type* inner = field.type;
    if (const void* value = Inner(inner, FieldAt(field, object))) function(field, *inner, value);
  }
}

std::string Flow(const Type& declared, const void* object, const Field* field) {
  const Type* type = &declared;
  object = Inner(type, object);
  if (!object) return "null";
  std::string text;
  if (type->kind == Kind::kStruct) {
    ForEachWritten(*type, object, [&](const Field& inner, const Type& inner_type, const void* value) {
      text.append(text.empty() ? "" : ", ").append(inner.name).append(": ").append(Flow(inner_type, value, &inner));
    });
    return "{" + text + "}";
  }
  if (type->kind == Kind::kArray || type->kind == Kind::kVector) {
    for (std::size_t i = 0; i < ElementCount(*type, object); ++i) {
      text.append(i == 0 ? "" : ", ").append(Flow(*type->element, ElementAt(*type, object, i), field));
    }
    return "[" + text + "]";
  }
  return ScalarText(*type, object, field);
}

bool HasWritten(const Type& type, const void* object) {
  bool any = false;
  ForEachWritten(type, object, [&](const Field&, const Type&, const void*) { any = true; });
  return any;
}

// Returns true if the value is written on its own lines: a mapping with keys, a list of mappings.
bool IsBlock(const Type& type, const void* object) {
  if (type.kind == Kind::kStruct) return HasWritten(type, object);
  const bool list = type.kind == Kind::kArray || type.kind == Kind::kVector;
  return list && type.element->kind == Kind::kStruct && ElementCount(type, object) > 0;
}

class BlockWriter {
 public:
  explicit BlockWriter(Comments comments) : comments_(comments) {}

  void Map(const Type& type, const void* object, std::size_t indent) {
    ForEachWritten(type, object, [&](const Field& field, const Type& inner, const void* value) {
      if (!at_dash_) text_.append(indent, ' ');
      at_dash_ = false;
      text_.append(field.name).append(":");
      if (!IsBlock(inner, value)) {
        text_.append(" ").append(Flow(inner, value, &field));
        if (comments_ == Comments::kUnits && !field.unit.text.empty()) text_.append("  # ").append(field.unit.text);
        text_ += "\n";
      } else if (inner.kind == Kind::kStruct) {
        text_ += "\n";
        Map(inner, value, indent + 2);
      } else {
        text_ += "\n";
        List(inner, value, indent + 2);
      }
    });
  }

  std::string& text() { return text_; }

 private:
  void List(const Type& type, const void* object, std::size_t indent) {
    for (std::size_t i = 0; i < ElementCount(type, object); ++i) {
      const void* element = ElementAt(type, object, i);
      text_.append(indent, ' ');
      if (!HasWritten(*type.element, element)) {
        text_ += "- {}\n";
        continue;
      }
      text_ += "- ";
      at_dash_ = true;
      Map(*type.element, element, indent + 2);
    }
  }

  Comments comments_;
  bool at_dash_ = false;  // the first key of a list element follows its dash
  std::string text_;
};

}  // namespace

std::string WriteYaml(const Type& type, const void* object, Comments comments) {
  if (!IsBlock(type, object) || type.kind != Kind::kStruct) return Flow(type, object, nullptr) + "\n";
  BlockWriter writer(comments);
  writer.Map(type, object, 0);
  return std::move(writer.text());
}

std::string WriteFlow(const Type& type, const void* object) {
  return Flow(type, object, nullptr);
}

}  // namespace takt
