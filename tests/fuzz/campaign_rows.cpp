// Kept rows of campaigns: a row that was read is written and read again as the same. The input's lines are
// sealed, or no change would get past the hashes.
#include <nlohmann/json.hpp>

#include "core/campaign/campaign_json.hpp"
#include "core/campaign/row_file.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/sealed_lines.hpp"

namespace {

using namespace sweepscope;
using Json = nlohmann::ordered_json;

void check_rows(std::string_view text) {
  const test::MemoryFile memory(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  const auto file = RowFile::open(memory.path());
  test::expect_sentence(file);
  const auto row = file ? (*file)->find("k") : std::nullopt;  // the key of the corpus
  if (!row) return;
  const std::string written = row_to_json(*row).dump(-1, ' ', false, Json::error_handler_t::replace);
  const CampaignRow again = row_from_json(Json::parse(written));
  if (row_to_json(again).dump(-1, ' ', false, Json::error_handler_t::replace) != written) __builtin_trap();
  (void)line_of(*row, std::nullopt);
}

}  // namespace

int fuzz_campaign_rows(const std::uint8_t* bytes, std::size_t size) {
  const auto text = test::text_of(bytes, size);
  check_rows(text);
  check_rows(test::sealed_lines(text));
  return 0;
}
