#include "core/recording/ros1/ros1_recording.hpp"

#include "core/recording/messages/message_collector.hpp"
#include "core/recording/ros1/ros1_bag.hpp"

namespace sweepscope {

Result<RawRecording> read_ros1_recording(const std::filesystem::path& path, const Rig& rig, const Job& job,
                                         const ReadDetail& detail) {
  RawRecording raw;
  raw.file = path.string();
  raw.name = path.filename().string();
  MessageCollector collector(rig, raw, detail);
  const auto visit = [&](const BagMessage& message) {
    const BagConnection& from = message.connection;
    const std::size_t topic =
        collector.number_of({from.topic, from.type, Encoding::kRos1, true, from.md5sum});
    return collector.add(topic, message.receive_ns, message.bytes, [&] { return message.place.text(); });
  };
  auto damage = read_ros1_bag(path, visit, job);
  if (!damage) return tl::unexpected(std::move(damage.error()));
  collector.finish();
  raw.warnings.insert(raw.warnings.begin(), damage->begin(), damage->end());
  return raw;
}

}  // namespace sweepscope
