#include "core/apply/apply.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/apply/applied_records.hpp"
#include "core/apply/apply_output.hpp"
#include "core/apply/clock_shift.hpp"
#include "core/apply/copier.hpp"
#include "core/apply/survey.hpp"
#include "core/io/abandoned_parts.hpp"
#include "core/io/atomic_file.hpp"
#include "core/io/atomic_folder.hpp"
#include "core/offset/readings/fitting_recording.hpp"
#include "core/recording/formats/recording_file.hpp"
#include "core/recording/streams/message_sink.hpp"
#include "core/recording/sweeps.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

Result<Move> find_move(StreamSurvey& surveyed, const ApplyOptions& options) {
  const bool of_motor = options.shifted == ShiftedStream::kMotor;
  if (!of_motor && options.rig.laser.field)
    return failure(ExitCode::kWrongUsage,
                   fmt::format("{}: the scans are fields of other messages (laser.field), whose stamps "
                               "--shift laser does not move; use --shift motor",
                               surveyed.raw.file));
  MovedStream laser;
  if (!of_motor || options.offset.changes() || options.add.any()) {
    auto found = find_laser(surveyed, options.rig, options.stamps);
    if (!found) return tl::unexpected(found.error());
    laser = std::move(*found);
  }
  Move move{laser, laser, options.rig, options.shifted,
            clock_shift(options.offset, laser.first_ns, laser.last_ns)};
  if (!of_motor) return move;
  auto motor = find_motor(surveyed, options.rig, options.stamps);
  if (!motor) return tl::unexpected(motor.error());
  move.stream = std::move(*motor);
  return move;
}

/// One run, from the survey of the input to the written output.
class Application {
 public:
  Application(const StreamRecording& recording, const fs::path& output, const ApplyOptions& options,
              const Job& job)
      : recording_(recording), output_(output), options_(options), job_(job) {}

  Result<Applied> run();

 private:
  Result<void> prepare();
  Result<void> check_period() const;
  Result<void> prepare_added();
  Result<Recording> recording_to_add() const;
  Result<std::unique_ptr<MessageSink>> create_sink(const OutputFile& file, const fs::path& path) const;
  Result<void> write_file(const OutputFile& file, const fs::path& folder, bool last);
  Result<void> write_folder();
  std::vector<std::string> records_for(const OutputFile& file) const;

  const StreamRecording& recording_;
  fs::path output_;
  const ApplyOptions& options_;
  const Job& job_;
  OutputKind kind_;
  StreamSurvey survey_;
  Move move_;
  AddedStreams added_;
  Applied result_;
  std::uint64_t malformed_ = 0;
  std::set<std::string> other_joints_;
  std::vector<WrittenFile> written_;
};

/// No motor swings so fast that it is necessary to read the recording for a small offset.
Result<void> Application::check_period() const {
  constexpr double kShortestPeriod_s = 0.1;
  if (options_.far || std::abs(options_.offset.offset_s) <= kShortestPeriod_s) return {};
  ReadOptions options;
  options.rig = options_.rig;
  options.stamps = options_.stamps;
  const auto outline = read_outline(recording_.path, options, 0, job_);
  return outline ? check_within_period(*outline, options_) : Result<void>();
}

Result<void> Application::prepare() {
  auto kind = output_kind(recording_, output_);
  if (!kind) return tl::unexpected(kind.error());
  kind_ = *kind;
  if (kind_.is_folder)
    if (auto checked = AtomicFolder::check(output_); !checked) return checked;
  auto surveyed = survey(recording_, options_.rig, job_);
  if (!surveyed) return tl::unexpected(surveyed.error());
  survey_ = std::move(*surveyed);
  const bool has_record =
      std::ranges::find(survey_.topics, kAppliedTopic, &StreamTopic::name) != survey_.topics.end();
  if (!options_.again)
    if (auto checked = check_not_applied(recording_, has_record); !checked) return checked;
  if (auto checked = check_period(); !checked) return checked;
  auto move = find_move(survey_, options_);
  if (!move) return tl::unexpected(move.error());
  move_ = std::move(*move);
  result_.warnings = survey_.warnings;
  Provenance& done = result_.provenance;
  done.recording = recording_.path.filename().string();
  done.estimate = options_.estimate;
  done.shifted = options_.shifted;
  done.topic = move_.stream.topic;
  done.joint = move_.stream.joint;
  done.stamp = move_.stream.stamp;
  done.offset = options_.offset;
  done.messages = move_.stream.messages;
  return options_.add.any() ? prepare_added() : Result<void>();
}

/// With ranges only where clouds are made of them.
Result<Recording> Application::recording_to_add() const {
  ReadOptions options;
  options.rig = options_.rig;
  options.stamps = options_.stamps;
  auto read = options_.add.clouds_topic.empty() ? read_outline(recording_.path, options, 0, job_)
                                                : read_fitting(recording_.path, options, job_);
  if (!read) return read;
  return without_offset(std::move(*read), move_.clocks);
}

Result<void> Application::prepare_added() {
  const auto refuse = [&](const std::string& why) {
    return failure(ExitCode::kWrongUsage, fmt::format("{}: {}", recording_.path.string(), why));
  };
  const auto of_name = [&](const std::string& name) {
    return std::ranges::find(survey_.topics, name, &StreamTopic::name);
  };
  const auto laser = of_name(move_.laser.topic);
  const auto encoding = stream_encoding(*laser);
  if (of_name(options_.add.clouds_topic) != survey_.topics.end())
    return refuse(fmt::format("has a topic {} already", options_.add.clouds_topic));
  auto recording = recording_to_add();
  if (!recording) return tl::unexpected(recording.error());
  const std::string frame = move_.laser.frame.empty() ? "laser" : move_.laser.frame;
  const bool of_motor = options_.shifted == ShiftedStream::kMotor;
  const StampMap stamped = [this, of_motor](std::int64_t ns) {
    return of_motor ? ns : move_.clocks.motor_ns(ns);
  };
  auto added = add_topics(std::move(*recording), options_.add, encoding.value_or(Encoding::kRos1), frame,
                          stamped, job_);
  if (!added) return tl::unexpected(added.error());
  for (const AddedTopic& topic : added->topics) result_.provenance.added.push_back(topic.topic.name);
  result_.warnings.insert(result_.warnings.end(), added->warnings.begin(), added->warnings.end());
  added_ = AddedStreams(std::move(added->topics));
  return {};
}

Result<std::unique_ptr<MessageSink>> Application::create_sink(const OutputFile& file,
                                                              const fs::path& path) const {
  const Compression compression =
      compression_in(kind_.format, survey_.compression.value_or(Compression::kNone));
  if (kind_.format == StreamFormat::kRos1) return create_ros1_sink(path, compression);
  if (kind_.format == StreamFormat::kSqlite) return create_sqlite_sink(path);
  std::vector<fs::path> kept_from;
  for (const StreamFile& input : file.inputs)
    if (input.format == StreamFormat::kMcap) kept_from.push_back(input.readable());
  const bool ros1 = recording_.files.front().format == StreamFormat::kRos1;
  return create_mcap_sink(path, compression, ros1 ? "ros1" : "ros2", kept_from);
}

/// The new record, and earlier ones that are not copied with the MCAP file's metadata.
std::vector<std::string> Application::records_for(const OutputFile& file) const {
  std::vector<std::string> records;
  for (const StreamFile& input : file.inputs) {
    if (input.format == StreamFormat::kMcap && kind_.format == StreamFormat::kMcap) continue;
    if (const auto before = applied_records(input))
      records.insert(records.end(), before->begin(), before->end());
  }
  records.push_back(to_json(result_.provenance));
  return records;
}

Result<void> Application::write_file(const OutputFile& file, const fs::path& folder, bool last) {
  const fs::path path = folder / file.name;
  const fs::path plain = file.packed ? fs::path(path.string() + ".plain") : path;
  auto sink = create_sink(file, plain);
  if (!sink) return tl::unexpected(sink.error());
  Copier copier(**sink, kind_.format, move_, added_, recording_.path.string());
  const StreamVisitor visitor{[&](const StreamTopic& topic) { return copier.add_topic(topic); },
                              [&](const StreamMessage& message) { return copier.add(message); }};
  for (const StreamFile& input : file.inputs)
    if (const auto read = read_stream(input, visitor, job_); !read) return tl::unexpected(read.error());
  if (last)
    if (auto error = copier.end()) return tl::unexpected(*error);
  if (const auto finished = copier.finish(records_for(file)); !finished) return finished;
  result_.moved += copier.moved();
  malformed_ += copier.malformed();
  other_joints_.insert(copier.other_joints().begin(), copier.other_joints().end());
  written_.push_back(copier.written());
  written_.back().name = file.name;
  written_.back().packed = file.packed;
  if (!file.packed) return {};
  return pack_file(plain, path, job_).map([&] { fs::remove(plain); });
}

Result<void> Application::write_folder() {
  auto folder = AtomicFolder::create(output_);
  if (!folder) return tl::unexpected(folder.error());
  const std::vector<OutputFile> files = output_files(recording_, kind_, output_);
  for (const OutputFile& file : files)
    if (auto written = write_file(file, folder->part_path(), &file == &files.back()); !written)
      return written;
  const bool as_before = move_.stream.stamp == StampSource::kHeader && !options_.add.any();
  std::error_code ignored;
  const fs::path described = recording_.path / "metadata.yaml";
  auto metadata = recording_.is_folder && as_before && fs::exists(described, ignored)
                      ? read_file(described)
                      : Result<std::string>(metadata_yaml(written_, kind_.format));
  if (!metadata) return tl::unexpected(metadata.error());
  return sweepscope::write_file(folder->part_path() / "metadata.yaml", *metadata).and_then([&] {
    return folder->commit();
  });
}

Result<Applied> Application::run() {
  if (const auto prepared = prepare(); !prepared) return tl::unexpected(prepared.error());
  remove_abandoned_parts(output_);
  const auto written = kind_.is_folder ? write_folder()
                                       : write_file(output_files(recording_, kind_, output_).front(),
                                                    output_.parent_path(), true);
  if (!written) return tl::unexpected(written.error());
  if (malformed_ > 0)
    result_.warnings.push_back(fmt::format("{} messages on {} are malformed, and were copied as they are",
                                           malformed_, move_.stream.topic));
  if (!other_joints_.empty())
    result_.warnings.push_back(fmt::format("messages of {} on {} hold {} too, which is moved with it",
                                           move_.stream.joint, move_.stream.topic,
                                           fmt::join(other_joints_, ", ")));
  return result_;
}

}  // namespace

Result<void> check_within_period(const Recording& recording, const ApplyOptions& options) {
  const double period_s = 2 * find_sweeps(recording.motor).median_sweep_s;
  const double offset_s = std::abs(options.offset.offset_s);
  if (options.far || !(period_s > 0) || offset_s <= period_s) return {};
  return failure(
      ExitCode::kWrongUsage,
      fmt::format("{}: the offset, {:.6g} ms, is longer than the motor's period, {:.4g} s. Offsets are "
                  "in milliseconds. Apply it all the same with --far",
                  recording.name, options.offset.offset_s * 1e3, period_s));
}

Result<Applied> apply_offset(const fs::path& recording, const fs::path& output, const ApplyOptions& options,
                             const Job& job) {
  const auto opened = open_stream(recording, job);
  if (!opened) return tl::unexpected(opened.error());
  return Application(*opened, output, options, job).run();
}

}  // namespace sweepscope
