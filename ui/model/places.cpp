#include "ui/model/places.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/numbers.hpp"
#include "render/comparison/comparison_points.hpp"

namespace sweepscope::ui {
namespace {

constexpr std::size_t kMaxPlaces = 12;
constexpr double kMargin_m = 0.5;  // beams this far outside: another offset may move them in

/// A map's points by beam, and how high each is above the sensor's path; NaN if it has no place.
struct Heights3d {
  std::vector<std::array<float, 3>> xyz_m;
  std::vector<float> above_path_m;
};

Heights3d heights_of(const Placement& placement, const Job& job) {
  const Beams& beams = placement.loaded->beams;
  Heights3d all{place_beams(beams, placement.map->path, placement.offset_s, job),
                std::vector<float>(beams.size())};
  for (std::size_t i = 0; i < beams.size(); ++i)
    all.above_path_m[i] = all.xyz_m[i][2] - placement.map->path_height_m[beams.scan[i]];
  return all;
}

double ceiling_above_path_m(const SolvedMap& map) {
  return map.sharp_heights.empty() ? std::numeric_limits<double>::infinity() : map.sharp_heights.back().to_m;
}

SlabPoints above_the_path(const Heights3d& all, double ceiling_m) {
  SlabPoints out;
  for (std::size_t i = 0; i < all.xyz_m.size(); ++i) {
    const auto above_m = static_cast<double>(all.above_path_m[i]);
    if (!(above_m >= 0 && above_m <= ceiling_m)) continue;
    out.points.add(all.xyz_m[i], 0);
    out.above_path_m.push_back(all.above_path_m[i]);
  }
  return out;
}

double extent_m(const SolvedMap& map) {
  return (map.main_box.to_m - map.main_box.from_m).head<2>().maxCoeff();
}

bool lies_in(const PlaceToLook& place, const Heights3d& all, std::size_t beam, double margin_m) {
  const auto& p = all.xyz_m[beam];
  const Eigen::Vector2d& centre_m = place.found.region.centre_m;
  return static_cast<double>(all.above_path_m[beam]) > -margin_m &&
         std::abs(static_cast<double>(p[0]) - centre_m.x()) < place.width_m() / 2 + margin_m &&
         std::abs(static_cast<double>(p[1]) - centre_m.y()) < place.height_m() / 2 + margin_m;
}

PlaceToLook with_beams(PlaceToLook place, const Heights3d& a, const Heights3d& b) {
  std::vector<float> heights_m;
  for (std::size_t i = 0; i < a.xyz_m.size(); ++i) {
    if (lies_in(place, a, i, kMargin_m) || lies_in(place, b, i, kMargin_m))
      place.beams.push_back(static_cast<std::uint32_t>(i));
    if (lies_in(place, b, i, 0)) heights_m.push_back(b.xyz_m[i][2]);
  }
  if (!heights_m.empty()) place.z_m = static_cast<double>(quantile(heights_m, 0.5));
  return place;
}

}  // namespace

std::vector<PlacePtr> find_places(const Placement& a, const Placement& b, const Job& job) {
  const Heights3d at_a = heights_of(a, job), at_b = heights_of(b, job);
  if (job.cancelled()) return {};
  const double ceiling_m = ceiling_above_path_m(*b.map), height_m = close_up_height_m(extent_m(*b.map));
  const std::array maps{above_the_path(at_a, ceiling_m), above_the_path(at_b, ceiling_m)};
  std::vector<PlacePtr> places;
  for (DifferingPlace& found :
       differing_places(maps, height_m, PlaceToLook::kAspect * height_m, kMaxPlaces)) {
    if (job.cancelled()) return places;
    places.push_back(
        std::make_shared<PlaceToLook>(with_beams(PlaceToLook{std::move(found), 0, {}}, at_a, at_b)));
  }
  return places;
}

PlacedCloud place_close_up(const PlaceToLook& place, const Placement& placement, const CloudLook& look,
                           const Placement* other, const BeamValues* slow) {
  CloudLook above = look;
  above.heights = Heights::kSlab;
  above.slab_from_m = 0;
  above.slab_to_m = ceiling_above_path_m(*placement.map);
  above.box_from_m = above.box_to_m = {0, 0, 0};  // a place outside of it is a place all the same
  return place_chosen(placement, above, place.beams, other, slow);
}

}  // namespace sweepscope::ui
