#include "takt/core/verify.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "takt/core/scalar.h"

namespace takt {
namespace {

class Verifier {
 public:
  void Check(const Type& type) {
    if (!seen_.insert(&type).second) return;
    if (type.element) Check(*type.element);
    for (const Type* alternative : type.alternatives) Check(*alternative);
    if (type.kind == Kind::kEnum) CheckEnum(type);
    if (type.kind == Kind::kStruct) CheckStruct(type);
  }
  std::vector<std::string>& faults() { return faults_; }

 private:
  void Fault(const Type& type, std::string_view member, const std::string& what) {
    faults_.push_back(std::string(type.name) + (member.empty() ? "" : ".") + std::string(member) + ": " + what);
  }

  void CheckEnum(const Type& type) {
    if (type.about.empty()) Fault(type, {}, "says nothing about itself");
    if (type.enumerators.empty()) Fault(type, {}, "has no values");
    std::set<std::string_view> names;
    std::set<std::int64_t> values;
    for (const Enumerator& e : type.enumerators) {
      if (e.about.empty()) Fault(type, e.name, "says nothing about itself");
      if (NeedsQuotes(e.name)) Fault(type, e.name, "YAML does not read this name as text");
      if (!names.insert(e.name).second) Fault(type, e.name, "the name is there twice");
      if (!values.insert(e.value).second) Fault(type, e.name, "the value is there twice");
    }
  }

  void CheckStruct(const Type& type) {
    if (type.about.empty()) Fault(type, {}, "says nothing about itself");
    if (type.fields.size() != type.arity) {
      Fault(type, {},
            "describes " + std::to_string(type.fields.size()) + " of " + std::to_string(type.arity) + " members");
    }
    for (const Field& field : type.fields) {
      if (field.about.empty()) Fault(type, field.name, "says nothing about itself");
      if (NeedsQuotes(field.name)) Fault(type, field.name, "YAML does not read this name as text");
      if (field.type->kind == Kind::kVariant && field.presence != Presence::kInternal) {
        Fault(type, field.name, "a variant is of state only");
      }
      if (field.presence == Presence::kDefaulted) CheckDefault(type, field, *field.type, FieldAt(field, type.defaults));
      Check(*field.type);
    }
    const bool all_defaulted = std::none_of(type.fields.begin(), type.fields.end(),
                                            [](const Field& f) { return f.presence == Presence::kRequired; });
    for (const Rule& rule : type.rules) {
      if (all_defaulted && !rule.holds(type.defaults))
        Fault(type, type.fields[rule.field].name, "the default breaks its rule");
    }
  }

  void CheckDefault(const Type& type, const Field& field, const Type& value_type, const void* value) {
    switch (value_type.kind) {
      case Kind::kReal:
        return CheckNumber(type, field, Written(*static_cast<const double*>(value), field.unit.scale));
      case Kind::kInteger:
        return CheckNumber(type, field, static_cast<double>(IntegerAt(value_type, value)));
      case Kind::kEnum:
        if (!value_type.FindEnumerator(IntegerAt(value_type, value)))
          Fault(type, field.name, "the default is none of its values");
        return;
      case Kind::kOptional:
        if (const void* inner = value_type.optional_value(value)) CheckDefault(type, field, *value_type.element, inner);
        return;
      case Kind::kArray:
      case Kind::kVector:
        for (std::size_t i = 0; i < ElementCount(value_type, value); ++i) {
          CheckDefault(type, field, *value_type.element, ElementAt(value_type, value, i));
        }
        return;
      default:
        return;
    }
  }

  void CheckNumber(const Type& type, const Field& field, double written) {
    if (!std::isfinite(written)) {
      Fault(type, field.name, "the default is not finite; an optional says that there is none");
    } else if (!field.range.Holds(written)) {
      Fault(type, field.name, "the default " + FormatReal(written) + " is not " + Text(field.range));
    }
  }

  std::set<const Type*> seen_;
  std::vector<std::string> faults_;
};

}  // namespace

std::vector<std::string> Verify(const Type& type) {
  Verifier verifier;
  verifier.Check(type);
  return std::move(verifier.faults());
}

}  // namespace takt
