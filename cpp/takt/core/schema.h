// Types as JSON: for editors (JSON Schema) and for generated signatures and pages (reference). Not for use within the
// cycle.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "takt/core/describe.h"

namespace takt {

// Returns the JSON Schema, draft 2020-12. Units are in the descriptions and in "x-unit". Each definition is of one
// type.
nlohmann::ordered_json JsonSchema(const Type& type);

// Returns everything that the description contains:
//   struct    {kind, name, about, fields: [{name, about, presence, unit, unit_meaning, range: {min, max, without_min,
//   text}, default, type}],
//              rules: [{field, text}]}      unit, range and default only where there is one; default in written units
//   enum      {kind, name, about, values: [{name, about}]}
//   list      {kind, element, count}       count only for arrays
//   optional  {kind, element}
//   others    {kind: bool | integer | real | text}
nlohmann::ordered_json ReferenceJson(const Type& type);

// Returns a value as JSON in written units; null if no text can hold it (nan, inf). `field` gives the unit and may be
// null.
nlohmann::ordered_json ToJson(const Type& type, const void* object, const Field* field = nullptr);

}  // namespace takt
