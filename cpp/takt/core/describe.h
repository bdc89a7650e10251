// Descriptions: a table for every struct that users configure, command or record, filled by one function beside the
// struct. Readers, writers, the schema, the reference pages, equality and hash are plain code that iterates over the
// table.
//
//   struct MoveAbsolute { double position = 0, velocity = 0; Direction direction = Direction::kCurrent; };  // header
//   void describe(Description<MoveAbsolute>&);
//
//   void describe(Description<MoveAbsolute>& d) {                                                           // .cc
//     using M = MoveAbsolute;
//     d.about("Moves an axis to an absolute position.");
//     d.required<&M::position>(unit::u, "Where to stop.");
//     d.required<&M::velocity>(unit::u_s, positive, "Largest speed on the way.");
//     d.defaulted<&M::direction>("Sense of travel.");
//   }
//
// A described struct is an aggregate whose members are bool, integers, double, std::string, Name, described enums and
// structs, or std::array, std::vector, InlineVector, std::optional of these; of state (internal members) also
// std::variant. Texts are literals: the tables keep views of them. A wrong description (a member twice, a rule before
// its member) aborts the process at its first use.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "takt/core/describe_fwd.h"
#include "takt/core/describe_internal.h"
#include "takt/core/name.h"
#include "takt/core/unit.h"

namespace takt {

struct Type;

enum class Kind : std::uint8_t {
  kBool,
  kInteger,
  kReal,
  kString,
  kEnum,
  kStruct,
  kArray,
  kVector,
  kOptional,
  kVariant
};

enum class Presence : std::uint8_t {
  kRequired,   // must be given
  kDefaulted,  // may be given; otherwise the struct's own initialiser applies
  kInternal,   // state: hashed, compared and in the reference, never read from text
};

struct Field {
  std::string_view name;
  std::string_view about;
  Presence presence = Presence::kDefaulted;
  Unit unit;    // of the number, or of the numbers in the list or optional
  Range range;  // likewise, in written units
  std::size_t offset = 0;
  const Type* type = nullptr;
};

struct Enumerator {
  std::int64_t value = 0;
  std::string_view name;  // as in YAML and Python
  std::string_view about;
};

// A condition on several fields, reported at one of them.
struct Rule {
  std::size_t field = 0;  // index into Type::fields
  std::string_view text;  // "must lie above lower"
  bool (*holds)(const void* object) = nullptr;
};

// A piece of an object for the hash: bytes without padding, or (`type` set) a value that is hashed through its type.
struct HashStep {
  std::size_t offset = 0;
  std::size_t bytes = 0;
  const Type* type = nullptr;
};

struct Type {
  Kind kind = Kind::kStruct;
  std::string_view name;   // of the struct or enum, without namespace
  std::string_view about;  // of the struct or enum
  std::size_t size = 0;    // [bytes]
  bool is_signed = false;  // integers only

  // Structs.
  std::vector<Field> fields;
  std::vector<Rule> rules;
  std::size_t arity = 0;           // number of members of the struct, described or not
  const void* defaults = nullptr;  // a default-initialised object

  std::vector<Enumerator> enumerators;

  // Texts.
  std::string_view (*text)(const void* object) noexcept = nullptr;
  bool (*set_text)(void* object, std::string_view text) = nullptr;  // returns false if the text is too long
  std::size_t longest = 0;                                          // [bytes]; 0: any length

  // Arrays, vectors, optionals.
  const Type* element = nullptr;
  std::size_t count = 0;  // of arrays; of vectors: capacity, 0: unlimited
  // Vectors. Elements are contiguous, element->size bytes apart.
  std::size_t (*vector_size)(const void* vector) noexcept = nullptr;
  const void* (*vector_data)(const void* vector) noexcept = nullptr;
  void (*vector_clear)(void* vector) = nullptr;
  void* (*vector_append)(void* vector) = nullptr;  // appends a default element and returns its address; null: no room
  // Optionals.
  const void* (*optional_value)(const void* optional) noexcept = nullptr;  // null: empty
  void (*optional_reset)(void* optional) = nullptr;
  void* (*optional_emplace)(void* optional) = nullptr;  // makes a default value and returns its address
  // Variants: in state only.
  std::vector<const Type*> alternatives;
  std::size_t (*variant_index)(const void* variant) noexcept = nullptr;
  const void* (*variant_value)(const void* variant) noexcept = nullptr;

  std::vector<HashStep> hash_steps;

  // Each returns null if there is none.
  const Field* FindField(std::string_view field_name) const noexcept;
  const Enumerator* FindEnumerator(std::string_view enumerator_name) const noexcept;
  const Enumerator* FindEnumerator(std::int64_t value) const noexcept;
};

// Returns the table of a type. It is made at first use, which allocates: touch every type once, before the first cycle.
template <typename T>
const Type& TypeOf();

// Limits of a described struct, so that reading needs no further memory.
inline constexpr std::size_t kMaxFields = 256;
inline constexpr std::size_t kMaxRules = 16;

// Returns the address of element `index` of an array or vector.
inline const void* ElementAt(const Type& type, const void* list, std::size_t index) noexcept {
  const void* data = type.kind == Kind::kVector ? type.vector_data(list) : list;
  return static_cast<const std::byte*>(data) + index * type.element->size;
}
// Returns the number of elements of an array or vector.
inline std::size_t ElementCount(const Type& type, const void* list) noexcept {
  return type.kind == Kind::kVector ? type.vector_size(list) : type.count;
}
inline const void* FieldAt(const Field& field, const void* object) noexcept {
  return static_cast<const std::byte*>(object) + field.offset;
}
// Returns the value of a bool, integer or enum; unsigned 64-bit values as the same bits.
std::int64_t IntegerAt(const Type& type, const void* object) noexcept;

namespace internal {
void AddField(Type& type, const Field& field);
void AddRule(Type& type, std::string_view field, std::string_view text, bool (*holds)(const void*));
void MakeHashSteps(Type& type);
}  // namespace internal

// Filled by describe(Description<T>&). Fields take (unit, range, about), (unit, about), (range, about) or (about).
template <typename T>
class Description {
  static_assert(std::is_aggregate_v<T>, "described structs are plain: no constructors, no private members");

 public:
  // Purpose of the struct: one or more sentences.
  void about(std::string_view text) {
    type_.about = text;
    type_.arity = internal::Arity<T>();
  }
  // Overrides the name: for templates, and where two structs have the same name in different namespaces.
  void named(std::string_view name) { type_.name = name; }
  template <auto Member, typename... Details>
  void required(Details... details) {
    Add<Member>(Presence::kRequired, details...);
  }
  template <auto Member, typename... Details>
  void defaulted(Details... details) {
    Add<Member>(Presence::kDefaulted, details...);
  }
  template <auto Member, typename... Details>
  void internal(Details... details) {
    Add<Member>(Presence::kInternal, details...);
  }
  // A condition on several members, reported at `Member`, which is described before. `holds` is a lambda without
  // captures over const T&; readers call it once all members are valid, InRange does not.
  template <auto Member, typename Holds>
  void rule(std::string_view text, Holds) {
    internal::AddRule(type_, internal::MemberName<Member>(), text,
                      [](const void* object) -> bool { return Holds{}(*static_cast<const T*>(object)); });
  }

 private:
  template <typename>
  friend struct internal::TypeMaker;

  template <auto Member>
  void Add(Presence presence, Unit unit, Range range, std::string_view about) {
    static_assert(std::is_same_v<typename internal::MemberPointer<decltype(Member)>::Class, T>,
                  "a member of another struct");
    const T& defaults = Defaults();
    const auto offset =
        reinterpret_cast<const std::byte*>(&(defaults.*Member)) - reinterpret_cast<const std::byte*>(&defaults);
    internal::AddField(type_,
                       {internal::MemberName<Member>(), about, presence, unit, range, static_cast<std::size_t>(offset),
                        &TypeOf<typename internal::MemberPointer<decltype(Member)>::Value>()});
  }
  template <auto Member>
  void Add(Presence presence, Unit unit, std::string_view about) {
    Add<Member>(presence, unit, any_value, about);
  }
  template <auto Member>
  void Add(Presence presence, Range range, std::string_view about) {
    Add<Member>(presence, unit::none, range, about);
  }
  template <auto Member>
  void Add(Presence presence, std::string_view about) {
    Add<Member>(presence, unit::none, any_value, about);
  }

  static const T& Defaults() {
    static const T object{};
    return object;
  }

  Type type_;
};

// Filled by describe(Enumeration<E>&).
template <typename E>
class Enumeration {
 public:
  void about(std::string_view text) { type_.about = text; }
  // `name` is how YAML and Python write it.
  void value(E value, std::string_view name, std::string_view about) {
    type_.enumerators.push_back({static_cast<std::int64_t>(value), name, about});
  }

 private:
  template <typename>
  friend struct internal::TypeMaker;

  Type type_;
};

namespace internal {

template <typename T>
struct TypeMaker {
  static Type Make() {
    Type type;
    if constexpr (std::is_same_v<T, bool>) {
      type.kind = Kind::kBool;
    } else if constexpr (std::is_integral_v<T>) {
      type.kind = Kind::kInteger;
      type.is_signed = std::is_signed_v<T>;
    } else if constexpr (std::is_same_v<T, double>) {
      type.kind = Kind::kReal;
    } else if constexpr (std::is_same_v<T, std::string>) {
      type.kind = Kind::kString;
      type.text = [](const void* o) noexcept -> std::string_view { return *static_cast<const std::string*>(o); };
      type.set_text = [](void* o, std::string_view text) {
        *static_cast<std::string*>(o) = text;
        return true;
      };
    } else if constexpr (std::is_same_v<T, Name>) {
      type.kind = Kind::kString;
      type.text = [](const void* o) noexcept { return static_cast<const Name*>(o)->view(); };
      type.set_text = [](void* o, std::string_view text) {
        *static_cast<Name*>(o) = Name::Of(text);
        return text.size() <= Name::kCapacity;
      };
      type.longest = Name::kCapacity;
    } else if constexpr (std::is_enum_v<T>) {
      Enumeration<T> enumeration;
      describe(enumeration);
      type = std::move(enumeration.type_);
      type.kind = Kind::kEnum;
      type.name = TypeName<T>();
      type.is_signed = std::is_signed_v<std::underlying_type_t<T>>;
    } else {
      Description<T> description;
      describe(description);
      type = std::move(description.type_);
      type.kind = Kind::kStruct;
      if (type.name.empty()) type.name = TypeName<T>();
      type.defaults = &Description<T>::Defaults();
    }
    return type;
  }
};

template <typename T, std::size_t N>
struct TypeMaker<std::array<T, N>> {
  static Type Make() {
    Type type;
    type.kind = Kind::kArray;
    type.element = &TypeOf<T>();
    type.count = N;
    return type;
  }
};

template <typename T>
struct TypeMaker<std::vector<T>> {
  static_assert(!std::is_same_v<T, bool>, "std::vector<bool> has no elements to point at");
  using Vector = std::vector<T>;
  static Type Make() {
    Type type;
    type.kind = Kind::kVector;
    type.element = &TypeOf<T>();
    type.vector_size = [](const void* v) noexcept { return static_cast<const Vector*>(v)->size(); };
    type.vector_data = [](const void* v) noexcept -> const void* { return static_cast<const Vector*>(v)->data(); };
    type.vector_clear = [](void* v) { static_cast<Vector*>(v)->clear(); };
    type.vector_append = [](void* v) -> void* { return &static_cast<Vector*>(v)->emplace_back(); };
    return type;
  }
};

template <typename T>
struct TypeMaker<std::optional<T>> {
  using Optional = std::optional<T>;
  static Type Make() {
    Type type;
    type.kind = Kind::kOptional;
    type.element = &TypeOf<T>();
    type.optional_value = [](const void* o) noexcept -> const void* {
      const auto& optional = *static_cast<const Optional*>(o);
      return optional ? &*optional : nullptr;
    };
    type.optional_reset = [](void* o) { static_cast<Optional*>(o)->reset(); };
    type.optional_emplace = [](void* o) -> void* { return &static_cast<Optional*>(o)->emplace(); };
    return type;
  }
};

template <typename... T>
struct TypeMaker<std::variant<T...>> {
  using Variant = std::variant<T...>;
  static Type Make() {
    Type type;
    type.kind = Kind::kVariant;
    type.alternatives = {&TypeOf<T>()...};
    type.variant_index = [](const void* v) noexcept { return static_cast<const Variant*>(v)->index(); };
    type.variant_value = [](const void* v) noexcept {
      return std::visit([](const auto& value) -> const void* { return &value; }, *static_cast<const Variant*>(v));
    };
    return type;
  }
};

template <typename T>
Type MakeType() {
  Type type = TypeMaker<T>::Make();
  type.size = sizeof(T);
  MakeHashSteps(type);
  return type;
}

}  // namespace internal

template <typename T>
const Type& TypeOf() {
  static const Type type = internal::MakeType<T>();
  return type;
}

}  // namespace takt
