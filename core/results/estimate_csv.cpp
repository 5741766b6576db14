#include <fmt/format.h>

#include "core/io/atomic_file.hpp"
#include "core/results/estimate_json.hpp"
#include "core/results/json_values.hpp"

namespace sweepscope {

std::string curve_to_csv(const Estimate& estimate) {
  std::string text = "offset_ms,d,translation_m,rotation_rad,signed_rotation_rad,n,e_m,capped_cost_m\n";
  for (const CurvePoint& point : estimate.curve) {
    text += fmt::format("{}", written_ms(point.offset_s));
    for (const CurveColumn& column : kCurveColumns) {
      const auto& value = point.*column.value;
      text += value ? fmt::format(",{}", *value) : ",";
    }
    text += '\n';
  }
  return text;
}

std::string over_time_to_csv(const OffsetOverTime& over_time) {
  std::string text = "t_s,offset_ms,sigma_ms,from_s,to_s,fit_ms\n";
  for (const OffsetWindow& window : over_time.windows) {
    const auto ms = [](const std::optional<double>& seconds) {
      return seconds ? fmt::format("{}", written_ms(*seconds)) : std::string();
    };
    const auto fit_s =
        over_time.course ? std::optional(over_time.course->offset_at_s(window.time_s)) : std::nullopt;
    text += fmt::format("{},{},{},{},{},{}\n", json::to_millisecond(window.time_s), ms(window.offset_s),
                        ms(window.sigma_s), json::to_millisecond(window.begin_s),
                        json::to_millisecond(window.end_s), ms(fit_s));
  }
  return text;
}

Result<void> write_curve_csv(const std::filesystem::path& path, const Estimate& estimate) {
  return write_file(path, curve_to_csv(estimate));
}

}  // namespace sweepscope
