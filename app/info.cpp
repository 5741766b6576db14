#include <fmt/format.h>

#include <memory>

#include "app/commands.hpp"
#include "app/progress.hpp"
#include "app/recording_options.hpp"
#include "app/say.hpp"
#include "core/io/printable_text.hpp"
#include "core/offset/readings/beam_readings.hpp"
#include "core/offset/summary.hpp"
#include "core/recording/inspect.hpp"
#include "core/recording/rig.hpp"
#include "core/results/info_json.hpp"

namespace sweepscope::app {
namespace {

std::string row(std::string_view name, const std::string& value) {
  return fmt::format("  {:<10} {}\n", name, printable_line(value));
}

std::string topics_text(const RecordingSummary& summary) {
  std::size_t name_width = 0, type_width = 0;
  for (const RecordedTopic& topic : summary.topics) {
    name_width = std::max(name_width, printable_line(topic.name).size());
    type_width = std::max(type_width, printable_line(topic.type).size());
  }
  std::string text = "topics\n";
  for (const RecordedTopic& topic : summary.topics) {
    const bool laser = topic.name == summary.laser.topic, motor = topic.name == summary.motor.topic;
    text += fmt::format("  {:<{}}  {:<{}}  {:>7}{}{}\n", printable_line(topic.name), name_width,
                        printable_line(topic.type), type_width, topic.messages,
                        laser   ? "  the laser"
                        : motor ? "  the motor"
                                : "",
                        topic.malformed > 0 ? fmt::format("  {} malformed", topic.malformed) : "");
  }
  return text;
}

/// `where`: what in a message the stamp is of.
std::string stream_text(const StreamSummary& stream, const std::string& where = "") {
  std::string stamps = name_of(stream.stamp) + where;
  if (stream.receive_minus_header_s) {
    stamps += fmt::format("; receive minus header {:.4f} s, jitter {:.2g} ms", *stream.receive_minus_header_s,
                          1000 * *stream.receive_jitter_s);
  }
  std::string gaps = "no gaps";
  if (stream.gaps > 0) gaps = fmt::format("{} gaps, the longest {:.3f} s", stream.gaps, stream.longest_gap_s);
  return row("stamps", stamps) +
         row("rate", fmt::format("{:.2f} Hz over {:.3f} s, {}", stream.rate_hz(), stream.duration_s, gaps)) +
         row("order", fmt::format("{} out of order, {} duplicate, {} dropped", stream.out_of_order,
                                  stream.duplicates, stream.dropped));
}

std::string laser_text(const LaserSummary& laser) {
  const std::string beams = laser.min_beams == laser.max_beams
                                ? fmt::format("{}", laser.max_beams)
                                : fmt::format("{} to {}", laser.min_beams, laser.max_beams);
  const double usable =
      laser.beams > 0 ? 100.0 * static_cast<double>(laser.usable_beams) / static_cast<double>(laser.beams)
                      : 0;
  const std::string of_clouds =
      laser.rings > 0 ? fmt::format(" of clouds, on {} {},", laser.rings, laser.rings > 1 ? "rings" : "ring")
                      : "";
  const std::string reading = reading_in_words(laser.readings);
  return "laser\n" + row("topic", laser.topic) +
         row("scans", fmt::format("{}{} of {} beams from {:.1f} to {:.1f} deg in {:.1f} ms{}", laser.used,
                                  of_clouds, beams, laser.first_beam_deg, laser.last_beam_deg,
                                  1000 * laser.scan_s, laser.intensities ? ", with intensities" : "")) +
         stream_text(laser, laser.stamp_at == StampAt::kFirstBeam  ? ", taken as the first beam's"
                            : laser.stamp_at == StampAt::kLastBeam ? ", taken as the last beam's"
                                                                   : ", taken as the scan's arrival") +
         (reading.empty() ? "" : row("reading", reading)) +
         row("ranges",
             fmt::format("{:.1f} % usable, median {:.2f} m; {} NaN, {} infinite, {} zero, {} out of range",
                         usable, laser.median_range_m, laser.nan, laser.infinite, laser.zero,
                         laser.out_of_range)) +
         row("uncovered", fmt::format("{} scans have no motor samples around them at offset 0",
                                      laser.scans_without_motor));
}

/// Samples that say nothing about the motor's angle at their stamps; empty where there are none.
std::string left_out_text(const MotorSummary& motor) {
  std::string text;
  if (motor.repeated > 0)
    text += row("repeated", fmt::format("{} samples repeat an old angle while the motor moves: left out",
                                        motor.repeated));
  if (motor.of_others > 0)
    text += row("others", fmt::format("{} samples are of other publishers: left out", motor.of_others));
  return text;
}

std::string sweeps_row(const MotorSummary& motor) {
  if (motor.one_way)
    return row("turns",
               fmt::format("{:.1f}, all one way: no reversals, so no sweeps", motor.turns_one_way()));
  std::string sweeps = fmt::format("{} whole", motor.whole_sweeps());
  if (motor.median_sweep_s > 0) sweeps += fmt::format(", {:.3f} s each", motor.median_sweep_s);
  return row("sweeps", fmt::format("{}; {} reversals", sweeps, motor.reversals));
}

std::string motor_text(const MotorSummary& motor) {
  const std::string joint = motor.topic.empty()
                                ? std::string("by the rig file's profile")
                                : fmt::format("{} on {}, {} samples", motor.joint, motor.topic, motor.used);
  return "motor\n" + row("joint", joint) + stream_text(motor) + left_out_text(motor) +
         row("angle",
             fmt::format("{:.2f} to {:.2f} deg{}", motor.min_deg, motor.max_deg,
                         motor.unwrapped > 0 ? fmt::format(", unwrapped {} times", motor.unwrapped) : "")) +
         row("speed", fmt::format("{:.1f} deg/s (median of the sweeps): 1 ms is {:.3g} deg",
                                  motor.median_speed_deg_s, motor.deg_per_ms())) +
         sweeps_row(motor);
}

std::string as_text(const RecordingSummary& summary) {
  std::string text = printable_line(summary.name) + "\n\n" + topics_text(summary) + "\n" +
                     laser_text(summary.laser) + "\n" + motor_text(summary.motor);
  if (summary.motion) text += "\nmotion\n" + row("the rig is", *summary.motion);
  if (const auto& part = summary.stationary_part)
    text += row("stationary", fmt::format("from {:.1f} to {:.1f} s: --window {:.6g}:{:.6g}", part->begin_s,
                                          part->end_s, part->begin_s, part->end_s));
  text += "\nexpected accuracy\n";
  for (const std::string& line : summary.expectations) text += "  " + printable_line(line) + "\n";
  return text;
}

ExitCode run(const RecordingOptions& options, const std::string& json) {
  if (const auto checked = check_outputs({json}, options.input_files()); !checked)
    return fail(checked.error());
  Result<RecordingSummary> summary = [&]() -> Result<RecordingSummary> {
    const Progress progress;
    const auto recording = options.read(progress.job());
    if (!recording) return tl::unexpected(recording.error());
    return summarise(*recording, progress.job());
  }();
  if (!summary) return fail(summary.error());
  for (const std::string& warning : summary->warnings) say("warning: {}: {}\n", summary->name, warning);
  if (json != "-") fmt::print("{}", as_text(*summary));
  if (json.empty()) return ExitCode::kDone;
  const auto written = write_text(json, info_to_json(*summary));
  return written ? ExitCode::kDone : fail(written.error());
}

}  // namespace

void add_info(CLI::App& app, ExitCode& exit_code) {
  struct Options : RecordingOptions {
    std::string json;
  };
  CLI::App* info =
      app.add_subcommand("info", "Show what a recording holds and the expected accuracy of an estimate");
  const auto options = std::make_shared<Options>();
  options->keep_intensities = false;
  options->declare(*info);
  info->add_option("--json", options->json, "Write it as JSON; - for stdout")->type_name("F");
  info->callback([options, &exit_code] { exit_code = run(*options, options->json); });
}

}  // namespace sweepscope::app
