#include <pybind11/typing.h>

#include "bindings.h"
#include "takt/axis/outputs.h"
#include "takt/axis/state_table.h"

namespace takt::bindings {
namespace {

using FieldRow = py::typing::Tuple<py::str, py::str, py::str, py::typing::Dict<int, py::str>>;
using TransitionRow = py::typing::Tuple<py::str, py::str, py::str>;

py::typing::List<FieldRow> OutputFields() {
  py::typing::List<FieldRow> list;
  for (const Column& column : ColumnsOf(TypeOf<axis::Outputs>())) {
    py::dict names;
    for (const Enumerator& e : column.type->enumerators) names[py::int_(e.value)] = py::str(e.name);
    list.append(py::make_tuple(column.name, column.unit.text, column.about, names));
  }
  return list;
}

py::dtype OutputLayout() {
  return LayoutOf(ColumnsOf(TypeOf<axis::Outputs>()), sizeof(axis::Outputs));
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
  m.def("output_fields", &OutputFields,
        "What an axis publishes: (name, unit, meaning, names by value) of every field.");
  m.def("output_layout", &OutputLayout, "The NumPy type of what an axis publishes.");
  m.def("transitions", &Transitions, "Every legal change of an axis' state: (from, to, by).");
}

}  // namespace takt::bindings
