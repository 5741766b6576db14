#include "render/drawing/fonts.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <list>
#include <stdexcept>

#include "core/io/temporary_file.hpp"
#include "render/drawing/embed.hpp"

SWEEPSCOPE_EMBED("sweepscope_font_regular", SWEEPSCOPE_FONT_REGULAR);
SWEEPSCOPE_EMBED("sweepscope_font_bold", SWEEPSCOPE_FONT_BOLD);

extern "C" {
extern const char sweepscope_font_regular_begin[], sweepscope_font_regular_end[];
extern const char sweepscope_font_bold_begin[], sweepscope_font_bold_end[];
}

namespace sweepscope {
namespace {

void write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(file, bytes.data(), bytes.size());
    if (written <= 0) throw std::runtime_error("no memory for a font");
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

/// VTK reads fonts from paths alone: a file in memory has one, but for a bare chroot without /proc.
std::string font_file(const char* name, std::string_view bytes) {
  const int file = memfd_create(name, MFD_CLOEXEC);
  if (file < 0) throw std::runtime_error("no memory file for a font");
  write_all(file, bytes);
  std::string path = "/proc/self/fd/" + std::to_string(file);
  if (access(path.c_str(), R_OK) == 0) return path;
  close(file);
  static std::list<TemporaryFile> files;
  auto named = TemporaryFile::create();
  if (!named) throw std::runtime_error(named.error().message);
  const int temporary = open(named->path().c_str(), O_WRONLY | O_CLOEXEC);
  if (temporary < 0) throw std::runtime_error("no temporary file for a font");
  write_all(temporary, bytes);
  close(temporary);
  return files.emplace_back(std::move(*named)).path().string();
}

}  // namespace

std::string_view font_bytes(bool bold) {
  return bold ? std::string_view(sweepscope_font_bold_begin, sweepscope_font_bold_end)
              : std::string_view(sweepscope_font_regular_begin, sweepscope_font_regular_end);
}

const std::string& font_path(bool bold) {
  static const std::string regular_path = font_file("DejaVuSans", font_bytes(false));
  static const std::string bold_path = font_file("DejaVuSans-Bold", font_bytes(true));
  return bold ? bold_path : regular_path;
}

}  // namespace sweepscope
