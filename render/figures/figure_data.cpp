#include "render/figures/figure_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <system_error>

#include "core/io/atomic_file.hpp"
#include "core/io/content_hash.hpp"
#include "core/map/feature_points.hpp"
#include "core/map/offset_map.hpp"
#include "core/offset/readings/fitting_recording.hpp"
#include "core/offset/walk/walk.hpp"
#include "core/recording/rig.hpp"
#include "core/results/candidate_file.hpp"
#include "core/results/estimate_json.hpp"

namespace sweepscope {
namespace {

/// Everything that the simulation depends on, in one line.
std::string canonical(const SimulationOptions& o) {
  return fmt::format("simulate {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {}", o.scene, o.offset_s,
                     o.seed, o.duration_s.value_or(-1), o.noise_m.value_or(o.scanner.noise_m), o.dropout,
                     o.sweep_s, simulation::name_of(o.motor), o.encoder_step_deg, o.encoder_hz,
                     o.encoder_jitter_s, o.mixed_pixels, o.grazing_bias_m, o.stamp_jitter_s, o.backlash_deg,
                     o.clock_drift_ppm, o.nudge_m);
}

template <typename T>
int number_of(const std::optional<T>& choice) {
  return choice ? static_cast<int>(*choice) : -1;
}

Result<Recording> read(const RecordedFile& file, const std::optional<TimeWindow>& part, const Job& job) {
  ReadOptions options;
  options.stamps = file.stamps;
  if (file.rig) {
    auto rig = read_rig(*file.rig);
    if (!rig) return tl::unexpected(rig.error());
    options.rig = std::move(*rig);
  }
  return read_fitting(file.path, options, job, part);
}

}  // namespace

std::string in_one_line(const EstimateOptions& o) {
  std::string text = fmt::format("estimate {} {} {} {}", number_of(o.method), number_of(o.assume),
                                 number_of(o.fit), number_of(o.scoring));
  if (o.weight_c) text += fmt::format(" weight {}", *o.weight_c);
  if (o.edge_gate_m) text += fmt::format(" edge {}", *o.edge_gate_m);
  if (o.plane_gate_m) text += fmt::format(" plane {}", *o.plane_gate_m);
  if (o.over_time_s) text += fmt::format(" over-time {}", *o.over_time_s);
  if (o.search) text += fmt::format(" search {}:{}", o.search->from_s, o.search->to_s);
  if (o.around)
    text += fmt::format(" around {}:{}:{}", o.around->initial_s, o.around->accuracy_s, o.around->steps);
  for (const OffsetRange& range : o.ranges)
    text += fmt::format(" {}:{}:{}", range.from_s, range.to_s, range.step_s);
  const RigSolve& s = o.solve;
  text += fmt::format(" solve {} {} {}", s.mount, s.play, s.encoder);
  return text + fmt::format(" prior {} {} {} {}", s.mount_deg, s.mount_mm, s.play_deg, s.encoder_deg);
}

FigureData::FigureData(const Recipe& recipe, std::filesystem::path cache_folder, const Job& job,
                       std::function<void(const std::string&)> said)
    : recipe_(recipe), cache_folder_(std::move(cache_folder)), job_(job), said_(std::move(said)) {}

std::optional<double> FigureData::truth_s(const std::string& recording) const {
  const auto* simulated = std::get_if<SimulationOptions>(&recipe_.recordings.at(recording).source);
  return simulated != nullptr ? std::optional(simulated->offset_s) : std::nullopt;
}

Result<const FigureData::Source*> FigureData::source(const std::string& name) {
  if (const auto known = sources_.find(name); known != sources_.end()) return &known->second;
  const RecordingSpec& spec = recipe_.recordings.at(name);
  std::optional<TimeWindow> part;
  if (spec.window_s) part = TimeWindow{spec.window_s->first, spec.window_s->second};
  Source source;
  if (const auto* options = std::get_if<SimulationOptions>(&spec.source)) {
    said_("simulate " + name);
    auto simulated = simulate(*options, job_);
    if (!simulated) return tl::unexpected(simulated.error());
    source.recording = std::move(simulated->recording);
    source.recording.name = name;
    for (const TruthPose& pose : simulated->truth) {
      source.truth.push_back({pose.time_s, pose.position_m, pose.orientation});
    }
  } else {
    said_("read " + name);
    auto recorded = read(std::get<RecordedFile>(spec.source), part, job_);
    if (!recorded) return tl::unexpected(recorded.error());
    source.recording = std::move(*recorded);
    part.reset();
  }
  if (part) {
    auto cut = cut_to_window(source.recording, *part, name);
    if (!cut) return tl::unexpected(cut.error());
    source.recording = std::move(*cut);
  }
  return &sources_.emplace(name, std::move(source)).first->second;
}

Result<const Recording*> FigureData::recording(const std::string& name) {
  return source(name).map([](const Source* found) { return &found->recording; });
}

Result<std::string> FigureData::fingerprint(const std::string& name) const {
  const RecordingSpec& spec = recipe_.recordings.at(name);
  std::string text = spec.window_s ? fmt::format("{}:{} ", spec.window_s->first, spec.window_s->second) : "";
  if (const auto* options = std::get_if<SimulationOptions>(&spec.source)) return text + canonical(*options);
  const auto& file = std::get<RecordedFile>(spec.source);
  for (const auto& path : {std::optional(file.path), file.rig}) {
    if (!path) continue;
    const auto hash = file_content_hash(*path);
    if (!hash) return hash;
    text += *hash + " ";
  }
  return text + fmt::format("stamps {}", number_of(file.stamps));
}

Result<std::string> FigureData::estimate_key(const EstimateSpec& spec) const {
  const Result<std::string> program = program_content_hash();
  if (!program) return program;
  return fingerprint(spec.recording).map([&](const std::string& recording) {
    return content_hash(recording + "\n" + in_one_line(spec.options) + "\n" + *program);
  });
}

std::filesystem::path FigureData::candidates_of(const std::string& key) const {
  return cache_folder_ / (key + ".candidates");
}

/// Finished candidates are kept until the answer is written; the direct method has none.
Result<Estimate> FigureData::compute(const std::string& name, const EstimateSpec& spec,
                                     const std::string& key) {
  const auto data = recording(spec.recording);
  if (!data) return tl::unexpected(data.error());
  said_("estimate " + name);
  if (method_of(spec.options, RigKind::kStationary) == Method::kDirect) {
    auto computed = sweepscope::estimate(**data, spec.options, job_);
    if (computed && computed->interrupted)
      return failure(ExitCode::kInterrupted, "interrupted in estimate " + name);
    return computed;
  }
  CandidateSearch search;
  search.recording = spec.recording;
  search.recording_hash = key;
  const auto kept = CandidateFile::open_while_working(candidates_of(key), search);
  if (!kept) return tl::unexpected(kept.error());
  auto computed = sweepscope::estimate(**data, spec.options, {kept->get(), {}}, job_);
  if (computed && computed->interrupted)
    return failure(ExitCode::kInterrupted, (*kept)->interrupted_in_words());
  return computed;
}

Result<Estimate> FigureData::computed_or_cached(const std::string& name, const EstimateSpec& spec) {
  const auto key = estimate_key(spec);
  if (!key) return tl::unexpected(key.error());
  const std::filesystem::path path = cache_folder_ / (*key + ".json");
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored)) {
    if (auto found = read_estimate_json(path)) return found;
  }
  const auto computed = compute(name, spec, *key);
  if (!computed) return tl::unexpected(computed.error());
  // Drawn from what the file holds, so that the first run's pictures are the second's.
  const std::string json = estimate_to_json(*computed, Timing::kNull);
  return write_file(path, json).and_then([&] {
    std::filesystem::remove(candidates_of(*key), ignored);
    return parse_estimate_json(json, path.string());
  });
}

Result<const Estimate*> FigureData::estimate(const std::string& name) {
  if (const auto known = estimates_.find(name); known != estimates_.end()) return &known->second;
  const EstimateSpec& spec = recipe_.estimates.at(name);
  auto found = spec.file.empty() ? computed_or_cached(name, spec) : read_estimate_json(spec.file);
  if (!found) return tl::unexpected(found.error());
  found->recording = spec.recording;
  return &estimates_.emplace(name, std::move(*found)).first->second;
}

Result<std::shared_ptr<const SolvedRig>> FigureData::solved_rig(const std::string& name) {
  const EstimateSpec& spec = recipe_.estimates.at(name);
  if (!spec.file.empty() || !spec.options.solve.any())
    return failure(ExitCode::kWrongUsage,
                   fmt::format("{}: estimate {} needs solve, such as solve: \"offset,mount\", and no file",
                               recipe_.path.string(), name));
  const auto data = recording(spec.recording);
  if (!data) return tl::unexpected(data.error());
  said_("solve for the rig of " + name);
  const auto found = sweepscope::estimate(**data, spec.options, job_);
  if (!found) return tl::unexpected(found.error());
  if (found->interrupted) return failure(ExitCode::kInterrupted, "interrupted in estimate " + name);
  if (!found->rig)
    return failure(
        ExitCode::kNotIdentifiable,
        fmt::format("estimate {}: {}", name,
                    found->refusals.empty() ? "the rig could not be solved for" : found->refusals[0].text));
  if (found->rig->along_walk)
    return failure(
        ExitCode::kNotIdentifiable,
        fmt::format("estimate {}: residuals over motor angle and beam require a stationary rig", name));
  return found->rig;
}

Result<void> FigureData::build(const std::string& name, bool true_poses, bool with_features,
                               std::span<const MapSpec> specs, std::vector<ComparedMap>& maps) {
  const auto data = source(name);
  if (!data) return tl::unexpected(data.error());
  std::vector<double> offsets_s;
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < specs.size(); ++i) {
    if (specs[i].recording != name || specs[i].true_poses != true_poses) continue;
    offsets_s.push_back(specs[i].offset_s);
    indices.push_back(i);
  }
  if (indices.empty()) return {};
  said_("map " + name);
  MapOptions options;
  if (true_poses) options.poses = (*data)->truth;
  auto built = build_maps((*data)->recording, offsets_s, options, job_);
  if (!built) return tl::unexpected(built.error());
  for (std::size_t k = 0; k < indices.size(); ++k) {
    ComparedMap& map = maps[indices[k]];
    map = compared_map((*data)->recording, (*built)[k]);
    map.label = specs[indices[k]].label;
    const bool features_only = specs[indices[k]].features_only;
    if (!with_features && !features_only) continue;
    const auto features = extract_features((*data)->recording, FeatureOptions(), job_);
    if (!features) return tl::unexpected(features.error());
    map.feature_kinds = feature_kinds(*features, *map.cloud);
    if (!features_only) continue;
    FeatureCloud cloud = feature_cloud(*map.cloud, map.feature_kinds);
    map.cloud = std::move(cloud.cloud);
    map.feature_kinds = std::move(cloud.kinds);
  }
  return {};
}

Result<LiveMap> FigureData::live(const InteractiveFigure& figure) {
  std::optional<Estimate> criteria;
  if (!figure.estimate.empty()) {
    const auto found = estimate(figure.estimate);
    if (!found) return tl::unexpected(found.error());
    criteria = **found;
  }
  const auto data = recording(figure.maps.at(0).recording);
  if (!data) return tl::unexpected(data.error());
  said_("map " + figure.maps[0].recording);
  const auto prepared = prepare(**data, FeatureOptions(), job_);
  if (!prepared) return tl::unexpected(prepared.error());
  const std::array<double, 2> offsets_s{figure.maps[0].offset_s, figure.maps.at(1).offset_s};
  auto built = build_maps(*prepared, offsets_s, {}, job_);
  if (!built) return tl::unexpected(built.error());
  std::vector<ComparedMap> still(2);
  for (std::size_t i = 0; i < still.size(); ++i) {
    still[i].label = figure.maps[i].label;
    still[i].offset_s = offsets_s[i];
    still[i].cloud = (*built)[i].cloud;
    still[i].path = std::move((*built)[i].trajectory);
  }
  LiveMap live =
      live_map(*prepared, built->front().walk, std::move(still), std::move(criteria), figure.points, job_);
  if (job_.cancelled()) return failure(ExitCode::kInterrupted, "interrupted while measuring the map");
  return live;
}

Result<std::vector<ComparedMap>> FigureData::maps(std::span<const MapSpec> specs, bool with_features) {
  std::vector<ComparedMap> maps(specs.size());
  std::set<std::pair<std::string, bool>> done;
  for (const MapSpec& spec : specs) {
    if (!done.emplace(spec.recording, spec.true_poses).second) continue;
    const auto built = build(spec.recording, spec.true_poses, with_features, specs, maps);
    if (!built) return tl::unexpected(built.error());
  }
  return maps;
}

}  // namespace sweepscope
