#include <algorithm>
#include <cmath>

#include "render/figures/figure_pictures.hpp"
#include "render/figures/page.hpp"

namespace sweepscope {

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
