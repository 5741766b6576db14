#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/recording/messages/message_topic.hpp"

namespace sweepscope {

/// Where the fields of a type of messages lie, by its definition: that of a ROS 1 bag, or of a schema of
/// "ros1msg" or "ros2msg". Messages are those of messages.hpp, and reading is bounded in the same way.
class MessageLayout {
 public:
  /// What a topic's definition leaves out is taken from the definitions that sweepscope knows (members_of).
  /// The error is a sentence about the topic.
  static Result<MessageLayout> parse(const MessageTopic& topic);

  /// A field within a message.
  struct Step {
    std::size_t member = 0;
    std::optional<std::uint32_t> index;  // of an array's element; empty: all elements
  };
  using Path = std::vector<Step>;
  /// The field of that name, with an index for one element of an array: "motor_states[0].position". Empty if
  /// there is none.
  std::optional<Path> find(std::string_view name) const;
  /// The names of all numbers, outside of headers, with the index 0 in arrays; the first ones where
  /// there are more than a person reads.
  std::vector<std::string> numbers() const;
  /// The names of the fields of that type.
  std::vector<std::string> fields_of(std::string_view type) const;
  /// Whether a message begins with a std_msgs/Header.
  bool has_header() const;
  /// A number or an array of them.
  bool is_number(const Path& path) const;
  /// A message of that type or an array of them.
  bool is_message(const Path& path, std::string_view type) const;
  /// Whether it is one field: every array has an index.
  bool is_single(const Path& path) const;

  /// What a message holds at a path: all of its numbers and texts in their order, and of one message the
  /// bytes. Views are of the message.
  struct Found {
    std::vector<double> numbers;
    std::vector<std::string_view> texts;
    std::span<const std::byte> bytes;
  };
  /// Fills `found`, whose memory is reused; false if the message is malformed.
  bool read(std::span<const std::byte> message, const Path& path, Found& found) const;

 private:
  enum class Kind { kMessage, kNumber, kText, kTime };
  struct Member {
    std::string name;
    Kind kind = Kind::kNumber;
    std::size_t number = 0;  // of a message its type, of a number its row in a table of them
    bool array = false;
    std::optional<std::uint32_t> fixed;  // an array of so many elements
  };
  struct Type {
    std::string name;
    std::vector<Member> members;
  };
  class Parser;
  class Walk;
  const Member* last_of(const Path& path) const;
  template <typename Take>
  void visit(std::size_t type, const std::string& before, std::size_t& left, const Take& take) const;

  Encoding encoding_ = Encoding::kRos1;
  std::vector<Type> types_;  // the first is the message's
  bool goes_on_ = false;     // messages hold more than is known
};

}  // namespace sweepscope
