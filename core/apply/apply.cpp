#include "core/apply/apply.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/apply/applied_records.hpp"
#include "core/apply/apply_output.hpp"
#include "core/apply/clock_shift.hpp"
#include "core/apply/message_sink.hpp"
#include "core/apply/stamp_shift.hpp"
#include "core/apply/survey.hpp"
#include "core/io/atomic_file.hpp"
#include "core/recording/messages/point_cloud.hpp"
#include "core/recording/packed/compress.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

constexpr double kNs_per_s = 1e9;

std::int64_t ns_after(std::int64_t first_ns, double time_s) {
  return first_ns + std::llround(time_s * kNs_per_s);
}

/// The offset in terms of the recording's stamps.
ClockShift clock_shift(const AppliedOffset& offset, const MovedStream& laser) {
  if (!offset.changes()) return ClockShift(offset.offset_s);
  const std::int64_t middle_ns = offset.middle_s ? ns_after(laser.first_ns, *offset.middle_s)
                                                 : laser.first_ns + (laser.last_ns - laser.first_ns) / 2;
  std::vector<OffsetStep> steps;
  for (const AppliedOffset::Jump& jump : offset.jumps)
    steps.push_back({ns_after(laser.first_ns, jump.time_s), jump.size_s});
  return {offset.offset_s, middle_ns, offset.rate, std::move(steps)};
}

/// The stream to move, and the shift.
struct Move {
  MovedStream stream;
  ShiftedStream shifted = ShiftedStream::kMotor;
  ClockShift clocks{0};

  std::int64_t moved_ns(std::int64_t ns) const {
    return shifted == ShiftedStream::kMotor ? clocks.laser_ns(ns) : clocks.motor_ns(ns);
  }
};

Result<Move> find_move(StreamSurvey& surveyed, const ApplyOptions& options) {
  const bool of_motor = options.shifted == ShiftedStream::kMotor;
  MovedStream laser;
  if (!of_motor || options.offset.changes()) {
    auto found = find_laser(surveyed, options.rig, options.stamps);
    if (!found) return tl::unexpected(found.error());
    laser = std::move(*found);
  }
  Move move{laser, options.shifted, clock_shift(options.offset, laser)};
  if (!of_motor) return move;
  auto motor = find_motor(surveyed, options.rig, options.stamps);
  if (!motor) return tl::unexpected(motor.error());
  move.stream = std::move(*motor);
  return move;
}

/// Copies the messages of one output file.
class Copier {
 public:
  Copier(MessageSink& sink, StreamFormat format, const Move& move, std::string name)
      : sink_(sink), format_(format), move_(move), name_(std::move(name)) {}

  std::size_t add_topic(const StreamTopic& topic);
  std::optional<Error> add(const StreamMessage& message);
  Result<void> finish(const std::vector<std::string>& records);

  std::uint64_t moved() const { return moved_; }
  std::uint64_t malformed() const { return malformed_; }
  const std::set<std::string>& other_joints() const { return other_joints_; }
  WrittenFile written() const { return written_; }

 private:
  struct Entry {
    const MessageType* type = nullptr;  // null: its messages stay as they are
    Encoding encoding = Encoding::kRos1;
  };
  std::optional<Error> write(const StreamMessage& message);
  std::optional<Error> write_moved(const Entry& entry, StreamMessage message);
  std::optional<bool> is_of_motor(const Entry& entry, std::span<const std::byte> plain);
  std::optional<Error> refuse_absolute_times(const Entry& entry, std::span<const std::byte> plain) const;
  Error out_of_range(const StreamMessage& message) const;

  MessageSink& sink_;
  StreamFormat format_;
  const Move& move_;
  std::string name_;  // of the recording, for messages
  std::vector<Entry> entries_;
  std::optional<Error> problem_;
  WrittenFile written_;
  std::vector<std::byte> plain_, copy_;
  std::vector<DecodedJoint> joints_;
  std::set<std::string> other_joints_;  // in messages that were moved
  std::uint64_t moved_ = 0, malformed_ = 0;
};

std::size_t Copier::add_topic(const StreamTopic& recorded) {
  const StreamTopic topic = topic_in(format_, recorded);
  const auto known = std::ranges::find(written_.topics, topic);
  if (known != written_.topics.end()) return static_cast<std::size_t>(known - written_.topics.begin());
  Entry& entry = entries_.emplace_back();
  const auto encoding = stream_encoding(topic);
  if (encoding && topic.name == move_.stream.topic) entry = {find_message_type(topic.type), *encoding};
  written_.topics.push_back(topic);
  written_.counts.push_back(0);
  if (const auto added = sink_.add_topic(topic); !added && !problem_) problem_ = added.error();
  return written_.topics.size() - 1;
}

std::optional<Error> Copier::write(const StreamMessage& message) {
  if (auto written = sink_.write(message); !written) return written.error();
  const bool first = written_.messages++ == 0;
  written_.first_ns = first ? message.log_ns : std::min(written_.first_ns, message.log_ns);
  written_.last_ns = first ? message.log_ns : std::max(written_.last_ns, message.log_ns);
  ++written_.counts[message.topic];
  return std::nullopt;
}

Error Copier::out_of_range(const StreamMessage& message) const {
  return {ExitCode::kUnreadableInput,
          fmt::format("{}: a message on {}, received at {:.9f} s, cannot be moved: its new stamp would lie "
                      "before 1970, or beyond what a stamp holds",
                      name_, move_.stream.topic, static_cast<double>(message.log_ns) / kNs_per_s)};
}

/// Whether a message on the motor's topic holds the motor's joint: several publishers may share a topic. No
/// value if it is malformed.
std::optional<bool> Copier::is_of_motor(const Entry& entry, std::span<const std::byte> plain) {
  if (!decode_joints(entry.type->kind, entry.encoding, plain, Eigen::Vector3d::UnitX(), joints_))
    return std::nullopt;
  const bool found = std::ranges::find(joints_, move_.stream.joint, &DecodedJoint::name) != joints_.end();
  const bool frames_apart =
      entry.type->kind == MessageKind::kTransforms && move_.stream.stamp == StampSource::kHeader;
  if (found && !frames_apart)
    for (const DecodedJoint& joint : joints_)
      if (joint.name != move_.stream.joint) other_joints_.emplace(joint.name);
  return found;
}

std::optional<Error> Copier::refuse_absolute_times(const Entry& entry,
                                                   std::span<const std::byte> plain) const {
  if (!is_cloud(entry.type->kind)) return std::nullopt;
  const auto cloud = decode_points(entry.type->kind, entry.encoding, plain);
  if (!cloud || !CloudReader::counts_since_1970(*cloud)) return std::nullopt;
  return Error{
      ExitCode::kWrongUsage,
      fmt::format("{}: the points on {} have times of their own, since 1970, which --shift laser does "
                  "not move; use --shift motor",
                  name_, move_.stream.topic)};
}

std::optional<Error> Copier::write_moved(const Entry& entry, StreamMessage message) {
  const auto plain = plain_message(written_.topics[message.topic], message.bytes, plain_);
  if (move_.shifted == ShiftedStream::kMotor) {
    const auto of_motor = is_of_motor(entry, plain);
    if (!of_motor) ++malformed_;
    if (!of_motor.value_or(false)) return write(message);
  } else if (auto refused = refuse_absolute_times(entry, plain)) {
    return refused;
  }
  const auto moved_ns = [&](std::int64_t ns) { return move_.moved_ns(ns); };
  if (move_.stream.stamp == StampSource::kReceive) {
    message.log_ns = moved_ns(message.log_ns);
    if (message.log_ns <= 0) return out_of_range(message);
    ++moved_;
    return write(message);
  }
  const bool packed = plain.data() != message.bytes.data();
  copy_.assign(plain.begin(), plain.end());
  const StampShift shift =
      shift_header_stamps(entry.type->kind, entry.encoding, move_.stream.joint, moved_ns, copy_);
  if (shift == StampShift::kOutOfRange) return out_of_range(message);
  if (shift == StampShift::kMalformed) ++malformed_;
  if (shift != StampShift::kShifted) return write(message);
  ++moved_;
  const std::string again =
      packed ? compressed(Compression::kZstd, {reinterpret_cast<const char*>(copy_.data()), copy_.size()})
             : std::string();
  message.bytes = packed ? std::as_bytes(std::span(again)) : std::span<const std::byte>(copy_);
  return write(message);
}

std::optional<Error> Copier::add(const StreamMessage& message) {
  if (problem_) return problem_;
  const Entry& entry = entries_[message.topic];
  return entry.type == nullptr ? write(message) : write_moved(entry, message);
}

Result<void> Copier::finish(const std::vector<std::string>& records) {
  if (problem_) return tl::unexpected(*problem_);
  return sink_.finish(records);
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
  Result<void> check_not_applied();
  Result<std::unique_ptr<MessageSink>> create_sink(const OutputFile& file, const fs::path& path) const;
  Result<void> write_file(const OutputFile& file, const fs::path& folder);
  Result<void> write_folder();
  std::vector<std::string> records_for(const OutputFile& file) const;

  const StreamRecording& recording_;
  fs::path output_;
  const ApplyOptions& options_;
  const Job& job_;
  OutputKind kind_;
  StreamSurvey survey_;
  Move move_;
  Applied result_;
  std::uint64_t malformed_ = 0;
  std::set<std::string> other_joints_;
  std::vector<WrittenFile> written_;
};

Result<void> Application::check_not_applied() {
  if (options_.again) return {};
  bool applied = std::ranges::find(survey_.topics, kAppliedTopic, &StreamTopic::name) != survey_.topics.end();
  for (const StreamFile& file : recording_.files) {
    const auto records = applied_records(file);
    if (!records) return tl::unexpected(records.error());
    applied = applied || !records->empty();
  }
  if (!applied) return {};
  return failure(
      ExitCode::kWrongUsage,
      fmt::format("{}: an offset was applied to it before, which its record {} says; apply another "
                  "one with --again",
                  recording_.path.string(), kAppliedMetadata));
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
  if (auto checked = check_not_applied(); !checked) return checked;
  auto move = find_move(survey_, options_);
  if (!move) return tl::unexpected(move.error());
  move_ = std::move(*move);
  result_.warnings = survey_.warnings;
  result_.provenance = {recording_.path.filename().string(),
                        options_.estimate,
                        options_.shifted,
                        move_.stream.topic,
                        move_.stream.joint,
                        move_.stream.stamp,
                        options_.offset,
                        0};
  result_.provenance.messages = move_.stream.messages;
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

Result<void> Application::write_file(const OutputFile& file, const fs::path& folder) {
  const fs::path path = folder / file.name;
  const fs::path plain = file.packed ? fs::path(path.string() + ".plain") : path;
  auto sink = create_sink(file, plain);
  if (!sink) return tl::unexpected(sink.error());
  Copier copier(**sink, kind_.format, move_, recording_.path.string());
  const StreamVisitor visitor{[&](const StreamTopic& topic) { return copier.add_topic(topic); },
                              [&](const StreamMessage& message) { return copier.add(message); }};
  for (const StreamFile& input : file.inputs)
    if (const auto read = read_stream(input, visitor, job_); !read) return tl::unexpected(read.error());
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
  for (const OutputFile& file : output_files(recording_, kind_, output_))
    if (auto written = write_file(file, folder->part_path()); !written) return written;
  const bool as_before = move_.stream.stamp == StampSource::kHeader;
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
  const auto written =
      kind_.is_folder ? write_folder()
                      : write_file(output_files(recording_, kind_, output_).front(), output_.parent_path());
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

Result<Applied> apply_offset(const fs::path& recording, const fs::path& output, const ApplyOptions& options,
                             const Job& job) {
  const auto opened = open_stream(recording, job);
  if (!opened) return tl::unexpected(opened.error());
  return Application(*opened, output, options, job).run();
}

}  // namespace sweepscope
