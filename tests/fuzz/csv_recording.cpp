// Recordings as folders of two CSV tables: scans.csv up to the first NUL, motor.csv behind it.
#include "core/recording/csv/csv_recording.hpp"

#include <algorithm>

#include "core/recording/formats/read_recording.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/scratch_folder.hpp"

int fuzz_csv_recording(const std::uint8_t* bytes, std::size_t size) {
  static const sweepscope::test::ScratchFolder folder(sweepscope::test::folder_in_memory());
  const std::string_view text = sweepscope::test::text_of(bytes, size);
  const std::size_t end = std::min(text.find('\0'), text.size());
  sweepscope::test::write_file(folder / sweepscope::kScansCsv, text.substr(0, end));
  sweepscope::test::write_file(folder / sweepscope::kMotorCsv, text.substr(std::min(end + 1, text.size())));
  sweepscope::test::expect_sentence(sweepscope::read_recording(folder.path(), {}, sweepscope::Job()));
  return 0;
}
