#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/io/atomic_file.hpp"
#include "core/recording/packed/decompress.hpp"
#include "core/recording/ros2/mcap_extras.hpp"
#include "core/recording/ros2/mcap_file.hpp"

namespace sweepscope {

struct McapMessageHeader {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_ns = 0, publish_ns = 0;
};

/// Writes an MCAP file (https://mcap.dev/spec) whole or not at all: messages in chunks with checksums and
/// indexes, and a summary with the schemas, channels, statistics and places of all else. Takes memory for one
/// chunk and the index. Equal calls give equal bytes.
class McapWriter {
 public:
  /// `compression` is that of the chunks: none, LZ4 or Zstandard.
  static Result<McapWriter> create(const std::filesystem::path& path, Compression compression,
                                   std::string_view profile);

  /// Gives the channel's number: 0, 1, 2 ... Channels of equal schemas share one. More than 65535 channels
  /// are ExitCode::kWrongUsage.
  Result<std::uint16_t> add_channel(const McapChannel& channel);
  Result<void> write(const McapMessageHeader& message, std::span<const std::byte> data);
  Result<void> write_metadata(std::string_view name,
                              const std::vector<std::pair<std::string, std::string>>& entries);
  /// An attachment, metadata or a private record of another file, as it is there.
  Result<void> copy(const std::filesystem::path& from, const McapExtra& extra);
  /// Call once, last.
  Result<void> finish();

 private:
  struct IndexEntry {
    std::uint64_t ns, at;  // in the unpacked chunk
  };
  struct Schema {
    std::string name, encoding, definition;
    bool operator==(const Schema&) const = default;
  };
  /// The times of messages.
  struct TimeSpan {
    std::uint64_t first_ns = UINT64_MAX, last_ns = 0;

    void add(std::uint64_t ns);
    std::uint64_t start_ns() const { return std::min(first_ns, last_ns); }
  };

  McapWriter(AtomicFile file, Compression compression) : file_(std::move(file)), compression_(compression) {}
  Result<void> put(std::string_view bytes);
  std::uint16_t schema_of(const McapChannel& channel);
  void note_metadata(std::uint64_t bytes, std::string_view name);
  std::string message_indexes(std::string& places);
  Result<void> end_chunk();
  std::string statistics() const;
  std::string summary() const;

  AtomicFile file_;
  Compression compression_;
  std::uint64_t at_ = 0;  // the bytes written so far
  std::string schema_records_, channel_records_;
  std::vector<Schema> schemas_;
  std::vector<std::uint64_t> counts_;  // of messages, by channel
  std::string chunk_;
  std::map<std::uint16_t, std::vector<IndexEntry>> index_;  // of the chunk, by channel
  TimeSpan chunk_times_, times_;
  std::string chunk_indexes_, attachment_indexes_, metadata_indexes_;
  std::uint32_t chunks_ = 0, attachments_ = 0, metadata_ = 0;
};

}  // namespace sweepscope
