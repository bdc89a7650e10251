// What lets a step of the engine end early in virtual time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "takt/engine/engine.h"

namespace takt::bindings {

// Sees whether published values are other than they were when they were last kept. It looks every so many cycles, from
// the one that it begins with: changes that are undone between two looks are not seen.
class Watch {
 public:
  struct Field {
    std::size_t component;
    std::size_t offset;
    std::size_t size;
  };

  // `begin`: cycles that have been made when it looks first.
  Watch(std::vector<Field> fields, std::uint64_t every, std::uint64_t begin)
      : fields_(std::move(fields)), every_(every), begin_(begin) {
    std::size_t size = 0;
    for (const Field& field : fields_) size += field.size;
    kept_.resize(size);
  }

  bool IsDue(std::uint64_t cycle) const { return cycle >= begin_ && (cycle - begin_) % every_ == 0; }

  bool Changed(const engine::Engine& engine) const {
    std::size_t at = 0;
    for (const Field& field : fields_) {
      if (std::memcmp(kept_.data() + at, Now(engine, field), field.size) != 0) return true;
      at += field.size;
    }
    return false;
  }

  void Keep(const engine::Engine& engine) {
    std::size_t at = 0;
    for (const Field& field : fields_) {
      std::memcpy(kept_.data() + at, Now(engine, field), field.size);
      at += field.size;
    }
  }

 private:
  static const std::byte* Now(const engine::Engine& engine, const Field& field) {
    return static_cast<const std::byte*>(engine.published(field.component).outputs) + field.offset;
  }

  std::vector<Field> fields_;
  std::uint64_t every_;
  std::uint64_t begin_;
  std::vector<std::byte> kept_;
};

}  // namespace takt::bindings
