#include "core/live/ros_source.hpp"

#ifdef SWEEPSCOPE_HAS_ROS
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <set>
#include <span>

#include "core/live/heard_messages.hpp"
#include "core/live/ros_link.hpp"
#endif

namespace sweepscope {

#ifdef SWEEPSCOPE_HAS_ROS

namespace {

class RosSource : public LiveSource {
 public:
  RosSource(std::shared_ptr<RosLink> link, const Rig& rig) : link_(std::move(link)), messages_("ROS", rig) {}

  /// A topic that is not to be heard.
  void leave_out(const std::string& topic) { subscribed_.insert(topic); }

  Result<bool> listen(std::chrono::milliseconds max_wait) override {
    constexpr std::chrono::milliseconds kBetweenLooks(500);
    const auto now = std::chrono::steady_clock::now();
    if (subscribed_.empty() || now - looked_ > kBetweenLooks) {
      subscribe();
      looked_ = now;
    }
    Result<void> taken;
    link_->receive(max_wait, [&](const RosMessage& message) {
      const std::size_t topic = messages_.number_of({message.topic, message.type, Encoding::kRos1, true,
                                                     message.md5sum.empty() ? "*" : message.md5sum});
      const auto bytes = std::as_bytes(std::span(message.bytes, message.size));
      if (taken) taken = messages_.add(topic, message.receive_ns, bytes);
    });
    return taken.map([] { return true; });
  }
  const RawRecording& so_far() const override { return messages_.so_far(); }
  RawRecording heard() override { return messages_.with_warnings(); }
  RawRecording take() override { return messages_.take(); }

 private:
  void subscribe() {
    constexpr std::uint32_t kClouds = 50, kOthers = 2000;  // clouds are of megabytes each
    for (const RosTopic& topic : link_->topics()) {
      const auto* const type = find_message_type(topic.type);
      if (!may_be_laser_or_motor(type)) continue;
      if (subscribed_.insert(topic.name).second)
        link_->subscribe(topic.name, type->kind == MessageKind::kCloud ? kClouds : kOthers);
    }
  }

  std::shared_ptr<RosLink> link_;
  HeardMessages messages_;
  std::set<std::string> subscribed_;
  std::chrono::steady_clock::time_point looked_;
};

class RosPublisher : public LivePublisher {
 public:
  explicit RosPublisher(std::shared_ptr<RosLink> link) : link_(std::move(link)) {
    // Those of the first seconds come together.
    constexpr std::uint32_t kClouds = 200, kTransforms = 20'000;
    for (const StreamTopic& topic : live_topics()) {
      const auto kind = LiveTopic(topics_.size());
      topics_.push_back(link_->advertise(
          {topic.name, topic.type, topic.metadata_of("md5sum"), topic.definition,
           kind == LiveTopic::kTransform ? kTransforms : kClouds, kind == LiveTopic::kOffset}));
    }
  }
  void publish(const LiveMessage& message) override {
    link_->publish(topics_[std::size_t(message.topic)], message.bytes);
  }

 private:
  std::shared_ptr<RosLink> link_;
  std::vector<std::size_t> topics_;
};

/// Whether it is http://HOST:PORT: roscpp ends the whole program at any other address.
bool is_address(std::string_view uri) {
  constexpr std::string_view kScheme = "http://";
  if (!uri.starts_with(kScheme)) return false;
  uri.remove_prefix(kScheme.size());
  if (uri.ends_with('/')) uri.remove_suffix(1);
  const std::size_t colon = uri.find(':');
  if (colon == 0 || colon == std::string_view::npos) return false;
  const auto is_of_a_name = [](char c) { return c > ' ' && c < 0x7f && c != '/'; };
  if (!std::all_of(uri.begin(), uri.begin() + std::ptrdiff_t(colon), is_of_a_name)) return false;
  std::uint16_t port = 0;
  const char* const end = uri.data() + uri.size();
  const auto [behind, error] = std::from_chars(uri.data() + colon + 1, end, port);
  return error == std::errc() && behind == end && port > 0;
}

Result<std::shared_ptr<RosLink>> open_link() {
  const char* const given = std::getenv("ROS_MASTER_URI");
  const std::string master = given != nullptr ? given : "http://localhost:11311";
  if (!is_address(master))
    return unreadable(fmt::format(
        "ROS: ROS_MASTER_URI=\"{}\" is not the address of a master, such as http://localhost:11311", master));
  auto link = RosLink::open(master);
  if (!link) return unreadable(fmt::format("ROS: no master answers at {} (ROS_MASTER_URI)", master));
  return std::shared_ptr<RosLink>(std::move(link));
}

}  // namespace

bool ros_source_is_built() {
  return true;
}

Result<std::unique_ptr<LiveSource>> open_ros_source(const Rig& rig) {
  auto link = open_link();
  if (!link) return tl::unexpected(link.error());
  return std::make_unique<RosSource>(std::move(*link), rig);
}

Result<RosSystem> open_ros_system(const Rig& rig) {
  const auto link = open_link();
  if (!link) return tl::unexpected(link.error());
  auto source = std::make_unique<RosSource>(*link, rig);
  // The motor's angles may be on /tf.
  for (const StreamTopic& topic : live_topics())
    if (topic.name != "/tf") source->leave_out(topic.name);
  return RosSystem{std::move(source), std::make_unique<RosPublisher>(*link)};
}

#else

namespace {

tl::unexpected<Error> not_built() {
  return failure(ExitCode::kWrongUsage,
                 "ROS: this build cannot listen to ROS 1; it was made without roscpp (libroscpp-dev)");
}

}  // namespace

bool ros_source_is_built() {
  return false;
}

Result<std::unique_ptr<LiveSource>> open_ros_source(const Rig&) {
  return not_built();
}

Result<RosSystem> open_ros_system(const Rig&) {
  return not_built();
}

#endif

}  // namespace sweepscope
