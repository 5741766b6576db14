#include "core/live/ros_link.hpp"

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <cstring>
#include <optional>

namespace sweepscope {

/// Any message, as bytes.
struct AnyRosMessage {
  std::vector<std::uint8_t> bytes;
};

}  // namespace sweepscope

namespace ros {
namespace message_traits {

template <>
struct IsMessage<sweepscope::AnyRosMessage> : TrueType {};
template <>
struct IsMessage<const sweepscope::AnyRosMessage> : TrueType {};
template <>
struct MD5Sum<sweepscope::AnyRosMessage> {
  static const char* value() { return "*"; }
  static const char* value(const sweepscope::AnyRosMessage&) { return value(); }
};
template <>
struct DataType<sweepscope::AnyRosMessage> {
  static const char* value() { return "*"; }
  static const char* value(const sweepscope::AnyRosMessage&) { return value(); }
};
template <>
struct Definition<sweepscope::AnyRosMessage> {
  static const char* value() { return ""; }
};

}  // namespace message_traits
namespace serialization {

template <>
struct Serializer<sweepscope::AnyRosMessage> {
  template <typename Stream>
  static void read(Stream& stream, sweepscope::AnyRosMessage& message) {
    message.bytes.assign(stream.getData(), stream.getData() + stream.getLength());
    stream.advance(stream.getLength());
  }
  template <typename Stream>
  static void write(Stream& stream, const sweepscope::AnyRosMessage& message) {
    if (message.bytes.empty()) return;
    std::memcpy(stream.advance(serializedLength(message)), message.bytes.data(), message.bytes.size());
  }
  static std::uint32_t serializedLength(const sweepscope::AnyRosMessage& message) {
    return static_cast<std::uint32_t>(message.bytes.size());
  }
};

}  // namespace serialization
}  // namespace ros

namespace sweepscope {
namespace {

// Asks the master, which may be gone; what roscpp asks by itself waits until it is back.
std::optional<XmlRpc::XmlRpcValue> ask_master(const std::string& method, const std::string& about) {
  XmlRpc::XmlRpcValue request, response, answer;
  request[0] = ros::this_node::getName();
  request[1] = about;
  if (!ros::master::execute(method, request, response, answer, false)) return std::nullopt;
  return answer;
}

class RoscppLink : public RosLink {
 public:
  RoscppLink() { node_.setCallbackQueue(&queue_); }

  std::vector<RosTopic> topics() override {
    std::vector<RosTopic> topics;
    auto found = ask_master("getPublishedTopics", "");
    if (!found) return topics;
    if (!ask_master("lookupNode", ros::this_node::getName())) register_again();
    for (int i = 0; i < found->size(); ++i)
      topics.push_back({std::string((*found)[i][0]), std::string((*found)[i][1])});
    return topics;
  }

  std::size_t advertise(const RosPublishedTopic& topic) override {
    published_.push_back({topic, advertised(topic), {}});
    return published_.size() - 1;
  }

  void publish(std::size_t topic, const std::string& bytes) override {
    Published& published = published_[topic];
    AnyRosMessage message;
    message.bytes.assign(bytes.begin(), bytes.end());
    published.publisher.publish(message);
    if (published.topic.latched) published.latest = std::move(message);
  }

  void subscribe(const std::string& topic, std::uint32_t max_queued) override {
    subscribed_.push_back({topic, max_queued, subscriber_of(topic, max_queued)});
  }

  void receive(std::chrono::milliseconds max_wait,
               const std::function<void(const RosMessage&)>& take) override {
    take_ = &take;
    queue_.callAvailable(ros::WallDuration(static_cast<double>(max_wait.count()) * 1e-3));
    take_ = nullptr;
  }

 private:
  using Event = ros::MessageEvent<AnyRosMessage const>;
  struct Subscribed {
    std::string topic;
    std::uint32_t max_queued;
    ros::Subscriber subscriber;
  };
  struct Published {
    RosPublishedTopic topic;
    ros::Publisher publisher;
    AnyRosMessage latest;  // of a latched topic
  };

  ros::Subscriber subscriber_of(const std::string& topic, std::uint32_t max_queued) {
    const boost::function<void(const Event&)> take = [this, topic](const Event& event) {
      if (event.getPublisherName() == ros::this_node::getName()) return;
      const ros::M_string& said = event.getConnectionHeader();
      const auto value = [&](const char* key) {
        const auto found = said.find(key);
        return found == said.end() ? std::string() : found->second;
      };
      const std::string type = value("type"), md5sum = value("md5sum");
      const std::vector<std::uint8_t>& bytes = event.getMessage()->bytes;
      const auto received_ns = static_cast<std::int64_t>(event.getReceiptTime().toNSec());
      if (take_ != nullptr) (*take_)({topic, type, md5sum, received_ns, bytes.data(), bytes.size()});
    };
    return node_.subscribe<AnyRosMessage>(topic, max_queued, take, ros::VoidConstPtr(),
                                          ros::TransportHints().tcpNoDelay());
  }

  ros::Publisher advertised(const RosPublishedTopic& topic) {
    ros::AdvertiseOptions options(topic.name, topic.max_queued, topic.md5sum, topic.type, topic.definition);
    options.latch = topic.latched;
    return node_.advertise(options);
  }

  // A master that was started again knows no node. Connections that lasted without it are made anew.
  void register_again() {
    for (Subscribed& one : subscribed_) {
      one.subscriber.shutdown();
      one.subscriber = subscriber_of(one.topic, one.max_queued);
    }
    for (Published& one : published_) {
      one.publisher.shutdown();
      one.publisher = advertised(one.topic);
      if (!one.latest.bytes.empty()) one.publisher.publish(one.latest);
    }
  }

  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  std::vector<Subscribed> subscribed_;
  std::vector<Published> published_;
  const std::function<void(const RosMessage&)>* take_ = nullptr;
};

}  // namespace

std::unique_ptr<RosLink> RosLink::open(const std::string& master) {
  // Signals stay the program's, and its log is not published. Without a name for its log roscpp makes ~/.ros.
  ros::init(
      ros::M_string{{"__master", master}, {"__log", "/dev/null"}}, "sweepscope",
      ros::init_options::NoSigintHandler | ros::init_options::AnonymousName | ros::init_options::NoRosout);
  if (!ros::master::check()) return nullptr;
  return std::make_unique<RoscppLink>();
}

}  // namespace sweepscope
