// Runs a fuzz target without a fuzzer: every file of its corpus, and so many changed copies of them.
// FUZZ_TARGETS, which the build defines, is FUZZ_TARGET(name) for each.
// Changes are drawn from a fixed seed, so that all runs are alike; a target that ends the program leaves the
// input.
#include <fcntl.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#define FUZZ_TARGET(name) int fuzz_##name(const std::uint8_t* bytes, std::size_t size);
FUZZ_TARGETS
#undef FUZZ_TARGET

namespace {

using Target = int (*)(const std::uint8_t* bytes, std::size_t size);
const std::map<std::string, Target> targets{
#define FUZZ_TARGET(name) {#name, fuzz_##name},
    FUZZ_TARGETS
#undef FUZZ_TARGET
};

using Bytes = std::vector<std::uint8_t>;
using Random = std::mt19937_64;

std::size_t below(Random& random, std::size_t count) {
  return count == 0 ? 0 : random() % count;
}

void change_once(Bytes& bytes, const std::vector<Bytes>& corpus, Random& random) {
  static constexpr std::uint64_t kNumbers[] = {0,      1,      0x7f,       0x80,       0xff,
                                               0x7fff, 0xffff, 0x7fffffff, 0xffffffff, ~0ULL};
  const std::size_t at = below(random, bytes.size());
  const auto here = bytes.begin() + static_cast<std::ptrdiff_t>(at);
  switch (random() % 7) {
    case 0:
      if (!bytes.empty()) bytes[at] ^= static_cast<std::uint8_t>(1U << random() % 8);
      break;
    case 1:
      if (!bytes.empty()) bytes[at] = static_cast<std::uint8_t>(random());
      break;
    case 2: {  // a number that is often forgotten, in 1 to 8 bytes
      const std::uint64_t number = kNumbers[below(random, std::size(kNumbers))];
      const std::size_t size = std::size_t{1} << random() % 4;
      for (std::size_t i = 0; i < size && at + i < bytes.size(); ++i)
        bytes[at + i] = static_cast<std::uint8_t>(number >> (8 * i));
      break;
    }
    case 3:
      bytes.resize(at);
      break;
    case 4:
      bytes.erase(here, here + static_cast<std::ptrdiff_t>(
                                   below(random, std::min<std::size_t>(bytes.size() - at, 64))));
      break;
    case 5:  // a piece of its own, again
      if (!bytes.empty()) {
        const std::size_t size = 1 + below(random, std::min<std::size_t>(bytes.size() - at, 64));
        const Bytes piece(here, here + static_cast<std::ptrdiff_t>(size));
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(below(random, bytes.size())), piece.begin(),
                     piece.end());
      }
      break;
    default: {  // the end of another file
      const Bytes& other = corpus[below(random, corpus.size())];
      bytes.resize(at);
      bytes.insert(bytes.end(), other.begin() + static_cast<std::ptrdiff_t>(below(random, other.size())),
                   other.end());
    }
  }
}

// Tries inputs. Each is in the file before it is tried: it is there after a crash, whatever kind of crash.
class Tries {
 public:
  Tries(Target target, const char* crash_file)
      : target_(target), file_(open(crash_file, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644)) {}

  bool ok() const { return ok_; }

  // The file stays open: closing one that was emptied waits for the disk.
  void operator()(const Bytes& bytes) {
    ok_ = ok_ && pwrite(file_, bytes.data(), bytes.size(), 0) == ssize_t(bytes.size()) &&
          ftruncate(file_, off_t(bytes.size())) == 0;
    target_(bytes.data(), bytes.size());
  }

 private:
  Target target_;
  int file_;
  bool ok_ = true;
};

}  // namespace

int main(int argc, char** argv) {
  const auto target = argc == 5 ? targets.find(argv[1]) : targets.end();
  if (target == targets.end()) {
    std::fprintf(stderr,
                 "usage: %s TARGET CORPUS COPIES INPUT (where the last input is left after a crash)\n",
                 argv[0]);
    return 2;
  }
  std::set<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(argv[2])) files.insert(entry.path());
  std::vector<Bytes> corpus;
  for (const auto& file : files) {
    std::ifstream stream(file, std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  if (corpus.empty()) {
    std::fprintf(stderr, "%s: no seeds\n", argv[2]);
    return 1;
  }
  Tries try_input(target->second, argv[4]);
  for (const Bytes& bytes : corpus) try_input(bytes);
  const unsigned long copies = std::stoul(argv[3]);
  Random random(1);  // NOLINT(bugprone-random-generator-seed): the same tries each time
  for (unsigned long tried = 0; tried < copies; ++tried) {
    Bytes bytes = corpus[below(random, corpus.size())];
    for (std::uint64_t changes = 1 + random() % 5; changes > 0; --changes) change_once(bytes, corpus, random);
    try_input(bytes);
  }
  if (!try_input.ok()) {
    std::fprintf(stderr, "%s: cannot be written\n", argv[4]);
    return 1;
  }
  std::filesystem::remove(argv[4]);
  std::printf("%zu seeds and %lu changed copies of them\n", corpus.size(), copies);
}
