// Writes what a reader finds, event by event, straight into a described struct; says what is wrong in one voice for all
// readers.
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

// Mappings and lists inside one another.
inline constexpr int kMaxDepth = 24;

class Binder {
 public:
  // `places`, where given, learns where each value stands. All must outlive the binder.
  Binder(const Type& type, void* object, ProblemList& problems, SourceMap* places = nullptr)
      : root_type_(type), root_object_(object), problems_(problems), places_(places) {}
  Binder(const Binder&) = delete;
  Binder& operator=(const Binder&) = delete;

  // The events of a text. In a mapping keys and values come in turn. False: nested too deep, the problem is told, stop
  // here.
  void Scalar(Place place, std::string_view text, bool quoted);
  void Null(Place place);
  [[nodiscard]] bool BeginMap(Place place);
  void EndMap();
  [[nodiscard]] bool BeginList(Place place);
  void EndList();
  // A value that cannot be had, `message` says why.
  void Refuse(Place place, std::string message);

  // Key path of the value that comes next: "axes[2].drive.mode".
  std::string Path() const;

 private:
  // A mapping or list that has begun and not ended.
  struct Frame {
    const Type* type = nullptr;
    void* object = nullptr;
    Place start;
    std::size_t problems_before = 0;
    // Mappings.
    bool has_key = false;          // a key was read, its value comes next
    const Field* field = nullptr;  // of that key; null: unknown
    std::array<std::uint64_t, kMaxFields / 64> given;
    std::array<std::uint64_t, kMaxFields / 64> excused;  // most likely misspelt
    std::array<Place, kMaxRules> rule_places;
    // Lists.
    const Field* quantity = nullptr;  // gives unit and range of the elements
    std::size_t index = 0;            // of the element that comes next
  };
  // Where the next value goes. No type: nowhere.
  struct Slot {
    const Type* type = nullptr;
    void* object = nullptr;
    const Field* field = nullptr;  // gives unit and range; null at the root
  };
  using Names = std::map<std::string, std::size_t, std::less<>>;  // element that has it

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
  int skipped_ = 0;           // depth inside a value that goes nowhere
  bool skipped_key_ = false;  // what goes nowhere is a key, not a value
  bool root_done_ = false;
  std::array<Frame, kMaxDepth> frames_;
  std::array<std::unique_ptr<Names>, kMaxDepth> names_;  // of the elements of open lists
};

// What a value of a field must look like: "a number in mm/s above 0". `field` may be null.
std::string Expectation(const Type& type, const Field* field);

}  // namespace takt
