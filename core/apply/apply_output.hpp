#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/apply/message_sink.hpp"
#include "core/apply/message_stream.hpp"
#include "core/apply/survey.hpp"
#include "core/io/atomic_folder.hpp"

namespace sweepscope {

/// What an output's name stands for.
struct OutputKind {
  StreamFormat format = StreamFormat::kRos1;
  bool is_folder = false;  // of a ROS 2 bag, with metadata.yaml
};

/// .bag, .mcap, .db3; a folder where there is no extension, with files as the input's (MCAP or databases).
/// Another extension, and a folder of a ROS 1 bag, is ExitCode::kWrongUsage.
Result<OutputKind> output_kind(const StreamRecording& recording, const std::filesystem::path& output);

/// How chunks of that format are compressed for a recording of that compression.
Compression compression_in(StreamFormat format, Compression recorded);

/// The topic as that format describes it.
StreamTopic topic_in(StreamFormat format, const StreamTopic& topic);

/// The files of the output, and of which files of the input each holds the messages. A folder has one for
/// each of the input's, with its name; else all messages go into one.
struct OutputFile {
  std::string name;  // within the folder
  bool packed = false;
  std::vector<StreamFile> inputs;
};
std::vector<OutputFile> output_files(const StreamRecording& recording, const OutputKind& kind,
                                     const std::filesystem::path& output);

/// Packs a file by Zstandard as a whole. It appears whole or not at all.
Result<void> pack_file(const std::filesystem::path& plain, const std::filesystem::path& packed,
                       const Job& job);

/// What a file of the output holds, for metadata.yaml.
struct WrittenFile {
  std::string name;
  std::vector<StreamTopic> topics;
  std::vector<std::uint64_t> counts;  // of their messages
  std::int64_t first_ns = 0, last_ns = 0;
  std::uint64_t messages = 0;
  bool packed = false;
};
/// A ROS 2 bag's metadata.yaml (version 5).
std::string metadata_yaml(const std::vector<WrittenFile>& files, StreamFormat format);

}  // namespace sweepscope
