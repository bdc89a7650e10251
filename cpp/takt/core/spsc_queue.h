// A bounded queue between one writing and one reading thread: no lock, no allocation after construction.
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <type_traits>
#include <vector>

namespace takt {

// Lamport's ring. Each side caches the other's index as last read, so that an uncontended operation touches no shared
// cache line.
template <typename T>
class SpscQueue {
  static_assert(std::is_trivially_copyable_v<T>, "elements are copied on the cycle thread");

 public:
  // Holds at least `capacity` elements; rounded up to a power of two.
  explicit SpscQueue(std::size_t capacity)
      : slots_(std::bit_ceil(capacity < 2 ? std::size_t{2} : capacity)), mask_(slots_.size() - 1) {}

  // Writing thread only. Returns false, and writes nothing, if the queue is full.
  bool TryPush(const T& value) noexcept {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail - head_seen_ > mask_) {
      head_seen_ = head_.load(std::memory_order_acquire);
      if (tail - head_seen_ > mask_) return false;
    }
    slots_[tail & mask_] = value;
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }

  // Reading thread only. Returns false, and leaves `value` unchanged, if the queue is empty.
  bool TryPop(T& value) noexcept {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head == tail_seen_) {
      tail_seen_ = tail_.load(std::memory_order_acquire);
      if (head == tail_seen_) return false;
    }
    value = slots_[head & mask_];
    head_.store(head + 1, std::memory_order_release);
    return true;
  }

  std::size_t capacity() const noexcept { return slots_.size(); }
  // Exact only while neither thread uses the queue.
  std::size_t size() const noexcept {
    return tail_.load(std::memory_order_acquire) - head_.load(std::memory_order_acquire);
  }

 private:
  std::vector<T> slots_;
  std::size_t mask_;
  alignas(64) std::atomic<std::size_t> head_{0};
  alignas(64) std::size_t tail_seen_ = 0;  // reader's copy
  alignas(64) std::atomic<std::size_t> tail_{0};
  alignas(64) std::size_t head_seen_ = 0;  // writer's copy
};

}  // namespace takt
