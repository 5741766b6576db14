#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "ui/jobs/background.hpp"
#include "ui/model/places.hpp"

namespace sweepscope::ui {

/// The places where the two maps differ most, best first.
class PlaceList {
 public:
  /// `found` is called with each new list, to be kept.
  PlaceList(Background& background, std::function<void(std::vector<PlacePtr>)> found)
      : background_(background), found_(std::move(found)) {}

  /// Lists them in the background, unless these are the maps that were compared last.
  void compare(const Placement& a, const Placement& b);
  void keep(std::vector<PlacePtr> places) { places_ = std::move(places); }
  void close();

  /// Empty until both maps are solved, and where they do not differ.
  const std::vector<PlacePtr>& all() const { return places_; }
  /// Counted from 1; a number beyond the last means the last. Null without places.
  PlacePtr at(double number) const;
  /// The number of the place nearest to this one, of a list that is not empty.
  double nearest_to(const PlaceToLook& place) const;

 private:
  Background& background_;
  std::function<void(std::vector<PlacePtr>)> found_;
  std::vector<PlacePtr> places_;
  std::optional<std::pair<Placement, Placement>> compared_;
};

}  // namespace sweepscope::ui
