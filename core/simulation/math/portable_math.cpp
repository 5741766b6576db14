#include "core/simulation/math/portable_math.hpp"

#include <cmath>

namespace sweepscope::simulation {
namespace {

std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

}  // namespace

SinCos sin_cos(double angle_rad) {
  // pi/2 in two parts: the first times a small integer is exact.
  constexpr double kHalfPiHigh = 1.57079632673412561417e+00;
  constexpr double kHalfPiLow = 6.07710050650619224932e-11;
  const double quarter = std::floor(angle_rad * (2 / kPi) + 0.5);
  const double r = (angle_rad - quarter * kHalfPiHigh) - quarter * kHalfPiLow;
  const double r2 = r * r;
  double s = 1, c = 1;  // Taylor series, Horner's scheme, |r| <= pi/4
  for (int k = 16; k >= 2; k -= 2) {
    s = 1 - s * r2 / (k * (k + 1.0));
    c = 1 - c * r2 / (k * (k - 1.0));
  }
  s *= r;
  switch (static_cast<std::int64_t>(quarter) & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

double natural_log(double x) {
  constexpr double kLog2 = 0.693147180559945309417;
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);  // [0.5, 1)
  if (mantissa < 0.70710678118654752) {
    mantissa *= 2;
    --exponent;
  }
  const double u = (mantissa - 1) / (mantissa + 1);
  const double u2 = u * u;
  double series = 0;
  for (int k = 23; k >= 1; k -= 2) series = series * u2 + 1.0 / k;
  return exponent * kLog2 + 2 * u * series;
}

Random::Random(std::uint64_t seed, std::uint64_t purpose, std::uint64_t number)
    : state_(mix(mix(mix(seed) + 0x9e3779b97f4a7c15ULL * (purpose + 1)) +
                 0xd1b54a32d192ed03ULL * (number + 1))) {}

std::uint64_t Random::next() {
  state_ += 0x9e3779b97f4a7c15ULL;
  return mix(state_);
}

double Random::uniform() {
  return static_cast<double>(next() >> 11) * 0x1p-53;
}

double Random::normal() {
  while (true) {
    const double u = 2 * uniform() - 1, v = 2 * uniform() - 1;
    const double q = u * u + v * v;
    if (q > 0 && q < 1) return u * std::sqrt(-2 * natural_log(q) / q);
  }
}

}  // namespace sweepscope::simulation
