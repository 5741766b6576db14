#include "core/apply/message_sink.hpp"
#include "core/apply/provenance.hpp"
#include "core/recording/ros2/mcap_writer.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

std::uint64_t unsigned_ns(std::int64_t ns) {
  return ns < 0 ? 0 : static_cast<std::uint64_t>(ns);
}

class McapSink : public MessageSink {
 public:
  explicit McapSink(McapWriter writer) : writer_(std::move(writer)) {}

  Result<void> add_topic(const StreamTopic& topic) override {
    return writer_
        .add_channel({topic.name, topic.encoding, topic.type, "", topic.schema_encoding, topic.definition,
                      topic.metadata})
        .map([](std::uint16_t) {});
  }

  Result<void> write(const StreamMessage& message) override {
    return writer_.write({static_cast<std::uint16_t>(message.topic), message.sequence,
                          unsigned_ns(message.log_ns), unsigned_ns(message.publish_ns)},
                         message.bytes);
  }

  Result<void> finish(const std::vector<std::string>& records) override {
    for (const std::string& record : records)
      if (auto written = writer_.write_metadata(kAppliedMetadata, {{"record", record}}); !written)
        return written;
    return writer_.finish();
  }

 private:
  McapWriter writer_;
};

}  // namespace

Result<std::unique_ptr<MessageSink>> create_mcap_sink(const fs::path& path, Compression compression,
                                                      const std::string& profile,
                                                      const std::vector<fs::path>& kept_from) {
  std::vector<McapExtras> all;
  for (const fs::path& kept : kept_from) {
    auto extras = find_mcap_extras(kept);
    if (!extras) return tl::unexpected(extras.error());
    all.push_back(std::move(*extras));
  }
  auto writer = McapWriter::create(path, compression, all.empty() ? profile : all.front().profile);
  if (!writer) return tl::unexpected(writer.error());
  for (std::size_t i = 0; i < all.size(); ++i)
    for (const McapExtra& extra : all[i].records)
      if (auto copied = writer->copy(kept_from[i], extra); !copied) return tl::unexpected(copied.error());
  return std::make_unique<McapSink>(std::move(*writer));
}

}  // namespace sweepscope
