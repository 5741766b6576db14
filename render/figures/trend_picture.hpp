#pragma once

#include <filesystem>

#include "core/campaign/campaign.hpp"
#include "core/error.hpp"
#include "render/comparison/comparison.hpp"
#include "render/pictures/picture.hpp"

namespace sweepscope {

/// The offsets of a campaign over its recordings and their dates (see trend_charts).
Picture trend_picture(const Campaign& campaign, const ComparisonOptions& look);

/// The same as a PNG, SVG or PDF file by the path's extension, 1600 x 700 pixels, under its summary.
Result<void> write_trend(const std::filesystem::path& path, const Campaign& campaign);

}  // namespace sweepscope
