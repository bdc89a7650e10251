// Full-rate recording in virtual time.
#pragma once

#include <pybind11/numpy.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bindings.h"
#include "takt/engine/engine.h"

namespace takt::bindings {

// Keeps the published structs of some components as they are, one row every so many cycles; their descriptions give
// NumPy the columns.
class Recorder {
 public:
  Recorder(const engine::Engine& engine, std::vector<std::size_t> components, std::uint64_t every)
      : components_(std::move(components)), every_(every), tables_(components_.size()) {
    for (std::size_t i = 0; i < tables_.size(); ++i) tables_[i].type = engine.published(components_[i]).type;
  }

  void Append(const engine::Engine& engine) {
    const std::uint64_t cycle = engine.figures().cycle;
    if (cycle % every_ != 0) return;
    cycles_.push_back(cycle);
    for (std::size_t i = 0; i < components_.size(); ++i) {
      const engine::Engine::Published published = engine.published(components_[i]);
      const auto* bytes = static_cast<const std::byte*>(published.outputs);
      tables_[i].bytes.insert(tables_[i].bytes.end(), bytes, bytes + published.type->size);
    }
  }

  std::size_t rows() const { return cycles_.size(); }
  py::array Cycles() const {
    return py::array_t<std::uint64_t>(static_cast<py::ssize_t>(cycles_.size()), cycles_.data());
  }
  py::array Table(std::size_t index) const {
    const Rows& rows = tables_.at(index);
    return py::array(LayoutOf(ColumnsOf(*rows.type), rows.type->size), static_cast<py::ssize_t>(cycles_.size()),
                     rows.bytes.data());
  }

 private:
  struct Rows {
    const Type* type = nullptr;
    std::vector<std::byte> bytes;
  };

  std::vector<std::size_t> components_;
  std::uint64_t every_;
  std::vector<std::uint64_t> cycles_;
  std::vector<Rows> tables_;
};

}  // namespace takt::bindings
