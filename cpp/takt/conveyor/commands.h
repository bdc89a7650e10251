// Commands to a belt, from users and cameras.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "takt/core/describe_fwd.h"

namespace takt::conveyor {

// Adds an object that is there now (a photo sensor, the trigger of a camera), or was there. The value of the feedback
// is its number. With any of x to c it is visible at once.
struct Detect {
  std::optional<double> recorded_position{};    // [u] of the axis, as latched by a touch probe; unset: now
  std::optional<std::uint32_t> latched_with{};  // at the same time as that object: several in one image
  std::optional<double> x{}, y{}, z{};          // [mm] at that time, relative to the belt's origin; unset ones are 0
  std::optional<double> a{}, b{}, c{};          // [deg]
  std::uint32_t kind = 0;                       // attributes
  std::uint32_t colour = 0;
  double quality = 1;
};

// Gives the pose of an object at the time of its detection; the travel of the belt since then is compensated.
struct Locate {
  std::optional<std::uint32_t> number{};  // unset: the first detected object that has no pose yet
  double x = 0, y = 0, z = 0;             // [mm] relative to the belt's origin
  double a = 0, b = 0, c = 0;             // [deg]
  std::optional<std::uint32_t> kind{};    // attributes; unset: unchanged
  std::optional<std::uint32_t> colour{};
  std::optional<double> quality{};
};

struct TakeObject {  // reserves a visible object for the caller
  std::uint32_t number = 0;
};
struct GiveBackObject {  // makes a taken object available again
  std::uint32_t number = 0;
};
struct RemoveObject {  // deletes an object
  std::uint32_t number = 0;
};
struct ClearObjects {  // deletes all objects, without counting them as lost
};

using Command = std::variant<Detect, Locate, TakeObject, GiveBackObject, RemoveObject, ClearObjects>;

void describe(Description<Detect>&);
void describe(Description<Locate>&);
void describe(Description<TakeObject>&);
void describe(Description<GiveBackObject>&);
void describe(Description<RemoveObject>&);
void describe(Description<ClearObjects>&);

}  // namespace takt::conveyor
