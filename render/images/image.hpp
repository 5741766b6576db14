#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"

namespace sweepscope {

/// Pixels as red, green, blue, alpha, 8 bits each, row by row from the top left. The colours are not
/// multiplied by alpha (255: opaque).
struct Image {
  static constexpr std::size_t kChannels = 4;

  int width_px = 0, height_px = 0;
  std::vector<std::uint8_t> rgba;

  Image() = default;
  Image(int width, int height)
      : width_px(width),
        height_px(height),
        rgba(kChannels * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 255) {}

  std::uint8_t* pixel(int x, int y) { return rgba.data() + index(x, y); }
  const std::uint8_t* pixel(int x, int y) const { return rgba.data() + index(x, y); }
  bool operator==(const Image&) const = default;
  bool opaque() const;
  void make_opaque();

 private:
  std::size_t index(int x, int y) const {
    return kChannels *
           (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) + static_cast<std::size_t>(x));
  }
};

/// A line of text inside a PNG file, for example {"Software", "sweepscope 0.1.0"}. Keys are Latin letters.
struct PngText {
  std::string key, text;
};

/// The image as a PNG file in memory or on disk, without an alpha channel if everything is opaque: the same
/// bytes for the same image and texts; no clock.
std::string encode_png(const Image& image, std::span<const PngText> texts = {});
Result<void> write_png(const Image& image, const std::filesystem::path& path,
                       std::span<const PngText> texts = {});

/// Any PNG file. At most 2^28 pixels.
Result<Image> read_png(const std::filesystem::path& path);

/// From colours that are multiplied by alpha, as blending leaves them: each pixel is the mean of factor x
/// factor pixels, and its colour is divided by alpha. The sizes must be multiples of the factor.
Image shrink_premultiplied(const Image& image, int factor);

}  // namespace sweepscope
