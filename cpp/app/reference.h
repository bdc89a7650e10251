// Everything that is described in C++, as one JSON text: pages and Python signatures are made from it.
#pragma once

#include <string>

namespace takt::app {

// JSON Schema of the machine file.
std::string SchemaText();

// {version, machine, verbs: [{target_kind, name, level_sensitive, arguments}], outputs, figures, states,
//  errors: [{id, name, text}], feedback_states: [name]}; types as ReferenceJson writes them.
std::string ReferenceText();

}  // namespace takt::app
