#include "render/images/image.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>

#include "core/io/atomic_file.hpp"
#include "render/images/png_bytes.hpp"

namespace sweepscope {
namespace {

bool is_ascii(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](unsigned char c) { return c < 128; });
}

/// The pixels without their alpha, for a file that needs none.
std::vector<std::uint8_t> without_alpha(const Image& image) {
  std::vector<std::uint8_t> rgb;
  rgb.reserve(image.rgba.size() / Image::kChannels * 3);
  for (std::size_t i = 0; i < image.rgba.size(); i += Image::kChannels) {
    rgb.insert(rgb.end(), {image.rgba[i], image.rgba[i + 1], image.rgba[i + 2]});
  }
  return rgb;
}

/// What a PNG file holds: rows of red, green, blue, and alpha where it is needed.
struct PngPixels {
  int width_px, height_px;
  bool with_alpha;
  std::vector<std::uint8_t> bytes;
};

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
bool encode_into(png_structp png, png_infop info, const PngPixels& pixels, std::vector<png_text>& texts,
                 std::string& bytes) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, &bytes, append_png_bytes, nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(pixels.width_px),
               static_cast<png_uint_32>(pixels.height_px), 8,
               pixels.with_alpha ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_text(png, info, texts.data(), static_cast<int>(texts.size()));
  png_write_info(png, info);
  const std::size_t row_bytes = pixels.bytes.size() / static_cast<std::size_t>(pixels.height_px);
  for (std::size_t at = 0; at < pixels.bytes.size(); at += row_bytes) {
    png_write_row(png, pixels.bytes.data() + at);
  }
  png_write_end(png, nullptr);
  return true;
}

}  // namespace

bool Image::opaque() const {
  for (std::size_t i = kChannels - 1; i < rgba.size(); i += kChannels) {
    if (rgba[i] != 255) return false;
  }
  return true;
}

void Image::make_opaque() {
  for (std::size_t i = kChannels - 1; i < rgba.size(); i += kChannels) rgba[i] = 255;
}

std::string encode_png(const Image& image, std::span<const PngText> texts) {
  std::string bytes;
  const bool opaque = image.opaque();
  const PngPixels pixels{image.width_px, image.height_px, !opaque,
                         opaque ? without_alpha(image) : image.rgba};
  auto entries = to_png_texts(texts);
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  const bool encoded = encode_into(png, info, pixels, entries, bytes);
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
    return unreadable(fmt::format("{}: an image of {} x {} pixels is too large", path.string(), header.width,
                                  header.height));
  }
  header.format = PNG_FORMAT_RGBA;
  Image image(static_cast<int>(header.width), static_cast<int>(header.height));
  if (png_image_finish_read(&header, nullptr, image.rgba.data(), 0, nullptr) == 0) {
    return unreadable(fmt::format("{}: damaged PNG image: {}", path.string(), header.message));
  }
  return image;
}

Image shrink_premultiplied(const Image& image, int factor) {
  constexpr std::size_t kAlpha = Image::kChannels - 1;
  Image out(image.width_px / factor, image.height_px / factor);
  const int count = factor * factor;
  for (int y = 0; y < out.height_px; ++y) {
    for (int x = 0; x < out.width_px; ++x) {
      std::array<int, Image::kChannels> sum{};
      for (int dy = 0; dy < factor; ++dy) {
        const std::uint8_t* from = image.pixel(x * factor, y * factor + dy);
        for (int dx = 0; dx < factor; ++dx) {
          for (int& channel : sum) channel += *from++;
        }
      }
      std::uint8_t* to = out.pixel(x, y);
      const int alpha = sum[kAlpha];  // 255 * count where opaque: then this is the plain mean
      for (std::size_t c = 0; c < kAlpha; ++c) {
        to[c] = static_cast<std::uint8_t>(alpha > 0 ? std::min(255, (255 * sum[c] + alpha / 2) / alpha) : 0);
      }
      to[kAlpha] = static_cast<std::uint8_t>((alpha + count / 2) / count);
    }
  }
  return out;
}

}  // namespace sweepscope
