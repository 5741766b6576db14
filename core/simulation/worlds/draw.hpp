#pragma once

#include <cstdint>

#include "core/simulation/math/portable_math.hpp"

namespace sweepscope::simulation {

/// Random sizes, numbers and decisions, the same on every machine. Draw one value per statement, or in
/// braces: the order of a call's arguments is not fixed.
class Draw {
 public:
  Draw(std::uint64_t seed, std::uint64_t purpose, std::uint64_t number = 0)
      : random_(seed, purpose, number) {}

  double in(double low, double high) { return low + (high - low) * random_.uniform(); }
  int count(int min, int max) { return min + static_cast<int>(random_.uniform() * (max - min + 1)); }
  bool chance(double probability) { return random_.uniform() < probability; }
  std::uint64_t seed() { return random_.next(); }

 private:
  Random random_;
};

}  // namespace sweepscope::simulation
