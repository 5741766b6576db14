// The lines that `calibrate -` listens to.
#include "core/recording/csv/csv_stream.hpp"

#include <algorithm>

#include "tests/fuzz/memory_file.hpp"

int fuzz_csv_stream(const std::uint8_t* bytes, std::size_t size) {
  std::string_view text = sweepscope::test::text_of(bytes, size);
  const sweepscope::Rig rig;
  sweepscope::CsvStream stream("stream", rig);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const auto taken = stream.take(text.substr(0, end));
    sweepscope::test::expect_sentence(taken);
    if (!taken) break;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  (void)stream.heard();
  return 0;
}
