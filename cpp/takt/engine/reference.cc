#include "takt/engine/reference.h"

#include <nlohmann/json.hpp>

#include "takt/axis/homing.h"
#include "takt/axis/state_table.h"
#include "takt/core/describe.h"
#include "takt/core/schema.h"
#include "takt/core/status.h"
#include "takt/engine/command.h"
#include "takt/engine/components.h"
#include "takt/engine/snapshot.h"

namespace takt::engine {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kIndent = 1;

template <typename T>
std::string_view NameOf(T value) {
  return TypeOf<T>().FindEnumerator(static_cast<std::int64_t>(value))->name;
}

Json VerbsJson() {
  Json verbs = Json::array();
  for (const Verb& verb : Verbs()) {
    verbs.push_back({{"target_kind", verb.target_kind},
                     {"name", verb.name},
                     {"level_sensitive", verb.level_sensitive},
                     {"arguments", ReferenceJson(*verb.arguments)}});
  }
  return verbs;
}

Json KindsJson() {
  Json kinds = Json::array();
  for (const ComponentKind& kind : ComponentKinds()) {
    kinds.push_back({{"name", kind.name}, {"section", kind.section}, {"one", kind.one}, {"many", kind.many}});
  }
  return kinds;
}

Json OutputsJson() {
  Json outputs = Json::object();
  for (const ComponentKind& kind : ComponentKinds()) outputs[std::string(kind.name)] = ReferenceJson(*kind.outputs);
  return outputs;
}

Json ErrorsJson() {
  Json errors = Json::array();
  for (const ErrorInfo& error : Errors()) {
    if (error.id == ErrorId::kNone) continue;
    errors.push_back({{"id", static_cast<int>(error.id)}, {"name", error.name}, {"text", error.text}});
  }
  return errors;
}

Json TransitionsJson() {
  Json transitions = Json::array();
  for (const axis::Transition& t : axis::kTransitions) {
    transitions.push_back({{"from", NameOf(t.from)}, {"to", NameOf(t.to)}, {"by", t.by}});
  }
  return transitions;
}

Json HomingJson() {
  Json rows = Json::array();
  for (const axis::HomingRow& row : axis::kHomingTable) {
    rows.push_back({{"from", NameOf(row.from)},
                    {"event", NameOf(row.event)},
                    {"steps", NameOf(row.scope)},
                    {"action", NameOf(row.action)},
                    {"to", NameOf(row.to)}});
  }
  return {{"stages", ReferenceJson(TypeOf<axis::HomingStage>())},
          {"events", ReferenceJson(TypeOf<axis::HomingEvent>())},
          {"steps", ReferenceJson(TypeOf<axis::HomingScope>())},
          {"actions", ReferenceJson(TypeOf<axis::HomingAction>())},
          {"rows", rows}};
}

}  // namespace

std::string SchemaText() {
  return JsonSchema(TypeOf<Machine>()).dump(kIndent);
}

std::string ReferenceText(std::string_view version) {
  const Json reference = {{"version", version},
                          {"machine", ReferenceJson(TypeOf<Machine>())},
                          {"verbs", VerbsJson()},
                          {"kinds", KindsJson()},
                          {"outputs", OutputsJson()},
                          {"figures", ReferenceJson(TypeOf<EngineFigures>())},
                          {"states", ReferenceJson(TypeOf<axis::PlcState>())},
                          {"transitions", TransitionsJson()},
                          {"homing", HomingJson()},
                          {"errors", ErrorsJson()},
                          {"feedback_states", {"busy", "active", "done", "aborted", "error"}}};
  return reference.dump(kIndent);
}

}  // namespace takt::engine
