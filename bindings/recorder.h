// Full-rate recording in virtual time.
#pragma once

#include <pybind11/numpy.h>

#include <cstdint>
#include <vector>

#include "bindings.h"
#include "takt/engine/engine.h"

namespace takt::bindings {

// Keeps the published struct of some axes as it is, one row every so many cycles; its description gives NumPy the
// columns.
class Recorder {
 public:
  Recorder(std::vector<std::size_t> axes, std::uint64_t every)
      : axes_(std::move(axes)), every_(every), tables_(axes_.size()) {}

  void Append(const engine::Engine& engine) {
    const std::uint64_t cycle = engine.figures().cycle;
    if (cycle % every_ != 0) return;
    cycles_.push_back(cycle);
    for (std::size_t i = 0; i < axes_.size(); ++i) tables_[i].push_back(engine.outputs(axes_[i]));
  }

  std::size_t rows() const { return cycles_.size(); }
  py::array Cycles() const {
    return py::array_t<std::uint64_t>(static_cast<py::ssize_t>(cycles_.size()), cycles_.data());
  }
  py::array Table(std::size_t index) const {
    const std::vector<axis::Outputs>& rows = tables_.at(index);
    return py::array(LayoutOf(ColumnsOf(TypeOf<axis::Outputs>()), sizeof(axis::Outputs)),
                     static_cast<py::ssize_t>(rows.size()), rows.data());
  }

 private:
  std::vector<std::size_t> axes_;
  std::uint64_t every_;
  std::vector<std::uint64_t> cycles_;
  std::vector<std::vector<axis::Outputs>> tables_;
};

}  // namespace takt::bindings
