#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <vector>

#include "render/images/image.hpp"
#include "ui/serve/protocol.hpp"

namespace sweepscope::ui {

using SharedImage = std::shared_ptr<const Image>;

/// What a viewer's page shows, and the parts that it needs to show a newer picture: JPEG where much has
/// changed, and every pixel as it was drawn once it has rested for 0.2 s, or where little has changed. The
/// quality of JPEG follows its size, so that a frame is below 55 kB where the picture allows it.
class FrameCoder {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// The parts that lead to this picture; empty if the page shows it already. Opaque pictures only.
  std::vector<FramePart> next(const SharedImage& picture, Time now);
  /// When parts that were sent as JPEG have rested; nothing if there are none.
  std::optional<Time> rested_at() const;
  /// Whether the page shows every pixel of the last picture.
  bool exact() const { return !rested_at(); }
  int quality() const { return quality_; }

 private:
  struct Tile {
    bool changed = false, lossy = false;
    Time changed_at;
  };
  void begin(const Image& picture, Time now);
  void find_changed(const Image& picture, Time now);
  void encode_changed(const Image& picture, Time now, std::vector<FramePart>& parts);
  void encode_rested(const Image& picture, Time now, std::vector<FramePart>& parts);
  ImageRect in_pixels(const ImageRect& tiles) const;
  Tile& tile(int column, int row) {
    return tiles_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                  static_cast<std::size_t>(column)];
  }

  SharedImage shown_;
  std::vector<Tile> tiles_;
  int columns_ = 0, rows_ = 0;
  int quality_ = 80;
};

/// Rectangles that cover the marked cells of a grid, row by row, and nothing else as long as there are at
/// most `max_count`; then the one that holds all.
std::vector<ImageRect> cover(const std::vector<bool>& marked, int columns, std::size_t max_count);

}  // namespace sweepscope::ui
