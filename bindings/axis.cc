#include <pybind11/typing.h>

#include <stdexcept>
#include <string>

#include "bindings.h"
#include "takt/axis/outputs.h"
#include "takt/axis/state_table.h"
#include "takt/engine/components.h"

namespace takt::bindings {
namespace {

using FieldRow = py::typing::Tuple<py::str, py::str, py::str, py::typing::Dict<int, py::str>>;
using KindRow = py::typing::Tuple<py::str, py::str>;
using TransitionRow = py::typing::Tuple<py::str, py::str, py::str>;

const Type& OutputsOf(const std::string& kind) {
  for (const engine::ComponentKind& k : engine::ComponentKinds()) {
    if (k.name == kind) return *k.outputs;
  }
  throw std::invalid_argument("no such kind of component: " + kind);
}

py::typing::List<FieldRow> OutputFields(const std::string& kind) {
  py::typing::List<FieldRow> list;
  for (const Column& column : ColumnsOf(OutputsOf(kind))) {
    py::dict names;
    for (const Enumerator& e : column.type->enumerators) names[py::int_(e.value)] = py::str(e.name);
    list.append(py::make_tuple(column.name, column.unit.text, column.about, names));
  }
  return list;
}

py::dtype OutputLayout(const std::string& kind) {
  const Type& type = OutputsOf(kind);
  return LayoutOf(ColumnsOf(type), type.size);
}

py::typing::List<TransitionRow> Transitions() {
  const Type& states = TypeOf<axis::PlcState>();
  const auto name = [&](axis::PlcState state) {
    return py::str(states.FindEnumerator(static_cast<std::int64_t>(state))->name);
  };
  py::typing::List<TransitionRow> list;
  for (const axis::Transition& t : axis::kTransitions) list.append(py::make_tuple(name(t.from), name(t.to), t.by));
  return list;
}

}  // namespace

void BindAxis(py::module_& m) {
  m.def("output_fields", &OutputFields, py::arg("kind"),
        "What a kind of component publishes: (name, unit, meaning, names by value) of every field.");
  m.def("output_layout", &OutputLayout, py::arg("kind"), "The NumPy type of what a kind of component publishes.");
  m.def(
      "component_kinds",
      [] {
        py::typing::List<KindRow> list;
        for (const engine::ComponentKind& kind : engine::ComponentKinds())
          list.append(py::make_tuple(kind.name, kind.section));
        return list;
      },
      "The kinds of components, in the order of their numbers: (name, section of the machine file).");
  m.def("transitions", &Transitions, "Every legal change of an axis' state: (from, to, by).");
}

}  // namespace takt::bindings
