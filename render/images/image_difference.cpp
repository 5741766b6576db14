#include "render/images/image_difference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

namespace sweepscope {
namespace {

int largest_step(const std::uint8_t* a, const std::uint8_t* b) {
  int largest = 0;
  for (std::size_t c = 0; c < Image::kChannels; ++c) largest = std::max(largest, std::abs(a[c] - b[c]));
  return largest;
}

}  // namespace

ImageDifference compare_images(const Image& actual, const Image& expected, const DifferenceLimits& limits) {
  ImageDifference result;
  result.same_size = actual.width_px == expected.width_px && actual.height_px == expected.height_px;
  if (!result.same_size) return result;
  for (int top = 0; top < actual.height_px; top += limits.tile_px) {
    for (int left = 0; left < actual.width_px; left += limits.tile_px) {
      const int bottom = std::min(top + limits.tile_px, actual.height_px);
      const int right = std::min(left + limits.tile_px, actual.width_px);
      std::size_t differing = 0;
      for (int y = top; y < bottom; ++y) {
        for (int x = left; x < right; ++x) {
          const int step = largest_step(actual.pixel(x, y), expected.pixel(x, y));
          result.largest_channel_difference = std::max(result.largest_channel_difference, step);
          if (step > limits.channel_steps) ++differing;
        }
      }
      result.differing_pixels += differing;
      const double fraction = static_cast<double>(differing) / ((bottom - top) * (right - left));
      if (fraction > result.worst_tile_fraction) {
        result.worst_tile_fraction = fraction;
        result.worst_tile_x_px = left;
        result.worst_tile_y_px = top;
      }
    }
  }
  const std::size_t all_pixels = actual.rgba.size() / Image::kChannels;
  const auto pixels = static_cast<double>(all_pixels);
  result.differing_fraction = pixels > 0 ? static_cast<double>(result.differing_pixels) / pixels : 0;
  result.passes = result.differing_fraction <= limits.differing_fraction &&
                  result.worst_tile_fraction <= limits.tile_fraction;
  return result;
}

std::string describe(const ImageDifference& difference) {
  if (!difference.same_size) return "The images differ in size.";
  if (difference.differing_pixels == 0) {
    return fmt::format("The images agree; the largest step in a channel is {}.",
                       difference.largest_channel_difference);
  }
  return fmt::format("{} pixels differ ({:.5f} % of all); the worst tile, at {}, {}, has {:.1f} %.",
                     difference.differing_pixels, 100 * difference.differing_fraction,
                     difference.worst_tile_x_px, difference.worst_tile_y_px,
                     100 * difference.worst_tile_fraction);
}

Image difference_picture(const Image& actual, const Image& expected) {
  Image picture(actual.width_px, actual.height_px);
  for (std::size_t i = 0; i < picture.rgba.size(); i += Image::kChannels) {
    const int alpha_step = std::abs(actual.rgba[i + 3] - expected.rgba[i + 3]);
    for (std::size_t c = 0; c < 3; ++c) {
      const int step = std::max(alpha_step, std::abs(actual.rgba[i + c] - expected.rgba[i + c]));
      picture.rgba[i + c] = static_cast<std::uint8_t>(std::min(255, 8 * step));
    }
  }
  return picture;
}

}  // namespace sweepscope
