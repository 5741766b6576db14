#include "core/io/program_hash.hpp"

#include <sys/auxv.h>

#include "core/io/content_hash.hpp"

namespace sweepscope {

Result<std::string> program_content_hash() {
  static const Result<std::string> hash = [] {
    std::error_code ignored;
    const std::filesystem::path running = "/proc/self/exe";
    if (std::filesystem::exists(running, ignored)) return file_content_hash(running);
    // A bare chroot has no /proc: the path that the program was begun with.
    return file_content_hash(reinterpret_cast<const char*>(getauxval(AT_EXECFN)));
  }();
  return hash;
}

}  // namespace sweepscope
