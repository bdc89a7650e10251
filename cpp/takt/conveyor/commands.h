// What people and cameras tell a belt.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "takt/core/describe_fwd.h"

namespace takt::conveyor {

// An object is there now (a photo sensor, the trigger of a camera), or was there. Its number is the command's value.
// With any of x to c it is visible at once.
struct Detect {
  std::optional<double> recorded_position{};    // u of the axis, as a touch probe has it; unset: now
  std::optional<std::uint32_t> latched_with{};  // together with that object: several on one picture
  std::optional<double> x{}, y{}, z{};          // mm, as it lay then, from the belt's origin; the others are 0
  std::optional<double> a{}, b{}, c{};          // deg
  std::uint32_t kind = 0;                       // attributes
  std::uint32_t colour = 0;
  double quality = 1;
};

// Where an object lay when it was detected, told later: what the belt has travelled in between is made good.
struct Locate {
  std::optional<std::uint32_t> number{};  // unset: of those without a pose the one detected first
  double x = 0, y = 0, z = 0;             // mm, from the belt's origin
  double a = 0, b = 0, c = 0;             // deg
  std::optional<std::uint32_t> kind{};    // attributes; unset: as they were
  std::optional<std::uint32_t> colour{};
  std::optional<double> quality{};
};

struct TakeObject {  // it is visible, and nobody else may take it from now on
  std::uint32_t number = 0;
};
struct GiveBackObject {  // others may take it again
  std::uint32_t number = 0;
};
struct RemoveObject {  // it is deleted
  std::uint32_t number = 0;
};
struct ClearObjects {  // all are deleted; lost ones they are not
};

using Command = std::variant<Detect, Locate, TakeObject, GiveBackObject, RemoveObject, ClearObjects>;

void describe(Description<Detect>&);
void describe(Description<Locate>&);
void describe(Description<TakeObject>&);
void describe(Description<GiveBackObject>&);
void describe(Description<RemoveObject>&);
void describe(Description<ClearObjects>&);

}  // namespace takt::conveyor
