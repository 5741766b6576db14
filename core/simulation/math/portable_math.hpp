#pragma once

#include <cstdint>

/// Functions whose last bit is the same on every machine: built from +, -, *, / and exact operations alone,
/// unlike the C library's, which choose a code path per processor.
namespace sweepscope::simulation {

inline constexpr double kPi = 3.14159265358979323846;

constexpr double radians(double angle_deg) {
  return angle_deg * (kPi / 180.0);
}
constexpr double degrees(double angle_rad) {
  return angle_rad * (180.0 / kPi);
}

struct SinCos {
  double sin = 0;
  double cos = 1;
};

/// Sine and cosine to within 2e-15 for |angle_rad| < 1e6.
SinCos sin_cos(double angle_rad);

/// Natural logarithm of x > 0.
double natural_log(double x);

/// 0 below 0, 1 above 1, with zero slope at both.
inline double smooth_step(double u) {
  if (u <= 0) return 0;
  if (u >= 1) return 1;
  return u * u * (3 - 2 * u);
}

/// A random stream (SplitMix64). A stream is identified by its purpose and a number, so that parallel work
/// draws the same values in any order.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t purpose, std::uint64_t number);

  std::uint64_t next();
  /// In [0, 1).
  double uniform();
  /// Mean 0, standard deviation 1 (Marsaglia's polar method).
  double normal();

 private:
  std::uint64_t state_;
};

}  // namespace sweepscope::simulation
