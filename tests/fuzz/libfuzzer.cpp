// A target as libFuzzer calls it; FUZZ_TARGET, which the build defines, is its function.
#include <cstddef>
#include <cstdint>

int FUZZ_TARGET(const std::uint8_t* bytes, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  return FUZZ_TARGET(bytes, size);
}
