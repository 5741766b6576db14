// Recordings as folders of two CSV tables: scans.csv up to the first NUL, motor.csv behind it.
#include "core/recording/csv_recording.hpp"

#include <algorithm>

#include "core/recording/read_recording.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/scratch_folder.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const sweepscope::test::ScratchFolder folder;
  const std::string_view text = sweepscope::test::text_of(bytes, size);
  const std::size_t end = std::min(text.find('\0'), text.size());
  folder.write(sweepscope::kScansCsv, text.substr(0, end));
  folder.write(sweepscope::kMotorCsv, text.substr(std::min(end + 1, text.size())));
  sweepscope::test::expect_sentence(sweepscope::read_recording(folder.path(), {}, sweepscope::Job()));
  return 0;
}
