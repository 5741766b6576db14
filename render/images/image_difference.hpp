#pragma once

#include <string>

#include "render/images/image.hpp"

namespace sweepscope {

/// When two pictures count as the same. Points snap to pixels, so a single pixel may differ strongly between
/// machines: the test limits the number of different pixels, in the whole picture and in each tile, so that a
/// missing label is detected.
struct DifferenceLimits {
  int channel_steps = 8;             // a pixel differs if a channel is off by more than this
  double differing_fraction = 1e-4;  // of all pixels, at most
  int tile_px = 32;
  // Of a tile's pixels, at most: 8. One letter for another is 20 and more; a processor without AVX and FMA
  // differs in one pixel of a picture.
  double tile_fraction = 0.008;
};

struct ImageDifference {
  bool same_size = false;
  bool passes = false;
  std::size_t differing_pixels = 0;
  double differing_fraction = 0;
  double worst_tile_fraction = 0;
  int worst_tile_x_px = 0, worst_tile_y_px = 0;  // its top left corner
  int largest_channel_difference = 0;
};

ImageDifference compare_images(const Image& actual, const Image& expected,
                               const DifferenceLimits& limits = {});

/// One sentence for a person: what differs, how much, and where.
std::string describe(const ImageDifference& difference);

/// Black where both agree, brighter the more a pixel differs, 8 times amplified. The images must have the
/// same size.
Image difference_picture(const Image& actual, const Image& expected);

}  // namespace sweepscope
