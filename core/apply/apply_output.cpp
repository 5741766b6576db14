#include "core/apply/apply_output.hpp"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <limits>
#include <map>
#include <new>

#include "core/io/atomic_file.hpp"
#include "core/io/input_file.hpp"
#include "core/io/printable_text.hpp"
#include "core/recording/messages/message_definitions.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

std::string topics_yaml(const std::vector<WrittenFile>& files) {
  std::vector<StreamTopic> topics;
  std::vector<std::uint64_t> counts;
  for (const WrittenFile& file : files) {
    for (std::size_t i = 0; i < file.topics.size(); ++i) {
      const auto same = std::ranges::find(topics, file.topics[i].name, &StreamTopic::name);
      if (same == topics.end()) {
        topics.push_back(file.topics[i]);
        counts.push_back(file.counts[i]);
      } else {
        counts[static_cast<std::size_t>(same - topics.begin())] += file.counts[i];
      }
    }
  }
  std::string yaml = "  topics_with_message_count:\n";
  for (std::size_t i = 0; i < topics.size(); ++i)
    yaml += fmt::format(
        "    - topic_metadata:\n        name: {}\n        type: {}\n        serialization_format: {}\n"
        "        offered_qos_profiles: {}\n      message_count: {}\n",
        json_string(topics[i].name), json_string(topics[i].type), json_string(topics[i].encoding),
        json_string(topics[i].metadata_of("offered_qos_profiles")), counts[i]);
  return yaml;
}

}  // namespace

Result<OutputKind> output_kind(const StreamRecording& recording, const fs::path& output) {
  const std::string extension = output.has_filename() ? output.extension().string() : "";
  const StreamFormat format = recording.files.front().format;
  const auto refused = [&](const std::string& why) {
    return failure(ExitCode::kWrongUsage, fmt::format("{}: {}", output.string(), why));
  };
  if (extension == ".bag") return OutputKind{StreamFormat::kRos1, false};
  if (extension == ".mcap") return OutputKind{StreamFormat::kMcap, false};
  if (extension == ".db3") return OutputKind{StreamFormat::kSqlite, false};
  if (!extension.empty())
    return refused("its name has no known extension; name it OUT.bag, OUT.mcap, OUT.db3, or name a folder");
  if (format == StreamFormat::kRos1)
    return refused("a folder holds a ROS 2 bag, and the recording is a ROS 1 bag; name OUT.bag or OUT.mcap");
  return OutputKind{format, true};
}

Compression compression_in(StreamFormat format, Compression recorded) {
  if (recorded == Compression::kNone || format == StreamFormat::kSqlite) return Compression::kNone;
  if (format == StreamFormat::kRos1 && recorded == Compression::kZstd) return Compression::kLz4;
  if (format == StreamFormat::kMcap && recorded == Compression::kBz2) return Compression::kZstd;
  return recorded;
}

StreamTopic topic_in(StreamFormat format, const StreamTopic& topic) {
  StreamTopic same = topic;
  if (format != StreamFormat::kRos1) same.connection_header.clear();
  if (format != StreamFormat::kMcap || !same.schema_encoding.empty() || same.encoding != "cdr") return same;
  same.schema_encoding = "ros2msg";
  if (same.definition.empty()) same.definition = message_definition(same.type, Encoding::kCdr);
  return same;
}

std::vector<OutputFile> output_files(const StreamRecording& recording, const OutputKind& kind,
                                     const fs::path& output) {
  const fs::path name = output.has_filename() ? output.filename() : output.parent_path().filename();
  if (!kind.is_folder) return {{name.string(), false, recording.files}};
  std::vector<OutputFile> files;
  for (const StreamFile& file : recording.files) {
    const char* extension = file.format == StreamFormat::kMcap ? ".mcap" : ".db3";
    const std::string own = fmt::format("{}_0{}{}", name.string(), extension, file.plain ? ".zstd" : "");
    files.push_back(
        {recording.is_folder ? file.path.filename().string() : own, file.plain != nullptr, {file}});
  }
  return files;
}

Result<void> pack_file(const fs::path& plain, const fs::path& packed, const Job& job) {
  constexpr int kLevel = 3;
  auto input = InputFile::open(plain);
  if (!input) return tl::unexpected(input.error());
  auto output = AtomicFile::create(packed);
  if (!output) return tl::unexpected(output.error());
  const std::unique_ptr<ZSTD_CCtx, std::size_t (*)(ZSTD_CCtx*)> context(ZSTD_createCCtx(), ZSTD_freeCCtx);
  if (!context) throw std::bad_alloc();
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, kLevel);
  std::vector<std::byte> from(std::size_t{1} << 20);
  std::string to(ZSTD_CStreamOutSize(), '\0');
  for (bool more = true; more;) {
    ZSTD_inBuffer in{from.data(), input->read(from), 0};
    const ZSTD_EndDirective how = input->left() == 0 ? ZSTD_e_end : ZSTD_e_continue;
    for (bool block = true; block;) {
      ZSTD_outBuffer out{to.data(), to.size(), 0};
      const std::size_t left = ZSTD_compressStream2(context.get(), &out, &in, how);
      if (ZSTD_isError(left)) return tl::unexpected(output->error(ZSTD_getErrorName(left)));
      if (auto written = output->write(std::string_view(to).substr(0, out.pos)); !written) return written;
      block = how == ZSTD_e_end ? left > 0 : in.pos < in.size;
    }
    more = how != ZSTD_e_end;
    job.report("packing", static_cast<double>(input->position()) / static_cast<double>(input->size()));
    if (job.cancelled()) return failure(ExitCode::kInterrupted, "interrupted");
  }
  return output->commit();
}

std::string metadata_yaml(const std::vector<WrittenFile>& files, StreamFormat format) {
  std::int64_t first_ns = std::numeric_limits<std::int64_t>::max(), last_ns = 0;
  std::uint64_t messages = 0;
  for (const WrittenFile& file : files) {
    if (file.messages == 0) continue;
    first_ns = std::min(first_ns, file.first_ns);
    last_ns = std::max(last_ns, file.last_ns);
    messages += file.messages;
  }
  first_ns = std::min(first_ns, last_ns);
  const bool packed = std::ranges::any_of(files, &WrittenFile::packed);
  std::string yaml = fmt::format(
      "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: {}\n  duration:\n"
      "    nanoseconds: {}\n  starting_time:\n    nanoseconds_since_epoch: {}\n  message_count: {}\n",
      format == StreamFormat::kMcap ? "mcap" : "sqlite3", last_ns - first_ns, first_ns, messages);
  yaml += topics_yaml(files);
  yaml += fmt::format("  compression_format: {}\n  compression_mode: {}\n  relative_file_paths:\n",
                      packed ? "zstd" : "\"\"", packed ? "FILE" : "\"\"");
  for (const WrittenFile& file : files) yaml += fmt::format("    - {}\n", json_string(file.name));
  yaml += "  files:\n";
  for (const WrittenFile& file : files)
    yaml += fmt::format(
        "    - path: {}\n      starting_time:\n        nanoseconds_since_epoch: {}\n      duration:\n"
        "        nanoseconds: {}\n      message_count: {}\n",
        json_string(file.name), file.first_ns, file.last_ns - file.first_ns, file.messages);
  return yaml;
}

}  // namespace sweepscope
