// Messages of any type: the definition up to the first NUL, the field up to the second, and the message
// behind it.
#include "core/recording/messages/joint_reader.hpp"

#include <algorithm>

#include "core/recording/messages/scan_reader.hpp"
#include "tests/fuzz/memory_file.hpp"

int fuzz_message_layout(const std::uint8_t* bytes, std::size_t size) {
  namespace ss = sweepscope;
  std::string_view rest = ss::test::text_of(bytes, size);
  const auto take = [&] {
    const std::string_view part = rest.substr(0, rest.find('\0'));
    rest.remove_prefix(std::min(rest.size(), part.size() + 1));
    return std::string(part);
  };
  ss::MessageTopic topic{"/state", "my_msgs/State"};
  topic.definition = take();
  const std::string field = take();
  const auto message = std::as_bytes(std::span(rest.data(), rest.size()));
  for (const ss::Encoding encoding : {ss::Encoding::kRos1, ss::Encoding::kCdr}) {
    topic.encoding = encoding;
    auto joints = ss::JointReader::by_definition(topic, field, {});
    ss::test::expect_sentence(joints);
    std::vector<ss::DecodedJoint> decoded;
    if (joints) joints->read(message, Eigen::Vector3d::UnitX(), decoded);
    auto scans = ss::ScanReader::by_definition(topic, {}, ss::Echo::kStrongest);
    ss::test::expect_sentence(scans);
    if (scans) scans->read(message);
  }
  return 0;
}
