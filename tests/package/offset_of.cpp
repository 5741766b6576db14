// Prints the offset of a recording: what another program does with the engine.
#include <cstdio>

#include "core/offset/estimator.hpp"
#include "core/recording/read_recording.hpp"

int main(int argc, char** argv) {
  const sweepscope::Job job;
  const auto recording = sweepscope::read_recording(argc > 1 ? argv[1] : "", {}, job);
  if (!recording) {
    std::fprintf(stderr, "%s\n", recording.error().message.c_str());
    return static_cast<int>(recording.error().code);
  }
  const auto found = sweepscope::estimate(*recording, {}, job);
  if (!found || !found->identifiable) return static_cast<int>(sweepscope::ExitCode::kNotIdentifiable);
  std::printf("t_motor = t_laser + %.3f ms\n", *found->offset_s * 1e3);
}
