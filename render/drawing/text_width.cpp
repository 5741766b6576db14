#include <ft2build.h>
#include FT_FREETYPE_H

#include <map>
#include <mutex>
#include <stdexcept>

#include "core/io/printable_text.hpp"
#include "render/drawing/drawing.hpp"
#include "render/drawing/fonts.hpp"

namespace sweepscope {
namespace {

/// The code point of valid UTF-8 that begins at `position`, which moves behind it.
char32_t next_code_point(const std::string& text, std::size_t& position) {
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(text[at]); };
  const unsigned char lead = byte(position++);
  const int more = lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : lead >= 0xC0 ? 1 : 0;
  char32_t code = more == 3 ? lead & 7U : more == 2 ? lead & 15U : more == 1 ? lead & 31U : lead;
  for (int i = 0; i < more && position < text.size() && (byte(position) & 0xC0) == 0x80; ++i) {
    code = code << 6 | (byte(position++) & 63U);
  }
  return code;
}

/// How far each character moves on, in ems.
class Advances {
 public:
  explicit Advances(bool bold) {
    const std::string_view bytes = font_bytes(bold);
    if (FT_Init_FreeType(&library_) != 0 ||
        FT_New_Memory_Face(library_, reinterpret_cast<const FT_Byte*>(bytes.data()),
                           static_cast<FT_Long>(bytes.size()), 0, &face_) != 0) {
      throw std::runtime_error("the font inside the program cannot be read");
    }
  }
  ~Advances() { FT_Done_FreeType(library_); }
  Advances(const Advances&) = delete;
  Advances& operator=(const Advances&) = delete;

  double of(char32_t code) {
    const auto [entry, is_new] = known_.try_emplace(code, 0.0);
    if (is_new && FT_Load_Char(face_, code, FT_LOAD_NO_SCALE) == 0) {
      entry->second = static_cast<double>(face_->glyph->metrics.horiAdvance) / face_->units_per_EM;
    }
    return entry->second;
  }

 private:
  FT_Library library_ = nullptr;
  FT_Face face_ = nullptr;
  std::map<char32_t, double> known_;
};

}  // namespace

double text_width_px(const std::string& name, double size_px, bool bold) {
  const std::string text = printable_line(name);
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  static Advances regular(false), heavy(true);
  double ems = 0;
  for (std::size_t position = 0; position < text.size();) {
    ems += (bold ? heavy : regular).of(next_code_point(text, position));
  }
  return ems * size_px;
}

}  // namespace sweepscope
