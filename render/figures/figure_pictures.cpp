#include "render/figures/figure_pictures.hpp"

#include <algorithm>
#include <cmath>

namespace sweepscope {

Page make_page(const ComparisonOptions& look, double columns) {
  Page page;
  page.style = style_of(look.background);
  const double width = look.width_px, height = look.height_px;
  page.scale = std::clamp(std::min(width / (640 * columns), height / 480), 0.4, 6.0);
  page.picture = {look.width_px, look.height_px, page.style.page, {}, {}};
  const auto px = [&](double at_full_size) { return std::round(at_full_size * page.scale); };
  const double margin = px(22), title_room = look.title.empty() ? 0 : px(34);
  page.room = {margin, margin + title_room, width - 2 * margin, height - 2 * margin - title_room - px(14)};
  Drawing& marks = page.picture.marks;
  if (!look.title.empty()) {
    const double size = 18 * page.scale;
    marks.add(TextMark{{margin, margin + size},
                       fit_text(look.title, size, page.room.width, true),
                       size,
                       page.style.text,
                       AlignX::kLeft,
                       AlignY::kBaseline,
                       true});
  }
  const double small = 10 * page.scale, last_line = height - px(12);
  marks.add(TextMark{{margin, last_line}, "t_motor = t_laser + offset", small, page.style.faint_text});
  marks.add(TextMark{{width - margin, last_line},
                     "sweepscope " SWEEPSCOPE_VERSION,
                     small,
                     page.style.faint_text,
                     AlignX::kRight});
  return page;
}

Picture charts_picture(std::span<const Chart> charts, const ComparisonOptions& look) {
  Page page = make_page(look);
  const double count = static_cast<double>(charts.size()), gap = std::round(56 * page.scale);
  const double width = std::floor((page.room.width - gap * (count - 1)) / count);
  for (std::size_t i = 0; i < charts.size(); ++i) {
    const PixelRect place{page.room.left + static_cast<double>(i) * (width + gap), page.room.top, width,
                          page.room.height};
    add_chart(page.picture.marks, place, charts[i], page.style, page.scale);
  }
  return std::move(page.picture);
}

}  // namespace sweepscope
