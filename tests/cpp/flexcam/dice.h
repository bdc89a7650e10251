// Random numbers, the same ones for the same seed.
#pragma once

#include <random>

namespace takt::flexcam {

class Dice {
 public:
  explicit Dice(unsigned seed) : generator_(seed) {}
  double Between(double low, double high) { return std::uniform_real_distribution<>(low, high)(generator_); }
  int Upto(int last) { return std::uniform_int_distribution<>(0, last)(generator_); }
  bool Coin() { return Upto(1) == 1; }

 private:
  std::mt19937 generator_;
};

}  // namespace takt::flexcam
