#include "ui/explorer/place_list.hpp"

#include <algorithm>
#include <memory>

namespace sweepscope::ui {
namespace {

constexpr const char* kPlaces = "places";

}  // namespace

/// Half a second of work for 1.7 million points.
void PlaceList::compare(const Placement& a, const Placement& b) {
  if (compared_ == std::pair(a, b)) return;
  background_.cancel(kPlaces);
  compared_ = std::pair(a, b);
  if (a == b) return found_({});
  background_.start(kPlaces, kPlaces, "Comparing the maps",
                    [this, a, b](const Job& job) -> Background::Finish {
                      return [this, places = find_places(a, b, job)] { found_(places); };
                    });
}

void PlaceList::close() {
  background_.cancel(kPlaces);
  places_.clear();
  compared_.reset();
}

PlacePtr PlaceList::at(double number) const {
  if (places_.empty()) return nullptr;
  return places_[std::min(static_cast<std::size_t>(std::max(1.0, number)), places_.size()) - 1];
}

double PlaceList::nearest_to(const PlaceToLook& place) const {
  const auto nearest = std::ranges::min_element(places_, {}, [&](const PlacePtr& other) {
    return (other->found.region.centre_m - place.found.region.centre_m).norm();
  });
  return 1.0 + static_cast<double>(nearest - places_.begin());
}

}  // namespace sweepscope::ui
