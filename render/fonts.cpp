#include "render/fonts.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <stdexcept>

// The build gives the fonts' paths; the assembler copies the files in.
#define SWEEPSCOPE_EMBED(symbol, path)                                                     \
  __asm__(".section .rodata\n.balign 16\n" symbol "_begin:\n.incbin \"" path "\"\n" symbol \
          "_end:\n.byte 0\n.previous\n")
SWEEPSCOPE_EMBED("sweepscope_font_regular", SWEEPSCOPE_FONT_REGULAR);
SWEEPSCOPE_EMBED("sweepscope_font_bold", SWEEPSCOPE_FONT_BOLD);

extern "C" {
extern const char sweepscope_font_regular_begin[], sweepscope_font_regular_end[];
extern const char sweepscope_font_bold_begin[], sweepscope_font_bold_end[];
}

namespace sweepscope {
namespace {

/// VTK reads fonts from paths alone: a file in memory has one.
std::string memory_file(const char* name, std::string_view bytes) {
  const int file = memfd_create(name, MFD_CLOEXEC);
  if (file < 0) throw std::runtime_error("no memory file for a font");
  while (!bytes.empty()) {
    const ssize_t written = write(file, bytes.data(), bytes.size());
    if (written <= 0) throw std::runtime_error("no memory for a font");
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return "/proc/self/fd/" + std::to_string(file);
}

}  // namespace

std::string_view font_bytes(bool bold) {
  return bold ? std::string_view(sweepscope_font_bold_begin, sweepscope_font_bold_end)
              : std::string_view(sweepscope_font_regular_begin, sweepscope_font_regular_end);
}

const std::string& font_path(bool bold) {
  static const std::string regular_path = memory_file("DejaVuSans", font_bytes(false));
  static const std::string bold_path = memory_file("DejaVuSans-Bold", font_bytes(true));
  return bold ? bold_path : regular_path;
}

}  // namespace sweepscope
