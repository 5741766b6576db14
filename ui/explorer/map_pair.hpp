#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ui/explorer/known_blur.hpp"
#include "ui/explorer/solved_maps.hpp"
#include "ui/model/placed_cloud.hpp"
#include "ui/model/places.hpp"

namespace sweepscope::ui {

enum class Side { kA, kB };
inline constexpr std::array kBothSides{Side::kA, Side::kB};
inline Side other_side(Side side) {
  return side == Side::kA ? Side::kB : Side::kA;
}
inline double offset_ms(const Settings& settings, Side side) {
  return side == Side::kA ? settings.offset_a_ms : settings.offset_b_ms;
}
/// The maps whose pictures a layout shows.
std::vector<Side> sides_of(Layout layout);

/// The state of the map of a pane.
enum class PaneState {
  kEmpty,        // no recording
  kProvisional,  // nothing solved yet: the first sweep or second, as if the rig were stationary
  kPreview,      // beams placed along the path that was solved for another offset
  kSolved,       // odometry and mapping at this offset
};

/// The points of a pane to place, their placement and their colours.
struct CloudRequest {
  Placement placement;
  CloudLook look;
  std::optional<Placement> other;  // for the difference: the placement that distances are measured from

  const Placement* other_or_null() const { return other ? &*other : nullptr; }
  bool operator==(const CloudRequest&) const = default;
};

/// The content of a pane.
struct Pane {
  PaneState state = PaneState::kEmpty;
  std::optional<CloudRequest> request;
  PlacedCloudPtr coarse, full;  // full is null while it is being placed
  BeamValuesPtr slow;           // of a slow colouring; null for any other
  ColourBy slow_colouring = ColourBy::kElevation;
  std::optional<Placement> slow_placement;  // the placement whose values they are
  std::optional<MapThickness> thickness;    // of the map, with slow values that are its blur
  std::string problem;                      // why the map could not be solved
  bool lost = false;
  std::shared_ptr<const MapConsistency> consistency;  // of the map's path; null if it is not known
  std::string warning;                                // of the path; else empty
  /// A close-up of the place that is looked at; null without one. Placed with what `request` asks for.
  PlacedCloudPtr close_up;
  PlacePtr close_up_place;
  std::optional<CloudRequest> close_up_request;
  BeamValuesPtr close_up_slow;

  /// All points, or the coarse ones until they are there.
  const PlacedCloudPtr& best() const { return full ? full : coarse; }
};

/// Map A and map B at the offsets of the settings: solved in the background, previewed until then.
class MapPair {
 public:
  explicit MapPair(Background& background) : solved(background), blur(background), background_(background) {}

  void open(LoadedPtr loaded, SolvedMapPtr first, std::optional<RigKind> assume);
  void close();
  const Pane& pane(Side side) const { return panes_[static_cast<std::size_t>(side)]; }
  /// What of both maps these heights show: the view is fitted to it. Empty without a recording.
  std::optional<Box> extent_in_view(Heights heights) const;
  ColourSpan shown_span() const { return {look_.from, look_.to}; }

  /// While a handle is held, offsets are previewed and nothing is solved.
  void hold(bool held) { held_ = held; }
  bool is_held() const { return held_; }
  /// Once per frame with a recording: shows what the settings ask for, and starts the work for it.
  /// `estimating`: a walk's first map waits for the estimate, whose trajectory it is placed along.
  void update(const Settings& settings, double seconds_since_last, bool estimating);
  /// Places the close-ups of a place, where they are not of it yet; null: none.
  void show_close_ups(const PlacePtr& place);
  /// Of what is being solved and placed.
  void cancel(const Settings& settings);

  /// Whether a pane waits for its settings to rest before all its points are placed.
  bool waits_to_place() const;
  /// Whether all points of both maps are placed.
  bool has_all_points() const { return panes_[0].full && panes_[1].full; }
  /// Whether both maps are solved at their own offsets, a stationary rig's too, and have all their points:
  /// what is found from them does not depend on which work ended first.
  bool is_complete() const;
  /// The same, or it is known why a map could not be solved.
  bool at_rest() const;

  SolvedMaps solved;
  KnownBlur blur;

 private:
  /// All points of a pane, and what came with them.
  struct PlacedAll {
    PlacedCloudPtr full, coarse;  // coarse: where its colours had to wait for slow values, else null
    SlowValues slow;
  };

  Pane& pane_of(Side side) { return panes_[static_cast<std::size_t>(side)]; }
  SolvedMapPtr map_for(Side side, double offset_s) const;
  ColourSpan wanted_span(const Settings& s, const Placement& a, const Placement& b) const;
  CloudLook wanted_look(const Settings& settings, const Placement& a, const Placement& b);
  void show_both(const Settings& settings);
  void show(Side side, CloudRequest request);
  void use_known_blur(Pane& pane, const Placement& placement) const;
  void place_close_up(Side side, const PlacePtr& place);
  static PlacedAll place_fully(const CloudRequest& request, const SlowValues& known, const Job& job);
  void start_full();
  void take(std::span<const Side> sides, std::span<const CloudRequest> requests,
            std::span<const PlacedAll> placed);

  Background& background_;
  CloudLook look_;
  ColourSpan span_;  // of the colouring below, for both maps
  ColourBy span_colouring_ = ColourBy::kElevation;
  std::array<Pane, 2> panes_;
  double rest_s_ = 0;    // since the coarse points of a pane changed
  std::string placing_;  // key of the job that places all points
  std::size_t placings_ = 0;
  bool held_ = false;
};

}  // namespace sweepscope::ui
