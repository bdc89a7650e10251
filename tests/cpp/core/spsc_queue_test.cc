#include "takt/core/spsc_queue.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <thread>

namespace takt {
namespace {

TEST(SpscQueue, HoldsWhatItPromisesAndRefusesMore) {
  SpscQueue<int> queue(5);
  EXPECT_EQ(queue.capacity(), 8u);
  for (int i = 0; i < 8; ++i) EXPECT_TRUE(queue.TryPush(i));
  EXPECT_FALSE(queue.TryPush(8));
  EXPECT_EQ(queue.size(), 8u);
  int value = -1;
  for (int i = 0; i < 8; ++i) {
    ASSERT_TRUE(queue.TryPop(value));
    EXPECT_EQ(value, i);
  }
  EXPECT_FALSE(queue.TryPop(value));
  EXPECT_EQ(value, 7);
  EXPECT_EQ(queue.size(), 0u);
}

TEST(SpscQueue, WrapsRoundManyTimes) {
  SpscQueue<int> queue(1);
  int value = 0;
  for (int i = 0; i < 1000; ++i) {
    ASSERT_TRUE(queue.TryPush(i));
    ASSERT_TRUE(queue.TryPop(value));
    ASSERT_EQ(value, i);
  }
}

struct Item {
  std::uint64_t number = 0;
  std::uint64_t check = 0;
};

// EN-21: nothing lost, duplicated, torn or out of order between two threads; the writer is notified of dropped
// elements.
TEST(SpscQueue, CarriesEverythingBetweenTwoThreads) {
  constexpr std::uint64_t kItems = 200'000;
  SpscQueue<Item> queue(64);
  std::uint64_t refused = 0;
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= kItems; ++i) {
      while (!queue.TryPush({i, ~i * 31})) {
        ++refused;
        std::this_thread::yield();
      }
    }
  });
  std::uint64_t wrong = 0;
  for (std::uint64_t expected = 1; expected <= kItems;) {
    Item item;
    if (!queue.TryPop(item)) {
      std::this_thread::yield();
      continue;
    }
    if (item.number != expected || item.check != ~expected * 31) ++wrong;
    ++expected;
  }
  writer.join();
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(queue.size(), 0u);
  Item item;
  EXPECT_FALSE(queue.TryPop(item));
}

// A reader that stalls causes counted drops, and the writer never waits.
TEST(SpscQueue, DropsAreExactlyWhatTheWriterWasTold) {
  constexpr std::uint64_t kItems = 100'000;
  SpscQueue<Item> queue(16);
  std::uint64_t dropped = 0;
  std::atomic<bool> finished{false};
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= kItems; ++i) dropped += queue.TryPush({i, 0}) ? 0 : 1;
    finished.store(true, std::memory_order_release);
  });
  std::uint64_t received = 0, last = 0;
  bool ascending = true;
  for (;;) {
    const bool was_finished = finished.load(std::memory_order_acquire);
    Item item;
    while (queue.TryPop(item)) {
      ascending = ascending && item.number > last;
      last = item.number;
      ++received;
    }
    if (was_finished) break;
    std::this_thread::yield();
  }
  writer.join();
  EXPECT_TRUE(ascending);
  EXPECT_EQ(received + dropped, kItems);
}

}  // namespace
}  // namespace takt
