#include "app/estimate_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/say.hpp"
#include "core/io/content_hash.hpp"
#include "core/numbers.hpp"
#include "core/offset/rig_estimate.hpp"
#include "core/results/estimate_json.hpp"
#include "core/results/rig_json.hpp"

namespace sweepscope::app {
namespace {

std::string criterion_line(const CriterionOptimum& criterion) {
  const std::string value = criterion.name == "n"   ? fmt::format("{:.0f} matches", criterion.value)
                            : criterion.name == "d" ? fmt::format("{:.4f}", criterion.value)
                                                    : fmt::format("{:.2f} mm", criterion.value * 1e3);
  const std::string where = criterion.name == "direct" ? "direct"
                            : criterion.name == "n"    ? "n maximum"
                                                       : criterion.name + " minimum";
  return fmt::format("  {:<10} {:>9.3f} ms   ({})", where, criterion.offset_s * 1e3, value);
}

std::string motion_line(const UsedMotion& motion) {
  const char* kind = motion.kind == UsedMotion::Kind::kPoses      ? "poses"
                     : motion.kind == UsedMotion::Kind::kOdometry ? "odometry"
                                                                  : "imu";
  std::string line =
      fmt::format("{:<8} {} as {}", kind, motion.name, motion.trusted ? "the truth" : "a prior");
  if (!motion.time_shift_s) return line;
  line += fmt::format("; time shift {:.3f} ms", *motion.time_shift_s * 1e3);
  if (motion.time_shift_sigma_s) line += fmt::format(" +- {:.3f} ms", *motion.time_shift_sigma_s * 1e3);
  return line + "      t_laser = t_" + kind + " + time shift";
}

std::string part_line(const char* name, const RigFinding& finding, const std::string& value) {
  return fmt::format("{:<8} {}", name, finding.identifiable ? value : "cannot be determined");
}

std::string mount_text(const SolvedRig& solved) {
  const Eigen::Vector3d &rpy_deg = solved.rig.mount.laser_in_motor_rpy_deg,
                        &xyz_m = solved.rig.mount.laser_in_motor_xyz_m;
  const MountSigma sigma = mount_sigma(solved);
  const std::string turn =
      fmt::format("roll, pitch, yaw {:.4f}, {:.4f}, {:.4f} deg (+- {:.4f}, {:.4f}, {:.4f})", rpy_deg.x(),
                  rpy_deg.y(), rpy_deg.z(), sigma.rpy_deg.x(), sigma.rpy_deg.y(), sigma.rpy_deg.z());
  if (solved.along_walk) return turn + "; x, y, z as in the rig file";
  return turn + fmt::format("; x, y, z {:.5f}, {:.5f}, {:.5f} m (+- {:.5f}, {:.5f}, {:.5f})", xyz_m.x(),
                            xyz_m.y(), xyz_m.z(), sigma.xyz_m.x(), sigma.xyz_m.y(), sigma.xyz_m.z());
}

void print_rig(const SolvedRig& solved) {
  const auto sigma_deg = [&](RigUnknown i) { return std::sqrt(solved.covariance(i, i)) * kDegPerRad; };
  if (solved.mount.solved) print("{}\n", part_line("mount", solved.mount, mount_text(solved)));
  if (solved.play.solved)
    print("{}\n", part_line("play", solved.play,
                            fmt::format("{:.4f} deg +- {:.4f}", solved.rig.gear.play_deg, sigma_deg(kPlay))));
  if (solved.encoder.solved)
    print("{}\n",
          part_line("encoder", solved.encoder,
                    fmt::format("shows the angle + {:.4f} deg sin(angle + {:.1f} deg); +- {:.4f} deg",
                                solved.rig.gear.encoder_amplitude_deg, solved.rig.gear.encoder_phase_deg,
                                std::max(sigma_deg(kEncoderSine), sigma_deg(kEncoderCosine)))));
  if (solved.along_walk)
    print("matches  {:.2f} mm apart before, {:.2f} mm after\n", solved.residual_before_m * 1e3,
          solved.residual_after_m * 1e3);
  else if (solved.points > 0)
    print("surfaces {:.2f} mm thick before, {:.2f} mm after; {} of them, {} points\n",
          solved.residual_before_m * 1e3, solved.residual_after_m * 1e3, solved.surfaces, solved.points);
}

// What a rig that is not as its file says would add: play of 0.1 deg and a tilt of 1 deg are usual.
void print_effects(const RigEffects& effects) {
  std::string line = fmt::format("rig      0.1 deg of gear play would add {:.3f} ms",
                                 effects.play_s_rad * 0.1 * kRadPerDeg * 1e3);
  if (effects.mount_tilt_s_rad)
    line +=
        fmt::format("; 1 deg of tilt of the mount {:.3f} ms", *effects.mount_tilt_s_rad * kRadPerDeg * 1e3);
  print("{}\n", line);
}

void print_over_time(const OffsetOverTime& over_time) {
  if (!over_time.course) return;
  const OffsetCourse& course = *over_time.course;
  const char* kind = course.windows < 2  ? "not determined"
                     : course.constant() ? "constant"
                                         : "at the recording's middle";
  print("course   {}; {} of {} windows have an offset\n", kind, course.windows, over_time.windows.size());
  if (course.rate_sigma > 0)
    print("rate     {:.3f} +- {:.3f} ppm (1 sigma), {:.3f} ms a minute\n", course.rate * 1e6,
          course.rate_sigma * 1e6, course.rate * 60e3);
  for (const OffsetJump& jump : course.jumps)
    print("jump     {:.3f} +- {:.3f} ms between {:.1f} and {:.1f} s\n", jump.size_s * 1e3, jump.sigma_s * 1e3,
          jump.begin_s, jump.end_s);
}

// What each of several recordings contributes, and how they agree.
void print_together(const Together& together) {
  for (const RecordingOfRig& recording : together.recordings) {
    std::vector<std::string> parts;
    if (recording.offset_s)
      parts.push_back(
          fmt::format("{:.3f} +- {:.3f} ms", *recording.offset_s * 1e3, *recording.sigma_s * 1e3));
    if (recording.offset_s && !together.own_offsets)
      parts.push_back(fmt::format("{:.0f} % of the offset", recording.share * 100));
    if (recording.residual_after_m)
      parts.push_back(fmt::format("surfaces {:.2f} mm thick before, {:.2f} mm after",
                                  *recording.residual_before_m * 1e3, *recording.residual_after_m * 1e3));
    if (recording.turn_sigma_rad)
      parts.push_back(fmt::format("by itself the mount +- {:.3f} deg, +- {:.1f} mm",
                                  *recording.turn_sigma_rad * kDegPerRad, *recording.shift_sigma_m * 1e3));
    for (const std::string& reason : recording.reasons) parts.push_back(reason);
    print("  {}: {}\n", recording.recording, fmt::format("{}", fmt::join(parts, "; ")));
  }
  if (together.degrees_of_freedom > 0)
    print("agreement  chi-square {:.1f} for {} degrees of freedom\n", together.chi_square,
          together.degrees_of_freedom);
}

void print_offset(const Estimate& estimate) {
  if (estimate.together && estimate.together->own_offsets && estimate.identifiable) {
    print("offset   one for each recording      t_motor = t_laser + offset\n");
  } else if (estimate.identifiable) {
    const std::string sigma =
        estimate.sigma_s ? fmt::format(" +- {:.3f} ms (1 sigma)", *estimate.sigma_s * 1e3) : "";
    print("offset   {:.3f} ms{}      t_motor = t_laser + offset\n", *estimate.offset_s * 1e3, sigma);
  } else {
    print("offset   {}\n", estimate.offset_is_gauge() ? "cannot be determined, and does not blur the map"
                                                      : "cannot be determined from this recording");
    for (const std::string& reason : estimate.reasons()) print("  why: {}\n", reason);
  }
}

void print_answer(const Estimate& estimate) {
  print_offset(estimate);
  if (estimate.together) print_together(*estimate.together);
  if (estimate.over_time) print_over_time(*estimate.over_time);
  if (estimate.sample)
    print("sample   {} of {} sweeps, in {} groups spread evenly\n", estimate.sample->sweeps,
          estimate.sample->of_sweeps, estimate.sample->groups);
  print("method   {}, {} sweeps, {} scans, {} candidates\n", to_text(estimate.method), estimate.sweeps,
        estimate.scans, estimate.curve.size());
  if (estimate.kind) print("kind     {}: {}\n", to_text(*estimate.kind), estimate.kind_reason);
  if (const auto& part = estimate.stationary_part)
    print("window   {:.1f} to {:.1f} s, in which the rig was stationary: --window {:.6g}:{:.6g}\n",
          part->begin_s, part->end_s, part->begin_s, part->end_s);
  if (estimate.rig) print_rig(*estimate.rig);
  if (estimate.rig_effects && estimate.identifiable) print_effects(*estimate.rig_effects);
  if (estimate.motion) print("{}\n", motion_line(*estimate.motion));
  for (const CriterionOptimum& criterion : estimate.criteria) print("{}\n", criterion_line(criterion));
  for (const std::string& warning : estimate.warnings) say("warning: {}\n", warning);
}

}  // namespace

void declare_estimate_options(CLI::App& command, EstimateOptions& estimate,
                              std::initializer_list<std::string_view> names, const std::string& heading) {
  for (const EstimateOption& option : estimate_options()) {
    if (names.size() > 0 && std::ranges::find(names, option.name) == names.end()) continue;
    const auto set = [&estimate, &option](const std::vector<std::string>& texts) {
      for (const std::string& text : texts)
        if (const auto done = option.set(estimate, text); !done)
          throw CLI::ValidationError("--" + option.name + " " + done.error().message + ", and got " + text);
    };
    CLI::Option* declared =
        command.add_option_function<std::vector<std::string>>("--" + option.name, set, option.help)
            ->type_name(option.type)
            ->type_size(1)
            ->expected(option.value_optional ? 0 : 1,
                       option.repeats ? CLI::detail::expected_max_vector_size : 1)
            ->allow_extra_args(false)
            ->group(heading);
    if (!option.choices.empty()) declared->check(CLI::IsMember(option.choices));
  }
}

void EstimateInput::declare(CLI::App& app) {
  recording.declare(app);
  recording.declare_computing(app);
  declare_estimate_options(app, estimate);
}

void EstimateOutput::declare(CLI::App& app) {
  declare_json(app);
  declare_others(app, "Options");
}

void EstimateOutput::declare_json(CLI::App& app) {
  app.add_option("--json", json, "Write the result as JSON; - for stdout")->type_name("F");
}

void EstimateOutput::declare_others(CLI::App& app, const std::string& heading) {
  app.add_option("--csv", csv,
                 "Write the criteria over the offset as CSV, or the windows of --over-time; - for stdout")
      ->type_name("F")
      ->group(heading);
  app.add_flag("--no-timing", no_timing,
               "Write cpu_s and wall_s as null, so that equal runs give equal bytes")
      ->group(heading);
}

Result<void> EstimateOutput::check(std::vector<std::filesystem::path> inputs,
                                   std::vector<std::string> others) const {
  others.insert(others.end(), {json, csv});
  return check_outputs(others, std::move(inputs));
}

Result<void> EstimateOutput::write(const Estimate& estimate) const {
  const Timing timing = no_timing ? Timing::kNull : Timing::kWritten;
  Result<void> first, second;
  if (!json.empty()) first = write_text(json, estimate_to_json(estimate, timing));
  if (!csv.empty())
    second =
        write_text(csv, estimate.over_time ? over_time_to_csv(*estimate.over_time) : curve_to_csv(estimate));
  return first ? second : first;
}

std::vector<std::string> deciding_options(const CLI::App& command) {
  static constexpr std::array kOthers{"--rig",    "--json",  "--csv",    "--no-timing", "--threads",
                                      "--resume", "--shard", "--expect", "--table",     "--trend"};
  std::vector<std::string> options;
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = option->get_name();
    if (option->get_positional() || std::find(kOthers.begin(), kOthers.end(), name) != kOthers.end())
      continue;
    for (const std::string& value : option->results()) options.push_back(fmt::format("{}={}", name, value));
  }
  return options;
}

Result<CandidateSearch> candidate_search(const RecordingOptions& recording,
                                         std::vector<std::string> options) {
  CandidateSearch search;
  search.recording = recording.recording.string();
  search.options = std::move(options);
  if (recording.rig) search.rig = recording.rig->string();
  const auto hash = [](std::string& into, const std::filesystem::path& path) {
    return recording_content_hash(path).map([&](std::string&& digits) { into = std::move(digits); });
  };
  const auto done =
      program_content_hash()
          .map([&](std::string&& digits) { search.program = std::move(digits); })
          .and_then([&] { return hash(search.recording_hash, recording.recording); })
          .and_then([&] { return recording.rig ? hash(search.rig_hash, *recording.rig) : Result<void>(); });
  if (!done) return tl::unexpected(done.error());
  return search;
}

Result<std::unique_ptr<CandidateFile>> keep_while_working(const std::filesystem::path& path,
                                                          const RecordingOptions& recording,
                                                          std::vector<std::string> deciding) {
  return candidate_search(recording, std::move(deciding)).and_then([&](const CandidateSearch& search) {
    return CandidateFile::open_while_working(path, search);
  });
}

Error ended(Error error, CandidateFile& kept) {
  if (kept.held() == 0)
    kept.remove();
  else if (error.code == ExitCode::kInterrupted)
    error.message = kept.interrupted_in_words();
  return error;
}

ExitCode conclude(const Estimate& estimate, const EstimateOutput& output) {
  const auto written = output.write(estimate);
  if (!output.on_stdout()) print_answer(estimate);
  if (!written) return fail(written.error());
  return has_answer(estimate) ? ExitCode::kDone : ExitCode::kNotIdentifiable;
}

}  // namespace sweepscope::app
