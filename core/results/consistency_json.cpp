#include "core/results/consistency_json.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace sweepscope {
namespace {

using Json = nlohmann::ordered_json;

double rounded(double value) {
  return std::round(value * 1e3) / 1e3;
}

Json at_json(double first_s, double again_s) {
  return Json::array({rounded(first_s), rounded(again_s)});
}

Json place_json(const Eigen::Vector3d& p_m) {
  return Json::array({rounded(p_m.x()), rounded(p_m.y()), rounded(p_m.z())});
}

template <typename Times>
Json times_json(const Times& times) {
  Json json = Json::array();
  for (const DoubtfulTime& time : times) json.push_back(at_json(time.at_s.begin_s, time.at_s.end_s));
  return json;
}

Json drifting_json(const std::vector<DriftingTime>& times) {
  Json json = Json::array();
  for (const DriftingTime& time : times)
    json.push_back({{"at_s", at_json(time.at_s.begin_s, time.at_s.end_s)},
                    {"place_m", place_json(time.place_m)},
                    {"direction", place_json(time.direction)},
                    {"drift_m", rounded(time.drift_m)}});
  return json;
}

}  // namespace

Json consistency_json(const MapConsistency* consistency) {
  if (consistency == nullptr) return nullptr;
  Json apart = Json::array();
  constexpr std::size_t kMax = 5;
  for (std::size_t i = 0; i < std::min(kMax, consistency->apart.size()); ++i) {
    const SurfacesApart& one = consistency->apart[i];
    apart.push_back({{"apart_m", rounded(one.apart_m)},
                     {"at_s", at_json(one.first_s, one.again_s)},
                     {"place_m", place_json(one.place_m)}});
  }
  const auto worst = consistency->worst();
  return {{"worst_m", worst ? Json(rounded(worst->apart_m)) : Json(nullptr)},
          {"at_s", worst ? at_json(worst->first_s, worst->again_s) : Json(nullptr)},
          {"place_m", worst ? place_json(worst->place_m) : Json(nullptr)},
          {"limit_m", rounded(consistency->limit_m)},
          {"warned", consistency->warned()},
          {"warnings", consistency->warnings},
          {"apart", std::move(apart)},
          {"unfit_s", times_json(consistency->unfit)},
          {"undetermined_s", times_json(consistency->undetermined)},
          {"drifting", drifting_json(consistency->drifting)}};
}

}  // namespace sweepscope
