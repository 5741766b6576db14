#include "render/figures/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <system_error>

#include "core/campaign/campaign_json.hpp"
#include "core/io/atomic_file.hpp"
#include "core/io/output_check.hpp"
#include "core/io/table.hpp"
#include "core/loam/features.hpp"
#include "core/map/sections/cross_section.hpp"
#include "core/recording/formats/read_raw_recording.hpp"
#include "render/charts/curve_charts.hpp"
#include "render/charts/over_time_chart.hpp"
#include "render/figures/figure_data.hpp"
#include "render/figures/figure_pictures.hpp"
#include "render/figures/figure_table.hpp"
#include "render/figures/residual_picture.hpp"
#include "render/figures/trend_picture.hpp"
#include "render/page/html.hpp"
#include "render/page/page.hpp"
#include "render/vector/vector_file.hpp"

namespace sweepscope {
namespace {

struct Made {
  Picture picture;
  std::string what;       // the offsets or the like, for the file's own description
  std::string page = {};  // HTML, instead of the picture
};

std::string describe(std::span<const MapSpec> maps) {
  std::string text;
  for (const MapSpec& map : maps) {
    text += fmt::format("{}{} at {} ms{}", text.empty() ? "" : "; ", map.recording,
                        offset_label_ms(map.offset_s), map.true_poses ? ", placed by the true poses" : "");
  }
  return text;
}

Result<Made> make(const MapsFigure& figure, const ComparisonOptions& look, FigureData& data) {
  const Estimate* curve = nullptr;
  if (!figure.estimate.empty()) {
    const auto estimate = data.estimate(figure.estimate);
    if (!estimate) return tl::unexpected(estimate.error());
    curve = *estimate;
  }
  const auto maps = data.maps(figure.maps, look.colour_by == ColourBy::kFeatures);
  if (!maps) return tl::unexpected(maps.error());
  return comparison_picture(*maps, curve, look).map([&](Picture&& picture) {
    return Made{std::move(picture), describe(figure.maps)};
  });
}

std::string_view name_of(Criterion criterion) {
  switch (criterion) {
    case Criterion::kE:
      return "e";
    case Criterion::kN:
      return "n";
    case Criterion::kRoll:
      return "roll";
    case Criterion::kD:
      break;
  }
  return "d";
}

/// All that one estimate has to show, where the figure does not say what.
std::vector<Criterion> criteria_of(const CurvesFigure& figure, const Estimate& first) {
  if (!figure.criteria.empty()) return figure.criteria;
  const auto has = [&](std::optional<double> CurvePoint::*value) {
    return std::any_of(first.curve.begin(), first.curve.end(),
                       [&](const CurvePoint& point) { return (point.*value).has_value(); });
  };
  std::vector<Criterion> criteria;
  if (has(&CurvePoint::d)) criteria.push_back(Criterion::kD);
  if (has(&CurvePoint::e_m)) criteria.push_back(Criterion::kE);
  if (has(&CurvePoint::n)) criteria.push_back(Criterion::kN);
  if (has(&CurvePoint::signed_rotation_rad)) criteria.push_back(Criterion::kRoll);
  return criteria;
}

Result<Made> make(const CurvesFigure& figure, const ComparisonOptions& look, FigureData& data) {
  std::vector<NamedEstimate> estimates;
  std::string what;
  for (const std::string& name : figure.estimates) {
    const auto estimate = data.estimate(name);
    if (!estimate) return tl::unexpected(estimate.error());
    estimates.push_back({name, **estimate});
    what += (what.empty() ? "" : "; ") + name;
    if ((*estimate)->offset_s) what += fmt::format(": {} ms", offset_label_ms(*(*estimate)->offset_s));
  }
  std::vector<Chart> charts;
  for (const Criterion criterion : criteria_of(figure, estimates[0].estimate)) {
    const Style style = style_of(look.background);
    auto chart = estimates.size() == 1 ? curve_chart(estimates[0].estimate, name_of(criterion), {}, style)
                                       : curves_of_many(estimates, name_of(criterion), style);
    if (!chart) return tl::unexpected(chart.error());
    charts.push_back(std::move(*chart));
  }
  if (charts.empty()) return failure(ExitCode::kNotIdentifiable, what + ": there is no criterion to draw");
  return Made{charts_picture(charts, look), what};
}

double path_height_at(const ComparedMap& map, const Eigen::Vector2d& at_m) {
  double height_m = 0, nearest_m = 1e300;
  for (const StampedPose& pose : map.path) {
    const double distance_m = (pose.position_m.head<2>() - at_m).norm();
    if (distance_m < nearest_m) nearest_m = distance_m, height_m = pose.position_m.z();
  }
  return height_m;
}

std::optional<CrossSection> fitted_on_sharpest(const CrossSection& rough, std::span<const ComparedMap> maps) {
  std::optional<CrossSection> sharpest;
  double min_mm = 1e300;
  for (const ComparedMap& map : maps) {
    const auto section = face_fitted(*map.cloud, rough);
    if (!section) continue;
    // Not at half height: with two layers of a face, a fit can follow one and leave the other below half.
    const double width_mm = profile_across(*map.cloud, *section).integral_width_mm.value_or(1e299);
    if (width_mm < min_mm) min_mm = width_mm, sharpest = section;
  }
  return sharpest;
}

/// The named face, made exact on the map that shows it sharpest; or the best one of all.
Result<CrossSection> section_of(const ProfileFigure& figure, std::span<const ComparedMap> maps) {
  std::optional<CrossSection> section;
  if (figure.at_m) {
    CrossSection rough;
    rough.at_m = *figure.at_m;
    rough.normal_rad = figure.normal_deg * M_PI / 180;
    rough.length_m = figure.length_m;
    const double path_m = path_height_at(maps[0], rough.at_m);
    rough.from_m = path_m + figure.heights->from_m;
    rough.to_m = path_m + figure.heights->to_m;
    section = fitted_on_sharpest(rough, maps);
  } else {
    std::vector<MapOnPath> on_paths;
    for (const ComparedMap& map : maps) on_paths.push_back({map.cloud.get(), map.path});
    if (const auto found = best_section(on_paths)) section = found->section;
  }
  if (section) return *section;
  return failure(ExitCode::kNotIdentifiable, "no face has enough points for a profile");
}

Result<Made> make(const ProfileFigure& figure, const ComparisonOptions& look, FigureData& data) {
  const auto maps = data.maps(figure.maps, false);
  if (!maps) return tl::unexpected(maps.error());
  const auto section = section_of(figure, *maps);
  if (!section) return tl::unexpected(section.error());
  std::vector<NamedProfile> profiles;
  std::string what;
  for (const ComparedMap& map : *maps) {
    const std::string name =
        map.label.empty() ? fmt::format("offset {} ms", offset_label_ms(*map.offset_s)) : map.label;
    profiles.push_back({name, profile_across(*map.cloud, *section)});
    const auto width_mm = profiles.back().profile.width_at_half_height_mm;
    what +=
        fmt::format("{}{}: {}", what.empty() ? "" : "; ", name,
                    width_mm ? fmt::format("{:.1f} mm wide at half height", *width_mm) : "too few points");
  }
  return Made{profile_picture(*maps, *section, profiles, look), what};
}

Result<Made> make(const ScanFigure& figure, const ComparisonOptions& look, FigureData& data) {
  const auto recording = data.recording(figure.recording);
  if (!recording) return tl::unexpected(recording.error());
  const auto features = extract_features(**recording, FeatureOptions(), Job());
  if (!features) return tl::unexpected(features.error());
  const auto& scans = (*recording)->scans;
  std::size_t scan = 0;
  while (scan + 1 < scans.size() && scans[scan].first_beam_s - scans[0].first_beam_s < figure.at_s) ++scan;
  const auto points = scan_points(**recording, *features, scan);
  return Made{scan_picture(points, look), fmt::format("{}, {:.3f} s after the first scan", figure.recording,
                                                      scans[scan].first_beam_s - scans[0].first_beam_s)};
}

Result<Made> make(const OverTimeFigure& figure, const ComparisonOptions& look, FigureData& data) {
  const auto estimate = data.estimate(figure.estimate);
  if (!estimate) return tl::unexpected(estimate.error());
  return over_time_chart(**estimate, style_of(look.background)).map([&](const Chart& chart) {
    return Made{charts_picture(std::span(&chart, 1), look), figure.estimate};
  });
}

Result<Made> make(const ResidualsFigure& figure, const ComparisonOptions& look, FigureData& data) {
  return data.solved_rig(figure.estimate).and_then([&](const auto& rig) -> Result<Made> {
    if (rig->residuals.before.empty())
      return failure(ExitCode::kNotIdentifiable, figure.estimate + ": no flat surface is in view");
    return Made{residual_picture(rig->residuals, look), figure.estimate};
  });
}

Result<Made> make(const TrendFigure& figure, const ComparisonOptions& look, FigureData&) {
  const auto campaign = read_file(figure.table).and_then([&](const std::string& json) {
    return parse_campaign_json(json, figure.table.string());
  });
  if (!campaign) return tl::unexpected(campaign.error());
  return Made{trend_picture(*campaign, look), summary_of(*campaign)};
}

Result<Made> make(const InteractiveFigure& figure, const ComparisonOptions& look, FigureData& data) {
  const auto live = data.live(figure);
  if (!live) return tl::unexpected(live.error());
  const Estimate* criteria = live->criteria ? &*live->criteria : nullptr;
  const auto still = comparison_picture(live->still, criteria, look).and_then(draw);
  if (!still) return tl::unexpected(still.error());
  return live_map_data(*live).map([&](const std::string& live_data) {
    const std::string title = look.title.empty() ? figure.maps[0].recording : look.title;
    const std::string body =
        fmt::format("<h1>{}</h1>\n{}<figure class=\"still\">{}</figure>\n", html::escape(title),
                    live_map_part(*live), html::png_image(encode_png(*still), "Maps A and B"));
    return Made{{}, describe(figure.maps), html_page(title, body, live_data)};
  });
}

std::string extension_of(PictureFormat format) {
  return format == PictureFormat::kSvg ? ".svg" : format == PictureFormat::kPdf ? ".pdf" : ".png";
}

std::vector<std::string> extensions_of(const FigureSpec& figure) {
  if (std::holds_alternative<InteractiveFigure>(figure.what)) return {".html"};
  std::vector<std::string> extensions;
  for (const PictureFormat format : figure.formats) extensions.push_back(extension_of(format));
  return extensions;
}

constexpr std::array kTableExtensions{".csv", ".md", ".tex"};

std::vector<std::filesystem::path> input_files(const Recipe& recipe) {
  std::vector<std::filesystem::path> files{recipe.path};
  for (const auto& [name, recording] : recipe.recordings) {
    const auto* file = std::get_if<RecordedFile>(&recording.source);
    if (file == nullptr) continue;
    for (const auto& path : recording_files(file->path)) files.push_back(path);
    if (file->rig) files.push_back(*file->rig);
  }
  for (const auto& [name, estimate] : recipe.estimates)
    if (!estimate.file.empty()) files.push_back(estimate.file);
  for (const FigureSpec& figure : recipe.figures)
    if (const auto* trend = std::get_if<TrendFigure>(&figure.what)) files.push_back(trend->table);
  return files;
}

std::vector<std::filesystem::path> output_files(const Recipe& recipe, const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const FigureSpec& figure : recipe.figures)
    for (const std::string& extension : extensions_of(figure))
      files.push_back(folder / (figure.name + extension));
  for (const TableSpec& table : recipe.tables)
    for (const char* extension : kTableExtensions) files.push_back(folder / (table.name + extension));
  return files;
}

using Said = std::function<void(const std::string&)>;

class FigureMaker {
 public:
  FigureMaker(const Recipe& recipe, const std::filesystem::path& folder, Canvas& canvas, const Job& job,
              const Said& said)
      : recipe_(recipe),
        folder_(folder),
        canvas_(canvas),
        job_(job),
        said_(said),
        data_(recipe, folder / "cache", job, said) {}

  Result<std::vector<std::filesystem::path>> make_all() {
    const std::size_t count = recipe_.figures.size() + recipe_.tables.size();
    for (const FigureSpec& figure : recipe_.figures) {
      if (job_.cancelled()) return failure(ExitCode::kInterrupted, "interrupted");
      job_.report("figures", static_cast<double>(files_.size()) / static_cast<double>(count));
      if (auto made = write(figure); !made) return tl::unexpected(in_recipe(made.error(), figure.name));
    }
    for (const TableSpec& table : recipe_.tables) {
      if (job_.cancelled()) return failure(ExitCode::kInterrupted, "interrupted");
      if (auto made = write(table); !made) return tl::unexpected(in_recipe(made.error(), table.name));
    }
    return std::move(files_);
  }

 private:
  Error in_recipe(Error error, const std::string& name) const {
    error.message = fmt::format("{}: {}: {}", recipe_.path.string(), name, error.message);
    return error;
  }

  Result<void> write(const FigureSpec& figure) {
    const auto made =
        std::visit([&](const auto& what) { return make(what, figure.look, data_); }, figure.what);
    if (!made) return tl::unexpected(made.error());
    if (!made->page.empty()) {
      const auto path = folder_ / (figure.name + ".html");
      if (auto written = write_file(path, made->page); !written) return written;
      keep(path, made->what);
    }
    const std::vector<PngText> texts{{"Title", figure.look.title.empty() ? figure.name : figure.look.title},
                                     {"Software", "sweepscope " SWEEPSCOPE_VERSION},
                                     {"Equation", "t_motor = t_laser + offset"},
                                     {"Recipe", recipe_.path.filename().string() + ", " + figure.name},
                                     {"Shows", made->what}};
    for (const PictureFormat format : figure.formats) {
      const auto path = folder_ / (figure.name + extension_of(format));
      if (auto written = write_picture(path, made->picture, texts, canvas_); !written) return written;
      keep(path, made->what);
    }
    return {};
  }

  Result<void> write(const TableSpec& spec) {
    const auto table = figure_table(spec, recipe_, data_);
    if (!table) return tl::unexpected(table.error());
    for (const char* extension : kTableExtensions) {
      const auto path = folder_ / (spec.name + extension);
      if (auto written = write_table(path, *table); !written) return written;
      keep(path, spec.title);
    }
    return {};
  }

  void keep(const std::filesystem::path& path, const std::string& what) {
    said_(fmt::format("{}: {}", path.string(), what));
    files_.push_back(path);
  }

  const Recipe& recipe_;
  std::filesystem::path folder_;
  Canvas& canvas_;
  const Job& job_;
  const Said& said_;
  FigureData data_;
  std::vector<std::filesystem::path> files_;
};

}  // namespace

Result<std::vector<std::filesystem::path>> make_figures(const Recipe& recipe,
                                                        const std::filesystem::path& folder, Canvas& canvas,
                                                        const Job& job, const Said& said) {
  const auto checked = check_run_files({input_files(recipe), output_files(recipe, folder), folder});
  if (!checked) return tl::unexpected(checked.error());
  std::error_code error;
  std::filesystem::create_directories(folder / "cache", error);
  if (error) {
    return failure(ExitCode::kWrongUsage,
                   fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
  }
  return FigureMaker(recipe, folder, canvas, job, said).make_all();
}

}  // namespace sweepscope
