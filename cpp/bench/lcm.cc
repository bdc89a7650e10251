// EN-31: what a tag costs the threads of gateway, publisher and drives, by the length of the message [bytes]. Commands
// have about 150, set points and answers of drives 150 to 200, heartbeats 60, descriptions of machines thousands.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "takt/lcm/authentication.h"
#include "takt/lcm/clock.h"

namespace takt::lcm {
namespace {

constexpr char kChannel[] = "takt/command";
constexpr Key kKey{1, 2, 3};

void TagSign(benchmark::State& state) {
  Signer signer(kKey);
  const std::vector<std::uint8_t> message(static_cast<std::size_t>(state.range(0)));
  std::vector<std::uint8_t> tagged;
  for (auto _ : state) {
    tagged = message;
    signer.Sign(kChannel, tagged);
    benchmark::DoNotOptimize(tagged.data());
  }
}

// A good tag: each message once, so they are made while the clock stands still.
void TagOpen(benchmark::State& state) {
  constexpr std::size_t kBatch = 1000;
  Signer signer(kKey);
  Verifier verifier({.own = kKey, .other = {}});
  std::vector<std::vector<std::uint8_t>> messages(kBatch);
  std::size_t next = kBatch;
  for (auto _ : state) {
    if (next == kBatch) {
      state.PauseTiming();
      for (std::vector<std::uint8_t>& message : messages) {
        message.assign(static_cast<std::size_t>(state.range(0)), 0);
        signer.Sign(kChannel, message);
      }
      next = 0;
      state.ResumeTiming();
    }
    std::span<const std::uint8_t> bytes = messages[next++];
    if (verifier.Open(kChannel, bytes, WallClockUs()) != TagState::kGood) throw std::runtime_error("not good");
  }
}

// What a flood of forged messages costs each.
void TagRefuse(benchmark::State& state) {
  Signer signer({});
  Verifier verifier({.own = kKey, .other = {}});
  std::vector<std::uint8_t> message(static_cast<std::size_t>(state.range(0)));
  signer.Sign(kChannel, message);
  for (auto _ : state) {
    std::span<const std::uint8_t> bytes = message;
    benchmark::DoNotOptimize(verifier.Open(kChannel, bytes, WallClockUs()));
  }
}

BENCHMARK(TagSign)->Arg(60)->Arg(200)->Arg(10'000);
BENCHMARK(TagOpen)->Arg(60)->Arg(200)->Arg(10'000);
BENCHMARK(TagRefuse)->Arg(60)->Arg(200)->Arg(10'000);

}  // namespace
}  // namespace takt::lcm
