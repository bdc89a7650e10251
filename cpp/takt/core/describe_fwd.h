// Declarations that a header needs for the descriptions of its structs and enums:
//
//   void describe(Description<MoveAbsolute>&);
//   void describe(Enumeration<Direction>&);
//
// The functions themselves are in a .cc file that includes takt/core/describe.h.
#pragma once

namespace takt {

struct Type;
template <typename T>
class Description;
template <typename E>
class Enumeration;

}  // namespace takt
