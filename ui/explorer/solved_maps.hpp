#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "ui/jobs/background.hpp"
#include "ui/model/solved_map.hpp"

namespace sweepscope::ui {

/// The last maps of a recording that were solved, by their offsets, and those that are being solved.
class SolvedMaps {
 public:
  explicit SolvedMaps(Background& background) : background_(background) {}

  /// `first`: the map before any is solved.
  void open(LoadedPtr loaded, SolvedMapPtr first, std::optional<RigKind> assume);
  void close();
  const LoadedPtr& loaded() const { return loaded_; }

  /// The map at this offset, else the one at the nearest offset, else the first; null without a recording.
  SolvedMapPtr nearest(double offset_s) const;
  /// Whether beams that are placed along this map's path at this offset are the map at this offset.
  bool is_exact(const SolvedMap& map, double offset_s) const;
  /// Why the map at this offset could not be solved; empty if it was, or was not tried.
  std::string problem_at(double offset_s) const;
  bool is_cancelled(double offset_s) const;
  /// Whether the map at this offset is still to come: it is neither solved, nor cancelled, nor unsolvable.
  bool is_to_come(double offset_s) const;

  /// Whether nothing is solved of a walk yet.
  bool is_first_to_come() const { return first_ && first_->provisional && solved_.empty(); }

  /// Solves these maps in the background, and no others. `held`: nothing is begun yet.
  void solve(std::span<const double> offsets_s, bool held);
  /// Whether the first map of this recording, or any, was solved since this was asked last.
  bool take_first_solved() { return std::exchange(first_solved_, false); }
  bool take_solved() { return std::exchange(newly_solved_, false); }
  /// By a person: what is not solved at these offsets is not begun again by itself.
  void cancel(std::span<const double> offsets_s);
  void forget_cancelled() { cancelled_.clear(); }
  /// What was cancelled and what failed is tried again.
  void retry();

 private:
  bool is_to_come_ns(std::int64_t offset_ns) const;
  void start(std::int64_t offset_ns);
  void keep(std::int64_t offset_ns, const Result<SolvedMapPtr>& solved);

  Background& background_;
  LoadedPtr loaded_;
  SolvedMapPtr first_;
  std::optional<RigKind> assume_;
  bool first_solved_ = false, newly_solved_ = false;
  std::map<std::int64_t, SolvedMapPtr> solved_;  // by the offset in nanoseconds
  std::map<std::int64_t, std::string> unsolvable_;
  std::set<std::int64_t> cancelled_;
  std::vector<std::int64_t> order_;  // oldest first
};

}  // namespace sweepscope::ui
