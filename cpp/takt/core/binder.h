// Writes the values that a reader finds, event by event, into a described struct, and reports problems in the same
// words for all readers.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "takt/core/describe.h"
#include "takt/core/problem.h"
#include "takt/core/scalar.h"

namespace takt {

// Nesting depth of mappings and lists.
inline constexpr int kMaxDepth = 24;

class Binder {
 public:
  // `places`, if given, records the position of each value in the text. All arguments must outlive the binder.
  Binder(const Type& type, void* object, ProblemList& problems, SourceMap* places = nullptr)
      : root_type_(type), root_object_(object), problems_(problems), places_(places) {}
  Binder(const Binder&) = delete;
  Binder& operator=(const Binder&) = delete;

  // The events of a text. In a mapping keys and values alternate. Begin... return false if nested too deep: the problem
  // is reported; stop.
  void Scalar(Place place, std::string_view text, bool quoted);
  void Null(Place place);
  [[nodiscard]] bool BeginMap(Place place);
  void EndMap();
  [[nodiscard]] bool BeginList(Place place);
  void EndList();
  // Reports a value that cannot be read; `message` says why.
  void Refuse(Place place, std::string message);

  // Returns the key path of the next value: "axes[2].drive.mode".
  std::string Path() const;

 private:
  // A mapping or list that has begun and not ended yet.
  struct Frame {
    const Type* type = nullptr;
    void* object = nullptr;
    Place start;
    std::size_t problems_before = 0;
    // Mappings.
    bool has_key = false;          // a key was read, its value comes next
    const Field* field = nullptr;  // of that key; null: unknown key
    std::array<std::uint64_t, kMaxFields / 64> given;
    std::array<std::uint64_t, kMaxFields / 64> excused;  // missing fields that are most likely misspelt; not reported
    std::array<Place, kMaxRules> rule_places;
    // Lists.
    const Field* quantity = nullptr;  // field that gives unit and range of the elements
    std::size_t index = 0;            // of the next element
  };
  // The target of the next value. No type: the value is skipped.
  struct Slot {
    const Type* type = nullptr;
    void* object = nullptr;
    const Field* field = nullptr;  // gives unit and range; null at the root
  };
  using Names = std::map<std::string, std::size_t, std::less<>>;  // index of the element with this name

  bool InMap() const { return depth_ > 0 && Top().type->kind == Kind::kStruct; }
  Frame& Top() { return frames_[depth_ - 1]; }
  const Frame& Top() const { return frames_[depth_ - 1]; }

  void Key(Place place, std::string_view text);
  void UnknownKey(Place place, std::string_view text);
  Slot Next(Place place);
  void Done();
  bool Begin(Place place, bool map);
  void EndSkipped();
  void CheckComplete(Frame& frame);
  void CheckName(Place place, std::string_view name);

  void Read(const Slot& slot, Place place, std::string_view text, bool quoted);
  void ReadReal(const Slot& slot, Place place, std::string_view text);
  void ReadInteger(const Slot& slot, Place place, std::string_view text);
  void Mismatch(Place place, const Slot& slot, const std::string& found);
  void BadNumber(Place place, const Slot& slot, std::string_view text, NumberError error);

  const Type& root_type_;
  void* root_object_;
  ProblemList& problems_;
  SourceMap* places_;
  std::size_t depth_ = 0;
  int skipped_ = 0;           // depth inside a skipped value
  bool skipped_key_ = false;  // the skipped value is a key
  bool root_done_ = false;
  std::array<Frame, kMaxDepth> frames_;
  std::array<std::unique_ptr<Names>, kMaxDepth> names_;  // of the elements of open lists
};

// Returns the form that a value of a field must have: "a number in mm/s above 0". `field` may be null.
std::string Expectation(const Type& type, const Field* field);

}  // namespace takt
