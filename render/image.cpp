#include "render/image.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "core/io/atomic_file.hpp"

namespace sweepscope {
namespace {

void append_bytes(png_structp png, png_bytep bytes, png_size_t length) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(bytes), length);
}

bool is_ascii(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](unsigned char c) { return c < 128; });
}

std::vector<png_text> to_png_texts(std::span<const PngText> texts) {
  std::vector<png_text> entries;
  for (const PngText& text : texts) {
    png_text entry{};
    entry.compression = is_ascii(text.text) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
    entry.key = const_cast<char*>(text.key.c_str());
    entry.text = const_cast<char*>(text.text.c_str());
    entry.text_length = text.text.size();
    entries.push_back(entry);
  }
  return entries;
}

/// libpng leaves by longjmp: nothing with a destructor lives here.
bool encode_into(png_structp png, png_infop info, const Image& image, std::vector<png_text>& texts,
                 std::string& bytes) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, &bytes, append_bytes, nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width_px), static_cast<png_uint_32>(image.height_px),
               8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_set_text(png, info, texts.data(), static_cast<int>(texts.size()));
  png_write_info(png, info);
  for (int y = 0; y < image.height_px; ++y) png_write_row(png, image.pixel(0, y));
  png_write_end(png, nullptr);
  return true;
}

}  // namespace

std::string encode_png(const Image& image, std::span<const PngText> texts) {
  std::string bytes;
  auto entries = to_png_texts(texts);
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  const bool encoded = encode_into(png, info, image, entries, bytes);
  png_destroy_write_struct(&png, &info);
  if (!encoded) throw std::logic_error("an image that PNG cannot hold");
  return bytes;
}

Result<void> write_png(const Image& image, const std::filesystem::path& path,
                       std::span<const PngText> texts) {
  return write_file(path, encode_png(image, texts));
}

Result<Image> read_png(const std::filesystem::path& path) {
  const Result<std::string> bytes = read_file(path);
  if (!bytes) return tl::unexpected(bytes.error());
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&header, bytes->data(), bytes->size()) == 0) {
    return unreadable(fmt::format("{}: not a PNG image: {}", path.string(), header.message));
  }
  if (static_cast<std::uint64_t>(header.width) * header.height > (1U << 28)) {
    png_image_free(&header);
    return unreadable(fmt::format("{}: an image of {} x {} pixels is not read", path.string(), header.width,
                                  header.height));
  }
  header.format = PNG_FORMAT_RGB;
  Image image(static_cast<int>(header.width), static_cast<int>(header.height));
  const png_color black{0, 0, 0};
  if (png_image_finish_read(&header, &black, image.rgb.data(), 0, nullptr) == 0) {
    return unreadable(fmt::format("{}: broken PNG image: {}", path.string(), header.message));
  }
  return image;
}

Image shrink(const Image& image, int factor) {
  Image out(image.width_px / factor, image.height_px / factor);
  const int count = factor * factor;
  for (int y = 0; y < out.height_px; ++y) {
    for (int x = 0; x < out.width_px; ++x) {
      int sum[3] = {count / 2, count / 2, count / 2};
      for (int dy = 0; dy < factor; ++dy) {
        const std::uint8_t* from = image.pixel(x * factor, y * factor + dy);
        for (int i = 0; i < 3 * factor; ++i) sum[i % 3] += from[i];
      }
      for (int c = 0; c < 3; ++c) out.pixel(x, y)[c] = static_cast<std::uint8_t>(sum[c] / count);
    }
  }
  return out;
}

}  // namespace sweepscope
