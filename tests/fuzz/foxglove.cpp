// What a Foxglove server sends: lines of text up to an empty one, then binary messages, each after its length
// in two bytes. They are listened to as `calibrate foxglove` does.
#include "core/live/foxglove_protocol.hpp"
#include "core/live/heard_messages.hpp"
#include "tests/fuzz/memory_file.hpp"

namespace {

using namespace sweepscope;

std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

std::string_view take_message(std::string_view& bytes) {
  const auto low = static_cast<std::uint8_t>(bytes[0]), high = static_cast<std::uint8_t>(bytes[1]);
  const std::string_view message = bytes.substr(2, low + 256U * high);
  bytes.remove_prefix(2 + message.size());
  return message;
}

/// The number of each topic that is subscribed to.
std::vector<std::size_t> topics_of(const FoxgloveNews& news, HeardMessages& heard) {
  std::vector<std::size_t> topics;
  for (const FoxgloveChannel& channel : news.advertised) {
    if (!may_be_laser_or_motor(find_message_type(channel.type))) continue;
    const Encoding encoding = channel.encoding == "ros1" ? Encoding::kRos1 : Encoding::kCdr;
    topics.push_back(heard.number_of({channel.topic, channel.type, encoding, true, "*"}));
  }
  return topics;
}

}  // namespace

int fuzz_foxglove(const std::uint8_t* bytes, std::size_t size) {
  std::string_view rest = test::text_of(bytes, size);
  const Rig rig;
  HeardMessages heard("ws://fuzz", rig);
  std::vector<std::size_t> topics;
  while (!rest.empty()) {
    const std::string_view line = take_line(rest);
    if (line.empty()) break;
    (void)parse_foxglove_address(line);
    (void)parse_foxglove_request(line);
    const auto news = parse_foxglove_text(line);
    if (!news) continue;
    const auto added = topics_of(*news, heard);
    topics.insert(topics.end(), added.begin(), added.end());
  }
  while (rest.size() >= 2) {
    const std::string_view message = take_message(rest);
    const auto parsed = parse_foxglove_bytes(std::as_bytes(std::span(message)));
    if (!parsed || parsed->subscription >= topics.size()) continue;
    const auto taken = heard.add(topics[parsed->subscription], parsed->log_ns, parsed->bytes);
    test::expect_sentence(taken);
    if (!taken) break;
  }
  (void)heard.with_warnings();
  return 0;
}
