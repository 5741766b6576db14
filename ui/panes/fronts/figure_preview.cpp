#include "ui/panes/fronts/figure_preview.hpp"

#include <algorithm>

namespace sweepscope::ui {
namespace {

constexpr int kMaxDrawn_px = 1920, kShown_px = 600;
constexpr const char* kPreview = "preview";

/// Each pixel the mean of a square: lines and letters stay legible.
Image shrunk(const Image& image) {
  const int factor = std::max(1, std::max(image.width_px, image.height_px) / kShown_px);
  Image small(std::max(1, image.width_px / factor), std::max(1, image.height_px / factor));
  for (int y = 0; y < small.height_px; ++y) {
    for (int x = 0; x < small.width_px; ++x) {
      for (std::size_t channel = 0; channel < Image::kChannels; ++channel) {
        int sum = 0;
        for (int dy = 0; dy < factor; ++dy)
          for (int dx = 0; dx < factor; ++dx) sum += image.pixel(x * factor + dx, y * factor + dy)[channel];
        small.pixel(x, y)[channel] = static_cast<std::uint8_t>(sum / (factor * factor));
      }
    }
  }
  return small;
}

}  // namespace

void FigurePreview::show(Explorer& explorer, const FigureParts& parts, int width_px, int height_px,
                         double pane_aspect) {
  if (coming_ && !explorer.background.has(kPreview)) {
    if (*coming_)
      image_.show(**coming_);
    else
      problem_ = coming_->error().message;
    coming_ = nullptr;
  }
  const DrawnOf wanted{
      explorer.settings(), parts,       width_px,
      height_px,           pane_aspect, {explorer.pane(Side::kA).full, explorer.pane(Side::kB).full},
      explorer.place()};
  if (drawn_of_ == wanted || !wanted.clouds[0] || !wanted.clouds[1]) return;
  drawn_of_ = wanted;
  problem_.clear();
  // A larger figure has the same proportions at half its size.
  const int part = (std::max(width_px, height_px) + kMaxDrawn_px - 1) / kMaxDrawn_px;
  auto picture = maps_picture(explorer, width_px / part, height_px / part, pane_aspect, parts);
  explorer.background.cancel(kPreview);
  if (!picture) {
    problem_ = picture.error().message;
    return;
  }
  coming_ = std::make_shared<Result<Image>>(Image());
  explorer.background.start(kPreview, kPreview, "Drawing the preview",
                            [picture = std::move(*picture), to = coming_](const Job&) -> Background::Finish {
                              auto drawn = sweepscope::draw(picture);
                              auto small = std::make_shared<Result<Image>>(drawn.map(shrunk));
                              return [to, small] { *to = std::move(*small); };
                            });
}

}  // namespace sweepscope::ui
