#include <fmt/format.h>

#include <memory>

#include "app/commands.hpp"
#include "app/offset_texts.hpp"
#include "app/progress.hpp"
#include "app/recording_options.hpp"
#include "core/io/estimate_json.hpp"

namespace sweepscope::app {
namespace {

struct Options {
  RecordingOptions recording;
  EstimateOptions estimate;
  std::string json, csv;
  bool no_timing = false;
};

std::string criterion_line(const CriterionOptimum& criterion) {
  const std::string value = criterion.name == "n"   ? fmt::format("{:.0f} matches", criterion.value)
                            : criterion.name == "d" ? fmt::format("{:.4f}", criterion.value)
                                                    : fmt::format("{:.2f} mm", criterion.value * 1e3);
  const std::string where = criterion.name == "direct" ? "direct"
                            : criterion.name == "n"    ? "n greatest"
                                                       : criterion.name + " least";
  return fmt::format("  {:<10} {:>9.3f} ms   ({})\n", where, criterion.offset_s * 1e3, value);
}

void print_answer(const Estimate& estimate) {
  if (estimate.identifiable) {
    const std::string sigma =
        estimate.sigma_s ? fmt::format(" +- {:.3f} ms (1 sigma)", *estimate.sigma_s * 1e3) : "";
    fmt::print("offset   {:.3f} ms{}      t_motor = t_laser + offset\n", *estimate.offset_s * 1e3, sigma);
  } else {
    fmt::print("offset   cannot be determined from this recording\n");
    for (const std::string& reason : estimate.reasons) fmt::print("  why: {}\n", reason);
  }
  fmt::print("method   {}, {} sweeps, {} scans, {} candidates\n", estimate.method, estimate.sweeps,
             estimate.scans, estimate.curve.size());
  if (!estimate.kind.empty()) fmt::print("kind     {}: {}\n", estimate.kind, estimate.kind_reason);
  for (const CriterionOptimum& criterion : estimate.criteria) fmt::print("{}", criterion_line(criterion));
  for (const std::string& warning : estimate.warnings) fmt::print(stderr, "warning: {}\n", warning);
}

Result<void> write_results(const Options& options, const Estimate& estimate) {
  const Timing timing = options.no_timing ? Timing::kNull : Timing::kWritten;
  if (!options.json.empty()) {
    auto written = write_text(options.json, estimate_to_json(estimate, timing));
    if (!written) return written;
  }
  if (!options.csv.empty()) return write_text(options.csv, curve_to_csv(estimate));
  return {};
}

ExitCode run(const Options& options) {
  const auto threads = options.recording.limit_threads();
  Result<Estimate> found;
  {
    const Progress progress;
    const auto recording = options.recording.read(progress.job());
    if (!recording) return fail(recording.error());
    EstimateOptions estimate_options = options.estimate;
    estimate_options.assume = parse_method(options.recording.assume);
    found = estimate(*recording, estimate_options, progress.job());
  }
  if (!found) return fail(found.error());
  if (const auto written = write_results(options, *found); !written) return fail(written.error());
  if (options.json != "-" && options.csv != "-") print_answer(*found);
  if (found->interrupted) return ExitCode::kInterrupted;
  return found->identifiable ? ExitCode::kDone : ExitCode::kNotIdentifiable;
}

void declare_method(CLI::App& command, Options& options) {
  EstimateOptions& estimate = options.estimate;
  command
      .add_option_function<std::string>(
          "--method", [&estimate](const std::string& text) { estimate.method = parse_method(text); },
          "direct: the offset as an unknown of the least squares, for rigs that stood still and for walks; "
          "stationary: where odometry sees least motion (d); moving: where the map is clearest (n, e). "
          "Default: stationary or moving, as the motion test says")
      ->type_name("M")
      ->check(CLI::IsMember({"stationary", "moving", "direct"}));
  command
      .add_option_function<std::string>(
          "--fit",
          [&estimate](const std::string& text) {
            estimate.fit = text == "none" ? Fit::kNone : Fit::kParabola;
          },
          "none: the best candidate; parabola: through those within 3 ms of it (default: parabola for moving "
          "and for slow motors, else "
          "none)")
      ->type_name("F")
      ->check(CLI::IsMember({"none", "parabola"}));
  command
      .add_option_function<std::string>(
          "--scoring",
          [&estimate](const std::string& text) {
            estimate.scoring = text == "loam" ? Scoring::kLoam : Scoring::kTwoStage;
          },
          "two-stage: count matches after the alternating roll is taken out of the poses (default); loam: at "
          "LOAM's "
          "own poses, as the paper did")
      ->type_name("S")
      ->check(CLI::IsMember({"two-stage", "loam"}));
  command.add_option("--weight-c", estimate.weight_c, "c of d = sqrt(t^2 + c theta^2)")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command
      .add_option("--edge-gate-m", estimate.mapping.edge_gate_m, "delta_E: an edge match is nearer than this")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      .add_option("--plane-gate-m", estimate.mapping.plane_gate_m,
                  "delta_H: a plane match is nearer than this")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
}

void declare_search(CLI::App& command, Options& options) {
  EstimateOptions& estimate = options.estimate;
  command
      .add_option_function<std::vector<std::string>>(
          "--range",
          [&estimate](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) estimate.ranges.push_back(*parse_range_ms(text));
          },
          "Candidates in milliseconds, such as 19:29:1; repeatable (default: coarse to fine about 0)")
      ->type_name("FROM:TO:STEP")
      ->allow_extra_args(false)
      ->check([](const std::string& text) {
        return parse_range_ms(text) ? std::string()
                                    : "--range wants FROM:TO:STEP in milliseconds, and got " + text;
      });
  command
      .add_option_function<std::string>(
          "--around", [&estimate](const std::string& text) { estimate.around = parse_around_ms(text); },
          "The paper's search in milliseconds: 24:0.1:40 tries 24 and 20 steps of 0.1 to either side")
      ->type_name("INITIAL:ACCURACY:STEPS")
      ->check([](const std::string& text) {
        return parse_around_ms(text)
                   ? std::string()
                   : "--around wants INITIAL:ACCURACY:STEPS in milliseconds, and got " + text;
      });
}

}  // namespace

void add_estimate(CLI::App& app, ExitCode& exit_code) {
  CLI::App* command = app.add_subcommand("estimate", "Find the offset: t_motor = t_laser + offset");
  auto options = std::make_shared<Options>();
  options->recording.declare(*command);
  options->recording.declare_computing(*command);
  declare_method(*command, *options);
  declare_search(*command, *options);
  command->add_option("--json", options->json, "Write the result as JSON; - for stdout")->type_name("F");
  command->add_option("--csv", options->csv, "Write the criteria over the offset as CSV; - for stdout")
      ->type_name("F");
  command->add_flag("--no-timing", options->no_timing,
                    "cpu_s and wall_s are null: the same bytes run after run");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace sweepscope::app
