#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/offset/estimate.hpp"
#include "core/recording/recording.hpp"
#include "core/rig_solve/rig_solve.hpp"
#include "render/figures/recipe.hpp"

namespace sweepscope {

/// Everything that a recipe can set of an estimate: different where the estimate may be.
std::string in_one_line(const EstimateOptions& options);

/// The recordings, estimates and maps that a recipe's figures are drawn from, each made on first use.
/// Estimates are kept in a folder under a hash of everything that they depend on (the recording's content,
/// the options, the program), so that a second run does not compute them again.
class FigureData {
 public:
  /// `said` receives a description of each long step: "estimate metro".
  FigureData(const Recipe& recipe, std::filesystem::path cache_folder, const Job& job,
             std::function<void(const std::string&)> said);

  Result<const Recording*> recording(const std::string& name);
  Result<const Estimate*> estimate(const std::string& name);
  /// The rig that an estimate with `solve` found, computed each time: files of estimates hold no residuals.
  Result<std::shared_ptr<const SolvedRig>> solved_rig(const std::string& name);
  /// Maps of one recording are built from the same scans. `with_features`: with each point's kind.
  Result<std::vector<ComparedMap>> maps(std::span<const MapSpec> specs, bool with_features);
  /// The maps of a page and what draws them at any offset.
  Result<LiveMap> live(const InteractiveFigure& figure);
  /// The true offset of a simulation.
  std::optional<double> truth_s(const std::string& recording) const;

 private:
  struct Source {
    Recording recording;
    std::vector<StampedPose> truth;
  };
  Result<const Source*> source(const std::string& name);
  Result<std::string> fingerprint(const std::string& recording) const;
  Result<std::string> estimate_key(const EstimateSpec& spec) const;
  std::filesystem::path candidates_of(const std::string& key) const;
  Result<Estimate> compute(const std::string& name, const EstimateSpec& spec, const std::string& key);
  Result<Estimate> computed_or_cached(const std::string& name, const EstimateSpec& spec);
  Result<void> build(const std::string& recording, bool true_poses, bool with_features,
                     std::span<const MapSpec> specs, std::vector<ComparedMap>& maps);

  const Recipe& recipe_;
  std::filesystem::path cache_folder_;
  const Job& job_;
  std::function<void(const std::string&)> said_;
  std::map<std::string, Source> sources_;
  std::map<std::string, Estimate> estimates_;
};

}  // namespace sweepscope
