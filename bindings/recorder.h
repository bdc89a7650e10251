// Full-rate recording in virtual time.
#pragma once

#include <pybind11/numpy.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bindings.h"
#include "takt/engine/engine.h"

namespace takt::bindings {

// Bytes that grow by realloc, which moves large blocks to other pages without copying them.
class GrowingBytes {
 public:
  void Append(const void* bytes, std::size_t count) {
    if (size_ + count > room_) Grow(size_ + count);
    std::memcpy(data_.get() + size_, bytes, count);
    size_ += count;
  }

  // Hands the bytes over and begins anew. Null if there are none.
  std::byte* Release() {
    size_ = room_ = 0;
    return data_.release();
  }

 private:
  struct Free {
    void operator()(std::byte* bytes) const { std::free(bytes); }
  };

  void Grow(std::size_t needed) {
    const std::size_t room = std::max(needed, 2 * room_);
    auto* grown = static_cast<std::byte*>(std::realloc(data_.get(), room));
    if (!grown) throw std::bad_alloc();
    static_cast<void>(data_.release());  // realloc has it
    data_.reset(grown);
    room_ = room;
  }

  std::unique_ptr<std::byte, Free> data_;
  std::size_t size_ = 0;
  std::size_t room_ = 0;
};

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
      tables_[i].bytes.Append(published.outputs, published.type->size);
    }
  }

  std::size_t rows() const { return cycles_.size(); }
  py::array Cycles() const {
    return py::array_t<std::uint64_t>(static_cast<py::ssize_t>(cycles_.size()), cycles_.data());
  }
  // The rows of a component, handed over and not copied: once for each, when the recorder has been stopped.
  py::array TakeTable(std::size_t index) {
    Rows& rows = tables_.at(index);
    if (rows.taken) throw std::logic_error("the rows of this component have been taken");
    rows.taken = true;
    const py::dtype layout = LayoutOf(ColumnsOf(*rows.type), rows.type->size);
    std::byte* bytes = rows.bytes.Release();
    if (!bytes) return py::array(layout, py::ssize_t{0});
    const py::capsule owner(bytes, [](void* owned) { std::free(owned); });
    return py::array(layout, static_cast<py::ssize_t>(cycles_.size()), bytes, owner);
  }

 private:
  struct Rows {
    const Type* type = nullptr;
    GrowingBytes bytes{};
    bool taken = false;
  };

  std::vector<std::size_t> components_;
  std::uint64_t every_;
  std::vector<std::uint64_t> cycles_;
  std::vector<Rows> tables_;
};

}  // namespace takt::bindings
