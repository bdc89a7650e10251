#include "takt/core/schema.h"

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "takt/core/scalar.h"

namespace takt {
namespace {

using Json = nlohmann::ordered_json;

// Returns a bound as a whole number if it is one: 0, not 0.0.
Json BoundOf(double value) {
  if (value == std::floor(value) && std::abs(value) < 1e15) return static_cast<std::int64_t>(value);
  return value;
}

class SchemaMaker {
 public:
  Json Root(const Type& type) {
    Json root = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}};
    root.update(Struct(type, std::string(type.name)));
    if (!definitions_.empty()) root["$defs"] = definitions_;
    return root;
  }

 private:
  // `where`: the field that contains the value, "Axis.limits".
  Json Value(const Type& type, const Field& field, const std::string& where) {
    switch (type.kind) {
      case Kind::kBool:
        return {{"type", "boolean"}};
      case Kind::kInteger:
        return Number("integer", type, field);
      case Kind::kReal:
        return Number("number", type, field);
      case Kind::kString:
        return type.longest ? Json{{"type", "string"}, {"maxLength", type.longest}} : Json{{"type", "string"}};
      case Kind::kVector:
        return {{"type", "array"}, {"items", Value(*type.element, field, where)}};
      case Kind::kArray:
        return {{"type", "array"},
                {"items", Value(*type.element, field, where)},
                {"minItems", type.count},
                {"maxItems", type.count}};
      case Kind::kOptional:
        return {{"anyOf", Json::array({Value(*type.element, field, where), Json{{"type", "null"}}})}};
      default:
        return Reference(type, where);
    }
  }

  Json Number(const char* kind, const Type& type, const Field& field) {
    Json number = {{"type", kind}};
    if (field.range.bounded_below())
      number[field.range.without_min ? "exclusiveMinimum" : "minimum"] = BoundOf(field.range.min);
    if (field.range.bounded_above()) number["maximum"] = BoundOf(field.range.max);
    if (type.kind != Kind::kInteger) return number;
    const int bits = static_cast<int>(8 * type.size) - (type.is_signed ? 1 : 0);
    if (!field.range.bounded_below() && !type.is_signed) number["minimum"] = 0;
    if (!field.range.bounded_below() && type.is_signed && bits < 63) number["minimum"] = -(std::int64_t{1} << bits);
    if (!field.range.bounded_above() && bits < 63) number["maximum"] = (std::int64_t{1} << bits) - 1;
    return number;
  }

  // Types are distinguished by identity, since two of different namespaces may share their name: the second one is
  // named after the field that contains it.
  Json Reference(const Type& type, const std::string& where) {
    auto known = names_.find(&type);
    if (known == names_.end()) {
      const std::string own(type.name);
      const std::string& name = definitions_.contains(own) ? where : own;
      known = names_.emplace(&type, name).first;
      definitions_[name] = nullptr;  // keeps the order of first use
      Json definition = type.kind == Kind::kEnum ? Enum(type) : Struct(type, name);
      definitions_[name] = std::move(definition);
    }
    return {{"$ref", "#/$defs/" + known->second}};
  }

  Json Enum(const Type& type) {
    Json values = Json::array();
    for (const Enumerator& e : type.enumerators) values.push_back({{"const", e.name}, {"description", e.about}});
    return {{"description", type.about}, {"oneOf", std::move(values)}};
  }

  Json Struct(const Type& type, const std::string& name) {
    Json properties = Json::object();
    Json required = Json::array();
    for (const Field& field : type.fields) {
      if (field.presence == Presence::kInternal) continue;
      Json property = Value(*field.type, field, name + "." + std::string(field.name));
      std::string about(field.about);
      if (!field.unit.text.empty()) {
        about += " Unit: " + LongText(field.unit) + ".";
        property["x-unit"] = field.unit.text;
      }
      property["description"] = about;
      if (field.presence == Presence::kRequired) {
        required.push_back(field.name);
      } else {
        property["default"] = ToJson(*field.type, FieldAt(field, type.defaults), &field);
      }
      properties[std::string(field.name)] = std::move(property);
    }
    Json schema = {{"title", name}, {"description", type.about}, {"type", "object"}, {"additionalProperties", false}};
    schema["properties"] = std::move(properties);
    if (!required.empty()) schema["required"] = std::move(required);
    return schema;
  }

  Json definitions_ = Json::object();
  std::map<const Type*, std::string> names_;  // of the definitions
};

const char* PresenceText(Presence presence) {
  switch (presence) {
    case Presence::kRequired:
      return "required";
    case Presence::kDefaulted:
      return "defaulted";
    default:
      return "internal";
  }
}

Json FieldReference(const Type& type, const Field& field) {
  Json json = {{"name", field.name}, {"about", field.about}, {"presence", PresenceText(field.presence)}};
  if (!field.unit.text.empty()) json["unit"] = field.unit.text;
  if (!field.unit.meaning.empty()) json["unit_meaning"] = field.unit.meaning;
  if (field.range.bounded()) {
    Json range = Json::object();
    if (field.range.bounded_below()) range["min"] = BoundOf(field.range.min);
    if (field.range.bounded_above()) range["max"] = BoundOf(field.range.max);
    if (field.range.without_min) range["without_min"] = true;
    range["text"] = Text(field.range);
    json["range"] = std::move(range);
  }
  if (field.presence != Presence::kRequired)
    json["default"] = ToJson(*field.type, FieldAt(field, type.defaults), &field);
  json["type"] = ReferenceJson(*field.type);
  return json;
}

}  // namespace

Json JsonSchema(const Type& type) {
  return SchemaMaker().Root(type);
}

Json ReferenceJson(const Type& type) {
  switch (type.kind) {
    case Kind::kBool:
      return {{"kind", "bool"}};
    case Kind::kInteger:
      return {{"kind", "integer"}};
    case Kind::kReal:
      return {{"kind", "real"}};
    case Kind::kString:
      return {{"kind", "text"}};
    case Kind::kVector:
      return {{"kind", "list"}, {"element", ReferenceJson(*type.element)}};
    case Kind::kArray:
      return {{"kind", "list"}, {"element", ReferenceJson(*type.element)}, {"count", type.count}};
    case Kind::kOptional:
      return {{"kind", "optional"}, {"element", ReferenceJson(*type.element)}};
    case Kind::kEnum: {
      Json values = Json::array();
      for (const Enumerator& e : type.enumerators) values.push_back({{"name", e.name}, {"about", e.about}});
      return {{"kind", "enum"}, {"name", type.name}, {"about", type.about}, {"values", std::move(values)}};
    }
    case Kind::kVariant: {
      Json alternatives = Json::array();
      for (const Type* alternative : type.alternatives) alternatives.push_back(ReferenceJson(*alternative));
      return {{"kind", "variant"}, {"alternatives", std::move(alternatives)}};
    }
    case Kind::kStruct:
      break;
  }
  Json fields = Json::array(), rules = Json::array();
  for (const Field& field : type.fields) fields.push_back(FieldReference(type, field));
  for (const Rule& rule : type.rules) rules.push_back({{"field", type.fields[rule.field].name}, {"text", rule.text}});
  return {{"kind", "struct"},
          {"name", type.name},
          {"about", type.about},
          {"fields", std::move(fields)},
          {"rules", std::move(rules)}};
}

Json ToJson(const Type& type, const void* object, const Field* field) {
  switch (type.kind) {
    case Kind::kBool:
      return *static_cast<const bool*>(object);
    case Kind::kInteger:
      if (!type.is_signed) return static_cast<std::uint64_t>(IntegerAt(type, object));
      return IntegerAt(type, object);
    case Kind::kReal: {
      const double written = Written(*static_cast<const double*>(object), field ? field->unit.scale : 1);
      return std::isfinite(written) ? Json(written) : Json();
    }
    case Kind::kString:
      return type.text(object);
    case Kind::kEnum: {
      const Enumerator* enumerator = type.FindEnumerator(IntegerAt(type, object));
      return enumerator ? Json(enumerator->name) : Json();
    }
    case Kind::kOptional: {
      const void* value = type.optional_value(object);
      return value ? ToJson(*type.element, value, field) : Json();
    }
    case Kind::kVector:
    case Kind::kArray: {
      Json list = Json::array();
      for (std::size_t i = 0; i < ElementCount(type, object); ++i)
        list.push_back(ToJson(*type.element, ElementAt(type, object, i), field));
      return list;
    }
    case Kind::kVariant:
      return ToJson(*type.alternatives[type.variant_index(object)], type.variant_value(object), field);
    case Kind::kStruct:
      break;
  }
  Json json = Json::object();
  for (const Field& inner : type.fields) {
    if (inner.presence == Presence::kInternal) continue;
    const bool empty = inner.type->kind == Kind::kOptional && !inner.type->optional_value(FieldAt(inner, object));
    if (!empty) json[std::string(inner.name)] = ToJson(*inner.type, FieldAt(inner, object), &inner);
  }
  return json;
}

}  // namespace takt
