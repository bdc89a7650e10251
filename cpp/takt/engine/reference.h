// Everything that is described in C++ as one JSON text; reference pages and Python signatures are made from it.
#pragma once

#include <string>
#include <string_view>

namespace takt::engine {

// JSON Schema of the machine file.
std::string SchemaText();

// {version, machine, verbs: [{target_kind, name, level_sensitive, arguments}], kinds: [{name, section, one, many}],
//  outputs: {kind: type}, figures, states, transitions: [{from, to, by}],
//  homing: {stages, events, steps, actions, rows: [{from, event, steps, action, to}]}, errors: [{id, name, text}],
//  feedback_states: [name]}; types as ReferenceJson writes them.
std::string ReferenceText(std::string_view version);

}  // namespace takt::engine
