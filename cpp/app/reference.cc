#include "app/reference.h"

#include <nlohmann/json.hpp>

#include "takt/axis/outputs.h"
#include "takt/core/schema.h"
#include "takt/core/status.h"
#include "takt/engine/command.h"
#include "takt/engine/snapshot.h"

namespace takt::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kLargestErrorId = 9999;
constexpr int kIndent = 1;

Json Verbs() {
  Json verbs = Json::array();
  for (const engine::Verb& verb : engine::Verbs()) {
    verbs.push_back({{"target_kind", verb.target_kind},
                     {"name", verb.name},
                     {"level_sensitive", verb.level_sensitive},
                     {"arguments", ReferenceJson(*verb.arguments)}});
  }
  return verbs;
}

Json Errors() {
  const std::string_view unknown = ErrorText(static_cast<ErrorId>(kLargestErrorId + 1));
  Json errors = Json::array();
  for (int id = 1; id <= kLargestErrorId; ++id) {
    const auto error = static_cast<ErrorId>(id);
    if (ErrorText(error) != unknown)
      errors.push_back({{"id", id}, {"name", ErrorName(error)}, {"text", ErrorText(error)}});
  }
  return errors;
}

}  // namespace

std::string SchemaText() {
  return JsonSchema(TypeOf<engine::Machine>()).dump(kIndent);
}

std::string ReferenceText() {
  const Json reference = {{"version", TAKT_VERSION},
                          {"machine", ReferenceJson(TypeOf<engine::Machine>())},
                          {"verbs", Verbs()},
                          {"outputs", ReferenceJson(TypeOf<axis::Outputs>())},
                          {"figures", ReferenceJson(TypeOf<engine::EngineFigures>())},
                          {"states", ReferenceJson(TypeOf<axis::PlcState>())},
                          {"errors", Errors()},
                          {"feedback_states", {"busy", "active", "done", "aborted", "error"}}};
  return reference.dump(kIndent);
}

}  // namespace takt::app
