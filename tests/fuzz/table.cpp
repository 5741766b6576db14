// Tables whose texts are anything at all: as CSV, Markdown and LaTeX.
#include "core/io/table.hpp"
#include "tests/fuzz/memory_file.hpp"

int fuzz_table(const std::uint8_t* bytes, std::size_t size) {
  const std::string text(sweepscope::test::text_of(bytes, size));
  const std::size_t third = text.size() / 3;
  sweepscope::Table table;
  table.title = text.substr(0, third);
  table.columns = {{text.substr(third, third), text.substr(2 * third), sweepscope::Alignment::kLeft, {}},
                   {"x", "ms", sweepscope::Alignment::kRight, static_cast<int>(size % 9)}};
  table.rows = {{text, static_cast<double>(size) / 3}, {std::monostate(), text.substr(third)}};
  if (to_csv(table).empty() || to_markdown(table).empty() || to_latex(table).empty()) __builtin_trap();
  return 0;
}
