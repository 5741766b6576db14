#include "ui/serve/frame_coder.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

namespace sweepscope::ui {
namespace {

constexpr int kTile_px = 32;
constexpr std::chrono::milliseconds kRest(200);
// A page's numbers and bars change by less. As PNG at most 50 kB, whatever it shows.
constexpr int kLittle_px = 128 * 128;
// Of what rested, so much at once: a person who moves on does not wait behind all of it.
constexpr int kRested_px = 480 * 320;
constexpr std::size_t kMaxParts = 24;
constexpr std::size_t kSmall_bytes = 28000, kLarge_bytes = 55000;
constexpr int kQualityStep = 10, kMinQuality = 40, kMaxQuality = 80;

bool differs(const Image& a, const Image& b, const ImageRect& place) {
  const std::size_t bytes = Image::kChannels * static_cast<std::size_t>(place.width);
  for (int y = place.top; y < place.bottom(); ++y)
    if (std::memcmp(a.pixel(place.left, y), b.pixel(place.left, y), bytes) != 0) return true;
  return false;
}

std::size_t cell_index(int row, int columns, int column) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
}

/// The runs of marked cells of a row.
std::vector<ImageRect> runs_of(const std::vector<bool>& marked, int columns, int row) {
  std::vector<ImageRect> runs;
  for (int x = 0; x < columns; ++x) {
    if (!marked[cell_index(row, columns, x)]) continue;
    if (!runs.empty() && runs.back().right() == x)
      ++runs.back().width;
    else
      runs.push_back({x, row, 1, 1});
  }
  return runs;
}

ImageRect around(const std::vector<ImageRect>& rects) {
  ImageRect all = rects.front();
  for (const ImageRect& rect : rects) {
    const int right = std::max(all.right(), rect.right()), bottom = std::max(all.bottom(), rect.bottom());
    all.left = std::min(all.left, rect.left);
    all.top = std::min(all.top, rect.top);
    all.width = right - all.left;
    all.height = bottom - all.top;
  }
  return all;
}

}  // namespace

std::vector<ImageRect> cover(const std::vector<bool>& marked, int columns, std::size_t max_count) {
  std::vector<ImageRect> found;
  const int rows = columns > 0 ? static_cast<int>(marked.size()) / columns : 0;
  for (int row = 0; row < rows; ++row) {
    for (const ImageRect& run : runs_of(marked, columns, row)) {
      const auto above = std::find_if(found.begin(), found.end(), [&](const ImageRect& rect) {
        return rect.left == run.left && rect.width == run.width && rect.bottom() == row;
      });
      if (above != found.end())
        ++above->height;
      else
        found.push_back(run);
    }
  }
  if (found.size() > max_count) return {around(found)};
  return found;
}

void FrameCoder::begin(const Image& picture, Time now) {
  columns_ = (picture.width_px + kTile_px - 1) / kTile_px;
  rows_ = (picture.height_px + kTile_px - 1) / kTile_px;
  tiles_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), Tile{true, true, now});
}

ImageRect FrameCoder::in_pixels(const ImageRect& tiles) const {
  const int left = tiles.left * kTile_px, top = tiles.top * kTile_px;
  return {left, top, std::min(tiles.right() * kTile_px, shown_->width_px) - left,
          std::min(tiles.bottom() * kTile_px, shown_->height_px) - top};
}

void FrameCoder::find_changed(const Image& picture, Time now) {
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      Tile& one = tile(column, row);
      one.changed = differs(*shown_, picture, in_pixels({column, row, 1, 1}));
      if (one.changed) one.changed_at = now;
    }
  }
}

void FrameCoder::encode_changed(const Image& picture, Time now, std::vector<FramePart>& parts) {
  std::vector<bool> changed;
  for (const Tile& one : tiles_) changed.push_back(one.changed);
  const auto places = cover(changed, columns_, kMaxParts);
  int area_px = 0;
  for (const ImageRect& place : places) area_px += in_pixels(place).area();
  const bool little = area_px <= kLittle_px;
  std::size_t bytes = 0;
  for (const ImageRect& place : places) {
    const ImageRect pixels = in_pixels(place);
    parts.push_back({pixels, little ? FramePart::Format::kPng : FramePart::Format::kJpeg,
                     little ? encode_png_quickly(picture, pixels) : encode_jpeg(picture, pixels, quality_)});
    bytes += parts.back().bytes.size();
    for (int row = place.top; row < place.bottom(); ++row) {
      for (int column = place.left; column < place.right(); ++column) {
        tile(column, row).lossy = !little;
        tile(column, row).changed_at = now;
      }
    }
  }
  if (places.empty() || little) return;
  if (bytes > kLarge_bytes) quality_ = std::max(kMinQuality, quality_ - kQualityStep);
  if (bytes < kSmall_bytes) quality_ = std::min(kMaxQuality, quality_ + kQualityStep);
}

void FrameCoder::encode_rested(const Image& picture, Time now, std::vector<FramePart>& parts) {
  std::vector<bool> rested;
  for (const Tile& one : tiles_) rested.push_back(one.lossy && now - one.changed_at >= kRest);
  int left_px = kRested_px;
  for (ImageRect place : cover(rested, columns_, std::numeric_limits<std::size_t>::max())) {
    if (left_px <= 0) return;
    const int row_px = in_pixels({place.left, place.top, place.width, 1}).area();
    place.height = std::min(place.height, std::max(1, left_px / std::max(1, row_px)));
    const ImageRect pixels = in_pixels(place);
    left_px -= pixels.area();
    parts.push_back({pixels, FramePart::Format::kPng, encode_png_quickly(picture, pixels)});
    for (int row = place.top; row < place.bottom(); ++row)
      for (int column = place.left; column < place.right(); ++column) tile(column, row).lossy = false;
  }
}

std::vector<FramePart> FrameCoder::next(const SharedImage& picture, Time now) {
  const bool first =
      !shown_ || shown_->width_px != picture->width_px || shown_->height_px != picture->height_px;
  if (first) {
    begin(*picture, now);
    shown_ = picture;
  } else if (shown_ != picture) {
    find_changed(*picture, now);
    shown_ = picture;
  } else {
    for (Tile& one : tiles_) one.changed = false;
  }
  std::vector<FramePart> parts;
  encode_changed(*picture, now, parts);
  encode_rested(*picture, now, parts);
  return parts;
}

std::optional<FrameCoder::Time> FrameCoder::rested_at() const {
  std::optional<Time> first;
  for (const Tile& one : tiles_)
    if (one.lossy && (!first || one.changed_at < *first)) first = one.changed_at;
  return first ? std::optional(*first + kRest) : std::nullopt;
}

}  // namespace sweepscope::ui
