#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/map/turnable_map.hpp"
#include "core/offset/estimate.hpp"
#include "render/charts/chart.hpp"
#include "render/comparison/compared_map.hpp"
#include "render/comparison/comparison.hpp"
#include "render/page/beam_colours.hpp"

namespace sweepscope {

inline constexpr std::size_t kDefaultLivePoints = 300'000;
inline constexpr std::size_t kMaxLivePoints = 500'000;  // a page of these has at most 12 MB

/// The offsets that a live map can be turned to.
struct OffsetSpan {
  double from_s = 0, to_s = 0;
};

/// A span for a map that starts at these offsets: 10 ms to either side of them, within a quarter of the
/// motor's period about the middle, beyond which the map would be a mirror image.
OffsetSpan live_span(const PreparedRecording& prepared, double a_s, double b_s);

/// What a page needs to draw a map at any offset.
struct LiveMap {
  TurnableMap map;                 // with the beams that are drawn
  std::size_t usable_beams = 0;    // of which they were chosen
  OffsetSpan span;                 // of the offsets
  std::array<double, 2> offset_s;  // of the maps A and B at first
  /// The maps at those two offsets. Heights shown and ranges of the colours are theirs, as in the picture
  /// that stands for the live map on paper.
  std::vector<ComparedMap> still;
  std::optional<Estimate> criteria;
  std::vector<Chart> charts;  // over the offset; at first those of `criteria`
  BeamColours colours;
};

/// The live map of a recording, of at most `points` beams: chosen evenly in space in the map at A, which is
/// off the answer, so that blurred places keep theirs. `walk`: a solved trajectory, or null where the rig is
/// stationary. `still`: the maps at A and B. Their blur is measured unless that was done, and that of the map
/// as far beyond B as A is before it, where the span holds that and the points leave room for it. If `job` is
/// cancelled the result is unfinished.
LiveMap live_map(const PreparedRecording& prepared, std::shared_ptr<const SolvedWalk> walk,
                 std::vector<ComparedMap> still, std::optional<Estimate> criteria, std::size_t points,
                 const Job& job = {});

/// The part of a page in which the map is drawn, hidden until its script has drawn it. Pictures of the class
/// `still` are shown until then, and on paper.
std::string live_map_part(const LiveMap& live);

/// The data of that part: beams, heights, colours, criteria and shaders.
Result<std::string> live_map_data(const LiveMap& live);

}  // namespace sweepscope
