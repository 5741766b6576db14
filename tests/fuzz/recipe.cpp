// Recipes of figures and tables.
#include "render/figures/recipe.hpp"
#include "tests/fuzz/memory_file.hpp"

int fuzz_recipe(const std::uint8_t* bytes, std::size_t size) {
  const sweepscope::test::MemoryFile file(bytes, size);
  sweepscope::test::expect_sentence(sweepscope::read_recipe(file.path()));
  return 0;
}
