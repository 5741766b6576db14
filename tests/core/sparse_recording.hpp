#pragma once

#include "core/simulation/typed_simulation.hpp"

namespace sweepscope::test {

/// A recording of a slow scanner that tests/benchmark/random_readings draws: 8 to 15 scans a sweep, about a
/// vertical axis, of which floor and ceiling say nothing about the offset.
struct SparseRecording {
  std::uint64_t seed;
  const char *scene, *scanner, *motor;
  double sweep_s, offset_ms, duration_s, swing_deg, middle_deg, encoder_hz;
  const char* beam_times = "";  // empty: as the scanner's driver writes them
};

inline TypedSimulation typed(const SparseRecording& drawn) {
  TypedSimulation typed;
  typed.scene = drawn.scene;
  typed.scanner = drawn.scanner;
  typed.motor = drawn.motor;
  typed.axis = "z";
  typed.beam_times = drawn.beam_times;
  typed.offset_ms = drawn.offset_ms;
  typed.options.seed = drawn.seed;
  typed.options.sweep_s = drawn.sweep_s;
  typed.options.duration_s = drawn.duration_s;
  typed.options.swing_deg = drawn.swing_deg;
  typed.options.motor_middle_deg = drawn.middle_deg;
  typed.options.encoder_hz = drawn.encoder_hz;
  return typed;
}

}  // namespace sweepscope::test
