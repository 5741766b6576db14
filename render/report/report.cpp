#include "render/report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include "core/io/printable_text.hpp"
#include "core/results/rig_parameters.hpp"
#include "render/charts/curve_charts.hpp"
#include "render/charts/over_time_chart.hpp"
#include "render/comparison/comparison.hpp"
#include "render/drawing/plus_minus.hpp"
#include "render/figures/figure_pictures.hpp"
#include "render/figures/residual_picture.hpp"
#include "render/page/html.hpp"
#include "render/page/page.hpp"
#include "render/vector/vector_file.hpp"

namespace sweepscope {
namespace {

std::string offset_text(double offset_s, const std::optional<double>& sigma_s) {
  std::string text = fmt::format("{}{:.2f} ms", offset_s < 0 ? "−" : "", std::abs(offset_s) * 1e3);
  if (sigma_s) text += fmt::format(" ± {:.2f} ms", *sigma_s * 1e3);
  return text;
}

std::string method_text(const Estimate& estimate) {
  switch (estimate.method) {
    case Method::kStationary:
      return "the offset at which the odometry of a stationary rig registers the least motion (d)";
    case Method::kMoving:
      return "the offset at which the points match the map best: the smallest mean distance per match (e), "
             "confirmed by the number of matches (n)";
    case Method::kDirect:
      return "an unknown of a least-squares fit between the sweeps of both directions";
  }
  return "";
}

std::string answer(const Estimate& estimate, std::size_t warnings) {
  if (!estimate.identifiable || !estimate.offset_s) {
    std::string reasons;
    for (const std::string& reason : estimate.reasons())
      reasons += html::element("li", html::escape(with_plus_minus_sign(reason)));
    return "<div class=\"answer refused\"><div><b>The offset cannot be determined from this "
           "recording.</b></div>" +
           html::element("ul", reasons) + "</div>\n";
  }
  const std::string warned = warnings == 0 ? ""
                                           : fmt::format(" <a href=\"#warnings\">{} warning{}.</a>", warnings,
                                                         warnings == 1 ? "" : "s");
  return fmt::format(
      "<div class=\"answer\"><div>Offset between the laser scanner's clock and its motor's</div>\n"
      "<div class=\"number\">{}</div>\n<div class=\"equation\">t_motor = t_laser + offset</div>\n"
      "<p>Add it to a laser stamp to read the motor's clock.{}</p></div>\n",
      offset_text(*estimate.offset_s, estimate.sigma_s), warned);
}

/// Wide tables scroll by themselves, and not the page.
std::string in_table(const std::string& rows, std::string_view look = "table") {
  return fmt::format("<div class=\"{}\">", look) + html::element("table", rows) + "</div>\n";
}

std::string meaning_of(std::string_view criterion) {
  if (criterion == "d") return "motion between sweeps";
  if (criterion == "n") return "matches with the map";
  if (criterion == "e") return "mean distance per match";
  if (criterion == "direct") return "remaining distance per match";
  if (criterion == "capped_cost") return "distance between sweeps, capped";
  return "";
}

// On a phone a name in one piece would be cut.
std::string shown_name(std::string criterion) {
  std::ranges::replace(criterion, '_', ' ');
  return criterion;
}

std::string criteria_table(const ReportContent& content) {
  std::vector<CriterionOptimum> criteria = content.estimate.criteria;
  if (content.criteria)
    criteria.insert(criteria.end(), content.criteria->criteria.begin(), content.criteria->criteria.end());
  if (criteria.empty()) return "";
  std::string found = html::element("h2", "How it was found");
  if (content.estimate.offset_s)
    found += fmt::format("<p>As {}.{}</p>\n", method_text(content.estimate),
                         content.estimate.sigma_s ? " The uncertainty is one standard deviation." : "");
  std::string rows =
      "<tr><th>criterion</th><th></th><th class=\"number-cell\">best offset</th><th "
      "class=\"number-cell\">value</th></tr>\n";
  for (const CriterionOptimum& one : criteria) {
    const std::string value = one.name == "n"   ? fmt::format("{:.0f} matches", one.value)
                              : one.name == "d" ? fmt::format("{:.4g} m", one.value)
                                                : fmt::format("{:.2f} mm", one.value * 1e3);
    rows += fmt::format(
        "<tr><td>{}</td><td>{}</td><td class=\"number-cell\">{}</td><td class=\"number-cell\">{}</td></tr>\n",
        html::escape(shown_name(one.name)), meaning_of(one.name),
        offset_text(one.offset_s, one.name == "direct" ? content.estimate.sigma_s : std::nullopt), value);
  }
  return found + in_table(rows, "table criteria");
}

std::string row(std::string_view name, const std::string& value) {
  return fmt::format("<tr><th>{}</th><td>{}</td></tr>\n", name, html::escape(value));
}

std::string stream_rows(std::string_view name, const StreamSummary& stream) {
  const std::string gaps =
      stream.gaps == 0 ? "no gaps"
                       : fmt::format("{} gaps, the longest {:.3f} s", stream.gaps, stream.longest_gap_s);
  return row(fmt::format("{} stamps", name),
             fmt::format("{} time, {:.2f} Hz over {:.2f} s, {}",
                         stream.stamp == StampSource::kHeader ? "header" : "receive", stream.rate_hz(),
                         stream.duration_s, gaps));
}

std::string recorded(const RecordingSummary& summary) {
  const LaserSummary& laser = summary.laser;
  const MotorSummary& motor = summary.motor;
  const double usable =
      laser.beams > 0 ? 100.0 * static_cast<double>(laser.usable_beams) / static_cast<double>(laser.beams)
                      : 0;
  std::string rows =
      row("laser", fmt::format("{}: {} scans of {} beams, {:.1f} % of them usable, median range {:.2f} m",
                               laser.topic, laser.used, laser.max_beams, usable, laser.median_range_m));
  rows += stream_rows("laser", laser);
  rows += row("motor", fmt::format("{} on {}: {} samples, {:.1f} to {:.1f}°", motor.joint, motor.topic,
                                   motor.used, motor.min_deg, motor.max_deg));
  rows += stream_rows("motor", motor);
  const std::string whole =
      motor.one_way ? fmt::format("none: {:.1f} turns, all one way", motor.turns_one_way())
      : motor.whole_sweeps() > 0
          ? fmt::format("{} whole, {:.3f} s each", motor.whole_sweeps(), motor.median_sweep_s)
          : "none whole";
  rows += row("sweeps", fmt::format("{}, at {:.1f}°/s: 1 ms is {:.3g}°", whole, motor.median_speed_deg_s,
                                    motor.deg_per_ms()));
  if (summary.motion) rows += row("the rig is", *summary.motion);
  return in_table(rows);
}

std::vector<std::string> all_warnings(const ReportContent& content) {
  std::vector<std::string> all = content.recording.warnings;
  const auto add = [&](const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings)
      if (std::ranges::find(all, warning) == all.end()) all.push_back(warning);
  };
  add(content.estimate.warnings);
  if (!content.maps.empty() && content.maps.back().consistency)
    add(content.maps.back().consistency->warnings);
  return all;
}

std::string warnings_list(std::span<const std::string> warnings) {
  std::string items;
  for (const std::string& warning : warnings)
    items += html::element("li", html::escape(with_plus_minus_sign(warning)));
  if (items.empty()) return "<p>None.</p>\n";
  return "<ul class=\"warnings\">" + items + "</ul>\n";
}

/// `look`: classes of the style sheet.
std::string figure(std::string_view look, const std::string& picture, const std::string& caption) {
  return fmt::format("<figure class=\"{}\">{}{}</figure>\n", look, picture,
                     html::element("figcaption", html::escape(caption)));
}

/// A picture for wide windows and paper, and one for narrow windows.
Result<std::string> both_widths(const Result<std::string>& wide_svg, const Result<std::string>& narrow_svg) {
  if (!wide_svg) return wide_svg;
  if (!narrow_svg) return narrow_svg;
  return "<div class=\"chart wide\">" + html::inline_svg(*wide_svg) + "</div><div class=\"chart narrow\">" +
         html::inline_svg(*narrow_svg) + "</div>";
}

/// A class for what a live map of the page stands for, while it is drawn.
const char* stationary_class(const ReportContent& content) {
  return content.live ? "still" : "alone";
}

/// A chart whose title says where its criterion by itself is best: "Matches n [10³]: most at 24.02 ms".
Chart with_own_best(Chart chart) {
  if (chart.markers.empty()) return chart;
  const ChartMarker& best = chart.markers.front();
  const auto& curve = chart.series.front().y;
  const auto first = std::ranges::find_if(curve, [](const auto& value) { return value.has_value(); });
  const bool is_max = first != curve.end() && best.y > **first;
  chart.title += fmt::format(": {} at {}", is_max ? "most" : "least", offset_text(best.x * 1e-3, {}));
  return chart;
}

Result<std::string> curves(const ReportContent& content) {
  std::string pictures;
  for (const Chart& chart : evidence_charts(content)) {
    ComparisonOptions look;
    look.background = Background::kWhite;
    look.width_px = 520;
    look.height_px = 380;
    const auto svg = encode_svg(charts_picture(std::span(&chart, 1), look));
    if (!svg) return svg;
    pictures += html::inline_svg(*svg);
  }
  if (pictures.empty()) return pictures;
  return fmt::format(
      "<section class=\"{}\">{}<div class=\"charts\">{}</div>\n<p class=\"caption\">Each point is one "
      "candidate offset; a larger mark is the best value of that criterion by itself; the dashed line is "
      "the offset found, the same in all charts.</p></section>\n",
      stationary_class(content), html::element("h2", "The criteria over the offset"), pictures);
}

std::string parameter_row(const RigParameter& parameter) {
  const std::string unit = parameter.unit == "deg" ? "°" : " " + parameter.unit;
  const std::string prior = parameter.prior ? fmt::format("± {:.4g}{}", *parameter.prior, unit) : "";
  return fmt::format(
      "<tr><td>{}</td><td class=\"number-cell\">{:.4g}{}</td><td class=\"number-cell\">{}</td><td "
      "class=\"number-cell\">{}</td></tr>\n",
      html::escape(parameter.name), parameter.given + 0.0, unit, in_words(parameter), prior);
}

std::string rig_table(const SolvedRig& solved) {
  std::string rows =
      "<tr><th></th><th class=\"number-cell\">rig file</th><th class=\"number-cell\">found</th><th "
      "class=\"number-cell\">prior</th></tr>\n";
  for (const RigParameter& parameter : rig_parameters(solved)) rows += parameter_row(parameter);
  std::string reasons;
  for (const std::string& reason : reasons_of(solved))
    reasons += html::element("li", html::escape(with_plus_minus_sign(reason)));
  if (!reasons.empty()) reasons = "<ul>" + reasons + "</ul>\n";
  return in_table(rows) + reasons +
         fmt::format(
             "<p class=\"caption\">One standard deviation each. Kept: turning the laser about the motor's "
             "axis "
             "and shifting it along the axis have no effect on a map. {}</p>\n",
             residual_text(solved));
}

/// What was solved for beside the offset, and how it shows.
Result<std::string> rig_part(const ReportContent& content) {
  if (!content.estimate.rig) return std::string();
  const SolvedRig& solved = *content.estimate.rig;
  const std::string table = html::element("h2", "The rig") + rig_table(solved);
  if (solved.residuals.before.empty()) return table;
  const auto svg_of = [&](int width_px, int height_px) {
    ComparisonOptions look;
    look.background = Background::kWhite;
    look.width_px = width_px;
    look.height_px = height_px;
    return encode_svg(residual_picture(solved.residuals, look));
  };
  return both_widths(svg_of(1100, 520), svg_of(460, 800)).map([&](const std::string& pictures) {
    return table +
           figure("residuals", pictures,
                  "How far the points lie from flat surfaces, over the motor's angle and the direction of "
                  "the beam. A wrong mount or encoder shows as a pattern; without a pattern only range noise "
                  "remains. Orange: behind the surface; violet: in front of it; grey: too few points.");
  });
}

Result<std::string> over_time_strip(const ReportContent& content) {
  if (!content.over_time || !content.over_time->over_time) return std::string();
  const auto chart = over_time_chart(*content.over_time, style_of(Background::kWhite));
  if (!chart) return tl::unexpected(chart.error());
  const auto svg_of = [&](int width_px) {
    ComparisonOptions look;
    look.background = Background::kWhite;
    look.width_px = width_px;
    look.height_px = 300;
    return encode_svg(charts_picture(std::span(&*chart, 1), look));
  };
  return both_widths(svg_of(1100), svg_of(460)).map([](const std::string& pictures) {
    return html::element("h2", "The offset over time") + pictures +
           "\n<p class=\"caption\">Each point is one window, with a bar of one sigma to either side; the "
           "line is the course fitted to them.</p>\n";
  });
}

std::string thickness_table(const ReportContent& content) {
  std::string rows;
  for (const ComparedMap& map : content.maps) {
    if (!map.thickness || !map.thickness->map) continue;
    const char* chip = &map == &content.maps.front() ? "map-a" : "map-b";
    const std::string name =
        map.label.empty() ? fmt::format("offset {} ms", offset_label_ms(*map.offset_s)) : map.label;
    rows += fmt::format("<tr><th><span class=\"{}\"></span>{}</th><td>{}</td></tr>\n", chip, name,
                        html::escape(in_words(map)));
  }
  if (rows.empty()) return rows;
  const auto& consistency = content.maps.back().consistency;
  if (consistency) rows += row("both maps", in_words(*consistency));
  return in_table(rows) +
         "<p class=\"caption\">How thick flat surfaces are in the map: the width at half height across "
         "each. In a sharp map this is the range noise.</p>\n";
}

tl::unexpected<Error> interrupted() {
  return failure(ExitCode::kInterrupted, "interrupted while drawing the report");
}

Result<std::string> maps(const ReportContent& content, const Job& job) {
  if (content.maps.empty()) return std::string();
  ComparisonOptions look;
  look.title = content.recording.name;
  look.width_px = 1800;
  look.height_px = 1100;
  const bool of_rigs = content.estimate.offset_is_gauge();
  std::vector<std::string> pngs;  // for light pages and paper, and for dark screens
  for (const Background background : {Background::kLight, Background::kDark}) {
    look.background = background;
    const auto drawn = comparison_picture(content.maps, nullptr, look).and_then([&](const Picture& picture) {
      return job.cancelled() ? Result<Image>(interrupted()) : draw(picture);
    });
    if (!drawn) return tl::unexpected(drawn.error());
    pngs.push_back(encode_png(*drawn));
  }
  return fmt::format("<h2 class=\"{}\">{}</h2>\n", stationary_class(content),
                     of_rigs ? "The map with the rig as given, and as found"
                             : "The map 5 ms off, and at the answer") +
         thickness_table(content) +
         figure(
             stationary_class(content),
             html::png_images(pngs[0], pngs[1], "Two maps from above, side by side"),
             of_rigs
                 ? "Only the rig differs. If the right picture is sharper, the rig that was found is better."
                 : "Only the offset differs. If the right picture is sharper, the answer is the better offset.");
}

Result<std::string> profile(const ReportContent& content) {
  if (!content.section || content.maps.empty()) return std::string();
  std::vector<NamedProfile> profiles;
  std::string caption = "Points across one wall";
  for (const ComparedMap& map : content.maps) {
    const std::string name = fmt::format("offset {} ms", offset_label_ms(*map.offset_s));
    profiles.push_back({name, profile_across(*map.cloud, *content.section)});
    const auto width_mm = profiles.back().profile.width_at_half_height_mm;
    if (width_mm) caption += fmt::format("; {}: {:.0f} mm wide at half height", name, *width_mm);
  }
  caption +=
      ". Points in the views from above: violet where the motor turned one way, green where it turned back.";
  const auto svg_of = [&](int width_px, int height_px) {
    ComparisonOptions look;
    look.background = Background::kWhite;
    look.width_px = width_px;
    look.height_px = height_px;
    return encode_svg(profile_picture(content.maps, *content.section, profiles, look));
  };
  return both_widths(svg_of(1300, 620), svg_of(400, 560)).map([&](const std::string& pictures) {
    return html::element("h2", "Profile across the wall that shows it best") +
           figure("profile", pictures, caption);
  });
}

}  // namespace

std::string report_command(const std::string& recording_name, const std::string& options) {
  return fmt::format("sweepscope report {}{} -o report", shell_word(recording_name), options);
}

std::vector<Chart> evidence_charts(const ReportContent& content) {
  const Style style = style_of(Background::kWhite);
  std::vector<Chart> charts = curve_charts(content.estimate, {}, style);
  if (content.criteria) {
    Estimate beside = *content.criteria;
    beside.identifiable = content.estimate.identifiable;
    beside.offset_s = content.estimate.offset_s;
    beside.sigma_s = content.estimate.sigma_s;
    std::ranges::move(curve_charts(beside, {}, style), std::back_inserter(charts));
  }
  std::ranges::transform(charts, charts.begin(), with_own_best);
  if (content.criteria && !charts.empty() && content.estimate.offset_s)
    charts.front().title += fmt::format(": found {}", offset_text(*content.estimate.offset_s, {}));
  return charts;
}

Result<std::string> report_html(const ReportContent& content, const Job& job) {
  const auto drawn = [&](const auto& part) -> Result<std::string> {
    if (job.cancelled()) return interrupted();
    return part(content);
  };
  const auto rig = drawn(rig_part), strip = drawn(over_time_strip), curve_part = drawn(curves),
             map_part = drawn([&](const auto&of) { return maps(of, job); }), profile_part = drawn(profile),
             data = drawn(
                 [](const auto&of) { return of.live ? live_map_data(*of.live) : Result<std::string>(); });
  for (const auto* part : {&rig, &strip, &curve_part, &map_part, &profile_part, &data}) {
    if (!*part) return tl::unexpected(part->error());
  }
  const std::string name = html::escape(content.recording.name);
  const std::vector<std::string> warnings = all_warnings(content);
  // The first screen has the answer and what it does to the map.
  const std::string body = fmt::format(
      "<h1>{}</h1>\n{}{}{}<h2 id=\"warnings\">Warnings</h2>\n{}{}{}{}{}{}<h2>What was recorded</h2>\n{}"
      "<h2>How this was made</h2>\n<p>{} sweeps, {} scans; sweepscope {}.</p>\n<pre>{}</pre>\n",
      name, answer(content.estimate, warnings.size()), content.live ? live_map_part(*content.live) : "",
      *map_part, warnings_list(warnings), criteria_table(content), *curve_part, *rig, *strip, *profile_part,
      recorded(content.recording), content.estimate.sweeps, content.estimate.scans, SWEEPSCOPE_VERSION,
      html::escape(content.command));
  return html_page(content.recording.name + ": offset between laser and motor", body, *data);
}

}  // namespace sweepscope
