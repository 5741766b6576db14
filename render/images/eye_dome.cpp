#include "render/images/eye_dome.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/parallel.hpp"

namespace sweepscope {
namespace {

constexpr std::size_t kPairs = 8;
constexpr float kDarkest = 0.25f, kBrightest = 1.25f;
constexpr float kMaxBrightening = 0.25f;  // of one pair; darkening goes to 1

/// Two opposite neighbours: the step to one of them, and the inverse of its length.
struct Pair {
  std::ptrdiff_t to_neighbour = 0;
  float per_px = 1;
};

/// Everything that is the same for all pixels. Depths are compared in pixels: an edge as deep as a pixel is
/// wide is 1, wherever it is. In perspective a plane's values in the depth buffer are linear in the picture
/// as they are in a parallel projection, so differences of them need only one factor for each pixel.
struct Kernel {
  std::array<Pair, kPairs> pairs;
  bool orthographic = true;
  float px_per_depth = 1;  // in perspective divided by (far_depth - depth)
  float far_depth = 1;
  float noise_px = 0;  // in perspective multiplied by (far_depth - depth)
  float splat_noise_px = 0;
  float strength = 1;
};

std::array<Pair, kPairs> pairs_of(double radius_px, int stride) {
  constexpr std::array<std::array<int, 2>, kPairs> kSteps{
      {{1, 0}, {0, 1}, {1, 1}, {1, -1}, {3, 1}, {1, 3}, {-1, 3}, {-3, 1}}};
  std::array<Pair, kPairs> pairs;
  for (std::size_t i = 0; i < kPairs; ++i) {
    const auto right = std::lround(radius_px * kSteps[i][0]), up = std::lround(radius_px * kSteps[i][1]);
    pairs[i] = {right + up * stride,
                static_cast<float>(1 / std::hypot(static_cast<double>(right), static_cast<double>(up)))};
  }
  return pairs;
}

Kernel kernel_of(const DepthScale& scale, const Lighting& lighting, int stride) {
  const double range_m = scale.far_m - scale.near_m;
  Kernel kernel;
  kernel.pairs = pairs_of(std::clamp(lighting.radius_px, 1.0, 5.0), stride);
  kernel.orthographic = scale.orthographic;
  kernel.far_depth = static_cast<float>(scale.far_m / range_m);
  kernel.px_per_depth =
      static_cast<float>(scale.orthographic ? range_m / scale.metres_per_px : scale.pixels_per_slope);
  kernel.noise_px = static_cast<float>(scale.orthographic ? lighting.noise_m / scale.metres_per_px
                                                          : lighting.noise_m * scale.pixels_per_slope *
                                                                range_m / (scale.near_m * scale.far_m));
  // Of a surface at 45 degrees a splat's face is half its size off at its ends, and a quarter on average.
  kernel.splat_noise_px = static_cast<float>(0.25 * lighting.splat_px);
  kernel.strength = static_cast<float>(lighting.strength / static_cast<double>(kPairs));
  return kernel;
}

/// Four numbers at once, written out: compilers keep comparisons of floating point numbers in scalar loops.
constexpr std::size_t kLanes = 4;
using Floats = float __attribute__((vector_size(kLanes * sizeof(float))));
using Ints = std::int32_t __attribute__((vector_size(kLanes * sizeof(std::int32_t))));

Floats all(float value) {
  return Floats{value, value, value, value};
}
template <typename Vector>
Vector load(const void* from) {
  Vector vector;
  std::memcpy(&vector, from, sizeof vector);
  return vector;
}
Floats larger(Floats a, Floats b) {
  return a > b ? a : b;
}
Floats smaller(Floats a, Floats b) {
  return a < b ? a : b;
}

/// How much darker the kernel makes four pixels, in all of its pairs together.
Floats shade_of(const Kernel& kernel, const float* depth) {
  const Floats here = load<Floats>(depth), none = all(0), empty = all(DepthImage::kEmpty);
  const Floats nearness = kernel.orthographic ? all(1) : all(kernel.far_depth) - here;
  const Floats px_per_depth = all(kernel.px_per_depth) / nearness,
               noise_px = all(kernel.noise_px) * nearness + all(kernel.splat_noise_px);
  Floats shade = none;
  for (const Pair& pair : kernel.pairs) {
    const Floats one = load<Floats>(depth + pair.to_neighbour),
                 other = load<Floats>(depth - pair.to_neighbour);
    const Floats behind_px = px_per_depth * (here - all(0.5f) * (one + other));
    const Floats beyond_px = larger(behind_px - noise_px, none) + smaller(behind_px + noise_px, none);
    const Floats by = smaller(larger(beyond_px * all(pair.per_px), all(-kMaxBrightening)), all(1));
    shade += larger(one, other) < empty ? by : none;
  }
  return here < empty ? shade : none;
}

/// Colours multiplied by the light, four pixels at once.
void shade(const Kernel& kernel, const float* depth, std::uint8_t* rgba) {
  constexpr int kUnchanged = 256;  // a factor of 1
  const Floats light = smaller(larger(all(1) - all(kernel.strength) * shade_of(kernel, depth), all(kDarkest)),
                               all(kBrightest));
  const Ints factor = __builtin_convertvector(all(kUnchanged) * light + all(0.5f), Ints);
  const Ints pixels = load<Ints>(rgba), max = Ints{} + 255;
  Ints lit = pixels & ~0xffffff;
  for (const int channel : {0, 8, 16}) {
    const Ints value = (((pixels >> channel) & 255) * factor) >> 8;
    lit |= (value < max ? value : max) << channel;
  }
  std::memcpy(rgba, &lit, sizeof lit);
}

bool is_empty(const float* depth) {
  return std::all_of(depth, depth + kLanes, [](float value) { return value >= DepthImage::kEmpty; });
}

}  // namespace

DepthImage::DepthImage(int width_px, int height_px)
    : width_px_(width_px),
      height_px_(height_px),
      values_(static_cast<std::size_t>(width_px + 2 * kMargin_px) *
                  static_cast<std::size_t>(height_px + 2 * kMargin_px),
              kEmpty) {}

Image with_lighting(Image image, const DepthImage& depth, const DepthScale& scale, const Lighting& lighting) {
  constexpr std::size_t kRowsAtOnce = 16;
  const Kernel kernel = kernel_of(scale, lighting, depth.stride());
  const auto width = static_cast<std::size_t>(image.width_px);
  for_each_block(image.height_px, kRowsAtOnce, [&](const auto& rows) {
    std::array<std::uint8_t, Image::kChannels * kLanes> last;  // of a row whose width is no multiple
    for (int y = rows.begin(); y < rows.end(); ++y) {
      const float* row = depth.row(y);
      std::uint8_t* rgba = image.pixel(0, y);
      for (std::size_t x = 0; x < width; x += kLanes) {
        if (is_empty(row + x)) continue;
        std::uint8_t* here = rgba + Image::kChannels * x;
        if (x + kLanes <= width) {
          shade(kernel, row + x, here);
          continue;
        }
        std::copy_n(here, Image::kChannels * (width - x), last.data());
        shade(kernel, row + x, last.data());
        std::copy_n(last.data(), Image::kChannels * (width - x), here);
      }
    }
  });
  return image;
}

Image without_gaps(Image image, const DepthImage& depth) {
  for (int y = 0; y < image.height_px; ++y) {
    const float* row = depth.row(y);
    std::uint8_t* alpha = image.pixel(0, y) + Image::kChannels - 1;
    for (int x = 0; x < image.width_px; ++x, alpha += Image::kChannels)
      *alpha = row[x] < DepthImage::kEmpty ? 255 : 0;
  }
  return image;
}

}  // namespace sweepscope
