#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/apply/survey.hpp"
#include "core/io/atomic_folder.hpp"
#include "core/recording/streams/message_sink.hpp"
#include "core/recording/streams/message_stream.hpp"

namespace sweepscope {

/// The kind of output, from its name.
struct OutputKind {
  StreamFormat format = StreamFormat::kRos1;
  bool is_folder = false;  // of a ROS 2 bag, with metadata.yaml
};

/// .bag, .mcap or .db3; without an extension a folder with files like those of the input (MCAP or databases).
/// Another extension, or a folder for a ROS 1 bag, is ExitCode::kWrongUsage.
Result<OutputKind> output_kind(const StreamRecording& recording, const std::filesystem::path& output);

/// The compression of chunks in the output format for that of the recording.
Compression compression_in(StreamFormat format, Compression recorded);

/// The topic as described in that format.
StreamTopic topic_in(StreamFormat format, const StreamTopic& topic);

/// The files of the output, each with the input files whose messages it holds. A folder has one file per
/// input file, with the same name; otherwise there is one file with all messages.
struct OutputFile {
  std::string name;  // within the folder
  bool packed = false;
  std::vector<StreamFile> inputs;
};
std::vector<OutputFile> output_files(const StreamRecording& recording, const OutputKind& kind,
                                     const std::filesystem::path& output);

/// Compresses a whole file by Zstandard. The result appears complete or not at all.
Result<void> pack_file(const std::filesystem::path& plain, const std::filesystem::path& packed,
                       const Job& job);

/// The content of an output file, for metadata.yaml.
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
