// What a header needs to declare that its structs and enums are described:
//
//   void describe(Description<MoveAbsolute>&);
//   void describe(Enumeration<Direction>&);
//
// The functions themselves stand in a .cc file that includes takt/core/describe.h.
#pragma once

namespace takt {

struct Type;
template <typename T>
class Description;
template <typename E>
class Enumeration;

}  // namespace takt
