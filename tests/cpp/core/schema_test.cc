#include "takt/core/schema.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "example.h"

namespace takt {
namespace {

using Json = nlohmann::ordered_json;

TEST(JsonSchema, SaysWhatTheDescriptionSays) {  // EN-11
  EXPECT_EQ(JsonSchema(TypeOf<example::MoveAbsolute>()), Json::parse(R"({
    "$schema": "https://json-schema.org/draft/2020-12/schema",
    "title": "MoveAbsolute",
    "description": "Moves an axis to an absolute position.",
    "type": "object",
    "additionalProperties": false,
    "properties": {
      "position": {"type": "number", "x-unit": "u", "description": "Where to stop. Unit: u (the axis' own unit)."},
      "velocity": {"type": "number", "exclusiveMinimum": 0, "x-unit": "u/s",
                   "description": "Largest speed on the way. Unit: u/s (the axis' unit per second)."},
      "jerk": {"type": "number", "minimum": 0, "x-unit": "u/s3",
               "description": "Largest jerk; 0: trapezoid. Unit: u/s3 (the axis' unit per second cubed).", "default": 0.0},
      "direction": {"$ref": "#/$defs/Direction", "description": "Sense of travel.", "default": "current"}
    },
    "required": ["position", "velocity"],
    "$defs": {
      "Direction": {"description": "Sense of travel of a rotary axis.", "oneOf": [
        {"const": "current", "description": "As the last move."},
        {"const": "positive", "description": "Only upwards."},
        {"const": "shortest", "description": "The shorter way."},
        {"const": "negative", "description": "Only downwards."}]}
    }
  })"));
}

TEST(JsonSchema, ListsOptionalsAndNestedStructs) {
  const Json schema = JsonSchema(TypeOf<example::Machine>());
  EXPECT_EQ(schema["properties"]["axes"]["items"], Json::parse(R"({"$ref": "#/$defs/Axis"})"));
  EXPECT_EQ(schema["properties"]["table"]["items"], Json::parse(R"({"type": "number", "maximum": 1000})"));
  EXPECT_EQ(schema["properties"]["spare"]["anyOf"],
            Json::parse(R"([{"type": "integer", "minimum": 1, "maximum": 10}, {"type": "null"}])"));
  const Json& axis = schema["$defs"]["Axis"];
  EXPECT_EQ(axis["required"], Json::parse(R"(["name", "velocity", "drive"])"));
  EXPECT_EQ(axis["additionalProperties"], false);
  EXPECT_EQ(axis["properties"]["gains"]["minItems"], 3);
  EXPECT_EQ(axis["properties"]["gains"]["default"], Json::parse("[1.0, 0.0, 0.0]"));
  EXPECT_EQ(axis["properties"]["mounting_angle"]["maximum"], 360);  // written units
  EXPECT_EQ(axis["properties"]["homing"]["anyOf"][0]["$ref"], "#/$defs/Homing");
  EXPECT_FALSE(axis["properties"].contains("counter"));
  EXPECT_EQ(schema["$defs"]["Drive"]["properties"]["station"]["maximum"], 255);
  EXPECT_EQ(schema["$defs"]["Drive"]["properties"]["offset"]["minimum"], -32768);
  EXPECT_TRUE(schema["$defs"].contains("DriveMode"));
}

// Two types of one name, as namespaces allow.
namespace bolt {
enum class Shape { kHex };
struct Bolt {
  Shape shape = Shape::kHex;
};
void describe(Enumeration<Shape>& e) {
  e.about("Of a head.");
  e.value(Shape::kHex, "hex", "Six sides.");
}
void describe(Description<Bolt>& d) {
  d.about("A bolt.");
  d.defaulted<&Bolt::shape>("Its head.");
}
}  // namespace bolt
namespace hole {
enum class Shape { kRound };
struct Hole {
  Shape shape = Shape::kRound;
  bolt::Bolt bolt{};
  Shape counterbore = Shape::kRound;
};
void describe(Enumeration<Shape>& e) {
  e.about("Of a hole.");
  e.value(Shape::kRound, "round", "A circle.");
}
void describe(Description<Hole>& d) {
  d.about("A hole.");
  d.defaulted<&Hole::shape>("Its edge.");
  d.defaulted<&Hole::bolt>("What is in it.");
  d.defaulted<&Hole::counterbore>("Its upper edge.");
}
}  // namespace hole

TEST(JsonSchema, TellsTypesOfOneNameApart) {  // PY-21
  const Json schema = JsonSchema(TypeOf<hole::Hole>());
  const Json& own = schema["properties"];
  EXPECT_EQ(own["shape"]["$ref"], "#/$defs/Shape");
  EXPECT_EQ(own["counterbore"]["$ref"], "#/$defs/Shape");
  EXPECT_EQ(schema["$defs"]["Bolt"]["properties"]["shape"]["$ref"], "#/$defs/Bolt.shape");
  EXPECT_EQ(schema["$defs"]["Shape"]["oneOf"][0]["const"], "round");
  EXPECT_EQ(schema["$defs"]["Bolt.shape"]["oneOf"][0]["const"], "hex");
  EXPECT_EQ(schema["$defs"].size(), 3);
}

TEST(Reference, SaysEverything) {  // EN-11
  const Json reference = ReferenceJson(TypeOf<example::Axis>());
  EXPECT_EQ(reference["name"], "Axis");
  EXPECT_EQ(reference["about"], "A servo axis.");
  EXPECT_EQ(reference["fields"][2], Json::parse(R"({
    "name": "mounting_angle", "about": "Turned by.", "presence": "defaulted", "unit": "deg",
    "range": {"min": -360, "max": 360, "text": "from -360 to 360"}, "default": 0.0, "type": {"kind": "real"}})"));
  EXPECT_EQ(reference["fields"][1]["unit_meaning"], "the axis' unit per second");
  EXPECT_EQ(reference["fields"][1]["range"], Json::parse(R"({"min": 0, "without_min": true, "text": "above 0"})"));
  EXPECT_FALSE(reference["fields"][1].contains("default"));
  EXPECT_EQ(reference["fields"].back()["presence"], "internal");
  const Json& limits = reference["fields"][9]["type"];
  EXPECT_EQ(limits["rules"], Json::parse(R"([{"field": "upper", "text": "must lie above lower"}])"));
  const Json& mode = reference["fields"][7]["type"]["fields"][0]["type"];
  EXPECT_EQ(mode["values"][1], Json::parse(R"({"name": "csv", "about": "The engine."})"));
  EXPECT_EQ(reference["fields"][6]["type"],
            Json::parse(R"({"kind": "list", "element": {"kind": "real"}, "count": 3})"));
}

TEST(ToJson, GivesWrittenUnits) {
  example::Axis axis{.name = "x", .velocity = 5};
  axis.mounting_angle = std::numbers::pi;
  axis.serial = ~std::uint64_t{0};
  const Json json = ToJson(TypeOf<example::Axis>(), &axis);
  EXPECT_EQ(json["mounting_angle"], 180.0);
  EXPECT_EQ(json["serial"], ~std::uint64_t{0});
  EXPECT_EQ(json["drive"]["mode"], "csp");
  EXPECT_FALSE(json.contains("homing"));
  EXPECT_FALSE(json.contains("counter"));
}

}  // namespace
}  // namespace takt
