#include "core/offset/readings/fitting_recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/offset/readings/profile_speed.hpp"

namespace sweepscope {
namespace {

// Nothing is left to be found.
bool is_stated(const ReadOptions& options) {
  return options.rig && options.rig->laser.time_increment_s && options.rig->states_mount();
}

// Options of a recording, with the speed of its motor where the rig file leaves that open.
struct SettledSpeed {
  ReadOptions options;
  bool asked = false;
  std::optional<ProfileSpeed> found;
  double first_scan_s = 0;  // from which the profile counts
};

Result<SettledSpeed> settle_speed(const std::filesystem::path& path, ReadOptions options, const Job& job) {
  constexpr double kFirst_s = 120;
  const bool open =
      options.rig && options.rig->motor.profile && options.rig->motor.profile->turns_per_s_within > 0;
  if (!open) return SettledSpeed{std::move(options), false, {}, 0};
  return RecordingFile::open(path, options, job)
      .and_then([&](const RecordingFile& file) {
        return file.parts({{0, kFirst_s}}, job);
      })
      .map([&](const Recording& recording) {
        SettledSpeed settled{options, true, find_profile_speed(window(recording, 0, kFirst_s), job),
                             recording.scans.front().first_beam_s};
        if (settled.found)
          settled.options.rig =
              with_found(*options.rig, {std::nullopt, std::nullopt, settled.found->turns_per_s});
        return settled;
      });
}

// What is known of the motor's speed after it was settled. The offset is found where the scans are, and
// counts from the profile's start.
void add_speed(const SettledSpeed& settled, const ReadOptions& asked, const Recording& recording,
               ReadReport& report) {
  if (!settled.asked || recording.scans.empty()) return;
  if (!settled.found) {
    report.warnings.push_back(
        "the surfaces do not show how fast the motor turned: the rig file's turns_per_s is used as if exact");
    return;
  }
  const ProfileSpeed& found = *settled.found;
  const MotorProfile& stated = *asked.rig->motor.profile;
  const double middle_s =
      (recording.scans.front().first_beam_s + recording.scans.back().first_beam_s) / 2 - settled.first_scan_s;
  report.profile_speed_sigma_s = found.sigma_turns_per_s / found.turns_per_s * middle_s;
  report.warnings.push_back(fmt::format(
      "the motor turned {:.9g} times a second (+- {:.2g}), as the surfaces show; the rig file says {:g} "
      "within {:g}. Set turns_per_s in its profile, and leave out turns_per_s_within, to state it.",
      found.turns_per_s, found.sigma_turns_per_s, stated.turns_per_s, stated.turns_per_s_within));
}

FoundReading found_by(const RankedReadings& ranked) {
  FoundReading found;
  const BeamReading* chosen = chosen_of(ranked.beams);
  if (chosen != nullptr && chosen->kind != BeamReadingKind::kRecorded)
    found.time_increment_s = chosen->time_increment_s;
  if (ranked.axis_is_found) found.axis = ranked.axis;
  return found;
}

// By the beginning of a recording.
Result<RankedReadings> ranked_of(const RecordingFile& file, const Job& job) {
  constexpr double kFirst_s = 60;
  return file.parts({{0, kFirst_s}}, job).map([&](const Recording& first) {
    return rank_readings(first, job);
  });
}

// How to read a recording where it has to be read again, otherwise nothing.
std::optional<ReadOptions> other_options(ReadOptions options, const std::string& topic,
                                         const FoundReading& found) {
  if (!found.time_increment_s && !found.axis) return std::nullopt;
  options.rig = with_found(options.rig.value_or(Rig{}), found);
  options.rig->laser.topic = topic;
  return options;
}

std::string axis_warning(const Eigen::Vector3d& axis) {
  return fmt::format(
      "The motor turns the laser about its y axis, as the surfaces show: walls are flat then, and bent about "
      "x. Set mount: {{axis: [{:g}, {:g}, {:g}]}} in a rig file to state it.",
      axis.x(), axis.y(), axis.z());
}

std::string beams_warning(const std::vector<BeamReading>& readings, const BeamReading& chosen,
                          const std::string& topic) {
  const auto residual = [](const BeamReading& reading) {
    return reading.residual_m ? fmt::format("{:.1f} mm", *reading.residual_m * 1e3) : "no match";
  };
  return fmt::format(
      "{}: {}, as the surfaces show (sweeps of opposite directions are {} apart, {} as recorded). Set laser: "
      "{{time_increment_s: {:.6g}}} in a rig file to state it.",
      topic, entry_of(chosen.kind).description, residual(chosen), residual(readings.front()),
      chosen.time_increment_s);
}

// What is known of the beams' times after the readings were ranked.
void add_readings(const RankedReadings& ranked, const std::string& topic, ReadReport& report) {
  report.readings = ranked.beams;
  if (ranked.axis_is_found) report.warnings.push_back(axis_warning(ranked.axis));
  const BeamReading* chosen = chosen_of(report.readings);
  if (chosen == nullptr) {
    report.beam_time_doubt_s = std::max(report.beam_time_doubt_s, 2 * ranked.offset_doubt_s);
    return;
  }
  report.beam_time_doubt_s = 0;
  if (chosen->kind != BeamReadingKind::kRecorded)
    report.warnings.push_back(beams_warning(report.readings, *chosen, topic));
}

// At a settled speed.
Result<Recording> read_ranked(const std::filesystem::path& path, const ReadOptions& options, const Job& job,
                              const std::optional<TimeWindow>& part) {
  const auto read = [&](const ReadOptions& by) {
    return read_recording(path, by, job).and_then([&](Recording&& whole) -> Result<Recording> {
      return part ? cut_to_window(whole, *part, path.string()) : std::move(whole);
    });
  };
  auto recording = read(options);
  if (!recording || is_stated(options)) return recording;
  RankedReadings ranked = rank_readings(*recording, job);
  if (part && chosen_of(ranked.beams) == nullptr)
    if (const auto whole = read_recording(path, options, job)) ranked = rank_readings(*whole, job);
  const std::string topic = recording->rig.laser.topic.value_or("");
  if (const auto other = other_options(options, topic, found_by(ranked))) recording = read(*other);
  if (recording) add_readings(ranked, topic, recording->report);
  return recording;
}

Result<RecordingFile> open_ranked(const std::filesystem::path& path, const ReadOptions& options,
                                  const Job& job) {
  auto file = RecordingFile::open(path, options, job);
  if (!file || is_stated(options)) return file;
  const auto ranked = ranked_of(*file, job);
  if (!ranked) return tl::unexpected(ranked.error());
  const std::string topic = file->outline().rig.laser.topic.value_or("");
  if (const auto other = other_options(options, topic, found_by(*ranked)))
    file = RecordingFile::open(path, *other, job);
  if (file) add_readings(*ranked, topic, file->report());
  return file;
}

}  // namespace

Rig with_found(Rig rig, const FoundReading& found) {
  if (found.turns_per_s) {
    rig.motor.profile->turns_per_s = *found.turns_per_s;
    rig.motor.profile->turns_per_s_within = 0;
  }
  if (found.axis) rig.mount.axis = *found.axis;
  if (!found.time_increment_s) return rig;
  rig.laser.time_increment_s = found.time_increment_s;
  rig.laser.increment_is_found = true;
  return rig;
}

RankedReadings rank_unstated(const Recording& recording, const ReadOptions& options, const Job& job) {
  return is_stated(options) ? RankedReadings() : rank_readings(recording, job);
}

Result<Recording> read_fitting(const std::filesystem::path& path, const ReadOptions& options, const Job& job,
                               const std::optional<TimeWindow>& part) {
  const auto settled = settle_speed(path, options, job);
  if (!settled) return tl::unexpected(settled.error());
  auto recording = read_ranked(path, settled->options, job, part);
  if (recording) add_speed(*settled, options, *recording, recording->report);
  return recording;
}

Result<RecordingFile> open_fitting(const std::filesystem::path& path, const ReadOptions& options,
                                   const Job& job) {
  const auto settled = settle_speed(path, options, job);
  if (!settled) return tl::unexpected(settled.error());
  auto file = open_ranked(path, settled->options, job);
  if (file) add_speed(*settled, options, file->outline(), file->report());
  return file;
}

Result<FoundReading> find_reading(const std::filesystem::path& path, const ReadOptions& options,
                                  const Job& job) {
  const auto settled = settle_speed(path, options, job);
  if (!settled) return tl::unexpected(settled.error());
  const auto with_speed = [&](FoundReading found) {
    if (settled->found) found.turns_per_s = settled->found->turns_per_s;
    return found;
  };
  if (is_stated(settled->options)) return with_speed({});
  return RecordingFile::open(path, settled->options, job)
      .and_then([&](const RecordingFile& file) { return ranked_of(file, job); })
      .map(found_by)
      .map(with_speed);
}

}  // namespace sweepscope
