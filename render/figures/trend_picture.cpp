#include "render/figures/trend_picture.hpp"

#include "render/charts/trend_charts.hpp"
#include "render/figures/figure_pictures.hpp"
#include "render/vector/vector_file.hpp"

namespace sweepscope {

Picture trend_picture(const Campaign& campaign, const ComparisonOptions& look) {
  return charts_picture(trend_charts(campaign, style_of(look.background)), look);
}

Result<void> write_trend(const std::filesystem::path& path, const Campaign& campaign) {
  ComparisonOptions look;
  look.width_px = 1600, look.height_px = 700;
  look.background = Background::kLight;
  look.title = summary_of(campaign);
  const std::vector<PngText> texts{{"Title", look.title},
                                   {"Software", "sweepscope " SWEEPSCOPE_VERSION},
                                   {"Equation", "t_motor = t_laser + offset"}};
  return write_picture(path, trend_picture(campaign, look), texts);
}

}  // namespace sweepscope
