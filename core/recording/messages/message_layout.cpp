#include "core/recording/messages/message_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>

#include "core/recording/messages/message_archives.hpp"
#include "core/recording/messages/message_definitions.hpp"

namespace sweepscope {
namespace {

constexpr std::size_t kMaxTypes = 500, kMaxVisited = 1000;
constexpr std::string_view kHeader = "std_msgs/Header", kSpaces = " \t\r\n";

struct NumberType {
  std::string_view name;
  std::size_t bytes;
  double (*read)(MessageReader&);
};

template <typename T>
constexpr NumberType number_type(std::string_view name) {
  return {name, sizeof(T), [](MessageReader& reader) {
            T value{};
            reader.numbers(value);
            return static_cast<double>(value);
          }};
}

constexpr NumberType kNumbers[] = {number_type<std::uint8_t>("bool"),    number_type<std::uint8_t>("byte"),
                                   number_type<std::uint8_t>("char"),    number_type<std::int8_t>("int8"),
                                   number_type<std::uint8_t>("uint8"),   number_type<std::int16_t>("int16"),
                                   number_type<std::uint16_t>("uint16"), number_type<std::int32_t>("int32"),
                                   number_type<std::uint32_t>("uint32"), number_type<std::int64_t>("int64"),
                                   number_type<std::uint64_t>("uint64"), number_type<float>("float32"),
                                   number_type<double>("float64")};

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kSpaces), text.size()));
  return text.substr(0, text.find_last_not_of(kSpaces) + 1);
}

/// Takes the text up to one of `ends` off the front.
std::string_view take_until(std::string_view& text, std::string_view ends) {
  const std::string_view word = text.substr(0, text.find_first_of(ends));
  text.remove_prefix(word.size());
  return word;
}

/// A name and the index behind it: "position[2]", "position[]", "position".
struct NamedStep {
  std::string_view name;
  std::optional<std::uint32_t> index;
};

std::optional<NamedStep> parse_step(std::string_view text) {
  NamedStep step{take_until(text, "["), {}};
  if (text.empty() || text == "[]") return step;
  std::uint32_t index = 0;
  const char* const end = text.data() + text.size() - 1;
  const auto [after, error] = std::from_chars(text.data() + 1, end, index);
  if (error != std::errc() || after != end || *end != ']') return std::nullopt;
  step.index = index;
  return step;
}

}  // namespace

/// Resolves the types of a definition, each where it is first used.
class MessageLayout::Parser {
 public:
  Parser(std::string_view definition, Encoding encoding, MessageLayout& layout)
      : encoding_(encoding), layout_(layout) {
    split(definition);
  }

  Result<std::size_t> add(const std::string& name);

 private:
  void split(std::string_view definition);
  Result<void> add_member(std::string_view line, std::size_t type);
  Result<void> set_type(Member& member, std::string_view word, const std::string& enclosing);

  static constexpr std::size_t kBeingAdded = SIZE_MAX;
  Encoding encoding_;
  MessageLayout& layout_;
  std::map<std::string, std::string_view> texts_;  // of the types; "" is the message's own
  std::map<std::string, std::size_t> numbers_;     // of the types that were added
  std::size_t members_ = 0;
};

/// The types behind the first begin with a line "MSG: package/Type", after a line of "=".
void MessageLayout::Parser::split(std::string_view definition) {
  std::string name;
  std::size_t begin = 0;
  for (std::size_t at = 0; at < definition.size();) {
    const std::size_t end = std::min(definition.find('\n', at), definition.size());
    const std::string_view line = trimmed(definition.substr(at, end - at));
    if (line.starts_with("MSG: ")) {
      texts_.try_emplace(name, definition.substr(begin, at - begin));
      name = short_type_name(trimmed(line.substr(5)));
      begin = end;
    }
    at = end + 1;
  }
  texts_.try_emplace(name, definition.substr(std::min(begin, definition.size())));
}

Result<std::size_t> MessageLayout::Parser::add(const std::string& name) {
  if (const auto known = numbers_.find(name); known != numbers_.end()) {
    if (known->second == kBeingAdded) return unreadable(fmt::format("{} contains itself", name));
    return known->second;
  }
  const std::size_t number = layout_.types_.size();
  const auto described = texts_.find(number == 0 ? "" : name);
  const bool found = described != texts_.end() && !trimmed(described->second).empty();
  const std::string own = found ? "" : members_of(name, encoding_);
  // A type that others use may have no members.
  if (!found && own.empty() && (number == 0 || described == texts_.end()))
    return unreadable(
        fmt::format("the recording does not hold the definition of {}; convert it to MCAP with `ros2 bag "
                    "convert` on a computer that has the package of this message",
                    name));
  if (number == kMaxTypes)
    return unreadable(fmt::format("{} is made of too many types", layout_.types_[0].name));
  if (number == 0 && !found) layout_.goes_on_ = only_beginning_known(name);
  numbers_[name] = kBeingAdded;
  layout_.types_.push_back({name, {}});
  std::string_view text = found ? described->second : std::string_view(own);
  while (!text.empty()) {
    const std::string_view line = take_until(text, "\n");
    if (auto added = add_member(line, number); !added) return tl::unexpected(added.error());
    text.remove_prefix(std::min<std::size_t>(text.size(), 1));
  }
  numbers_[name] = number;
  return number;
}

/// "float64[3] name", in ROS 2 with bounds ("string<=10") and a default behind it; constants have a "=".
Result<void> MessageLayout::Parser::add_member(std::string_view line, std::size_t type) {
  constexpr std::size_t kMaxMembers = 10'000;
  std::string_view rest = trimmed(line);
  if (rest.empty() || rest.front() == '#' || rest.front() == '=') return {};
  const std::string_view word = take_until(rest, kSpaces);
  rest = trimmed(rest);
  const std::string_view name = take_until(rest, " \t=#");
  if (trimmed(rest).starts_with('=')) return {};
  const std::string enclosing = layout_.types_[type].name;
  if (name.empty() || ++members_ > kMaxMembers)
    return unreadable(
        fmt::format("the definition of {} is damaged at \"{}\"", enclosing, line.substr(0, 40)));
  Member member;
  member.name = name;
  return set_type(member, word, enclosing).map([&] {
    // What takes no bytes is left out, so that as many steps are taken as there are bytes.
    const bool empty = member.fixed == 0U || (member.kind == Kind::kMessage && encoding_ == Encoding::kRos1 &&
                                              layout_.types_[member.number].members.empty());
    if (!empty) layout_.types_[type].members.push_back(std::move(member));
  });
}

Result<void> MessageLayout::Parser::set_type(Member& member, std::string_view word,
                                             const std::string& enclosing) {
  std::string_view brackets = word;
  std::string_view plain = take_until(brackets, "[");
  plain = plain.substr(0, plain.find('<'));
  member.array = !brackets.empty();
  std::uint32_t count = 0;
  if (member.array && brackets.size() > 1 && brackets[1] >= '0' && brackets[1] <= '9') {
    std::from_chars(brackets.data() + 1, brackets.data() + brackets.size(), count);
    member.fixed = count;
  }
  const auto* const number = std::ranges::find(kNumbers, plain, &NumberType::name);
  if (number != std::end(kNumbers)) {
    member.number = static_cast<std::size_t>(number - std::begin(kNumbers));
    return {};
  }
  member.kind = plain == "string" ? Kind::kText : Kind::kTime;
  if (plain == "string" || (encoding_ == Encoding::kRos1 && (plain == "time" || plain == "duration")))
    return {};
  if (plain == "wstring") return unreadable(fmt::format("{} holds a wstring", enclosing));
  member.kind = Kind::kMessage;
  std::string name = short_type_name(plain);
  if (name == "Header") name = kHeader;
  if (name.find('/') == std::string::npos) name = enclosing.substr(0, enclosing.find('/') + 1) + name;
  return add(name).map([&](std::size_t found) { member.number = found; });
}

Result<MessageLayout> MessageLayout::parse(const MessageTopic& topic) {
  MessageLayout layout;
  layout.encoding_ = topic.encoding;
  const auto added = Parser(topic.definition, topic.encoding, layout).add(short_type_name(topic.type));
  if (!added)
    return unreadable(
        fmt::format("topic {} ({}) cannot be read: {}", topic.name, topic.type, added.error().message));
  return layout;
}

std::optional<MessageLayout::Path> MessageLayout::find(std::string_view name) const {
  Path path;
  std::size_t type = 0;
  while (true) {
    const auto step = parse_step(take_until(name, "."));
    if (!step) return std::nullopt;
    const std::vector<Member>& members = types_[type].members;
    const auto member = std::ranges::find(members, step->name, &Member::name);
    if (member == members.end() || (step->index && !member->array)) return std::nullopt;
    path.push_back({static_cast<std::size_t>(member - members.begin()), step->index});
    if (name.empty()) return path;
    if (member->kind != Kind::kMessage) return std::nullopt;
    type = member->number;
    name.remove_prefix(1);
  }
}

/// Calls `take` with each member and the name of the field that it is, and with the first ones where there
/// are more than a person reads.
template <typename Take>
void MessageLayout::visit(std::size_t type, const std::string& before, std::size_t& left,
                          const Take& take) const {
  for (const Member& member : types_[type].members) {
    if (left == 0) return;
    --left;
    const std::string name = before + member.name + (member.array ? "[0]" : "");
    take(member, name);
    if (member.kind == Kind::kMessage && types_[member.number].name != kHeader)
      visit(member.number, name + ".", left, take);
  }
}

std::vector<std::string> MessageLayout::numbers() const {
  std::vector<std::string> names;
  std::size_t left = kMaxVisited;
  visit(0, "", left, [&](const Member& member, const std::string& name) {
    if (member.kind == Kind::kNumber) names.push_back(name);
  });
  return names;
}

std::vector<std::string> MessageLayout::fields_of(std::string_view type) const {
  std::vector<std::string> names;
  std::size_t left = kMaxVisited;
  visit(0, "", left, [&](const Member& member, const std::string& name) {
    if (member.kind == Kind::kMessage && types_[member.number].name == type) names.push_back(name);
  });
  return names;
}

bool MessageLayout::has_header() const {
  const std::vector<Member>& members = types_.front().members;
  return !members.empty() && !members.front().array && members.front().kind == Kind::kMessage &&
         types_[members.front().number].name == kHeader;
}

const MessageLayout::Member* MessageLayout::last_of(const Path& path) const {
  const Member* member = nullptr;
  for (const Step& step : path) member = &types_[member == nullptr ? 0 : member->number].members[step.member];
  return member;
}

bool MessageLayout::is_number(const Path& path) const {
  return last_of(path)->kind == Kind::kNumber;
}

bool MessageLayout::is_message(const Path& path, std::string_view type) const {
  const Member& last = *last_of(path);
  return last.kind == Kind::kMessage && types_[last.number].name == type;
}

bool MessageLayout::is_single(const Path& path) const {
  std::size_t type = 0;
  return std::ranges::all_of(path, [&](const Step& step) {
    const Member& member = types_[type].members[step.member];
    type = member.number;
    return !member.array || step.index;
  });
}

/// Walks through one message, and takes what lies at the path.
class MessageLayout::Walk {
 public:
  Walk(const MessageLayout& layout, std::span<const std::byte> message, const Path& path, Found& found)
      : layout_(layout), path_(path), found_(found), reader_(layout.encoding_, message) {}

  bool walk() {
    of_type(0, 0, false);
    return layout_.goes_on_ ? reader_.whole() : reader_.at_end();
  }

 private:
  static constexpr std::size_t kAside = SIZE_MAX;  // not on the path

  /// `depth`: of the path's step within this type; `taken`: all of it is taken.
  void of_type(std::size_t type, std::size_t depth, bool taken) {
    const std::vector<Member>& members = layout_.types_[type].members;
    // A struct of no members has a byte in CDR.
    if (members.empty()) reader_.skip(1, 1);
    for (std::size_t i = 0; i < members.size() && reader_.whole(); ++i) {
      const bool on_path = depth < path_.size() && path_[depth].member == i;
      of_member(members[i], on_path ? depth : kAside, taken);
    }
  }

  void of_member(const Member& member, std::size_t depth, bool taken) {
    std::uint32_t count = 1;
    if (member.fixed) count = *member.fixed;
    if (member.array && !member.fixed) reader_.numbers(count);
    if (member.kind == Kind::kNumber && depth == kAside && !taken)
      return reader_.skip(kNumbers[member.number].bytes, count);
    for (std::uint32_t i = 0; i < count && reader_.whole(); ++i) {
      const bool chosen = depth != kAside && (!path_[depth].index || *path_[depth].index == i);
      const bool last = chosen && depth + 1 == path_.size();
      of_element(member, chosen && !last ? depth + 1 : kAside, taken || last, last);
    }
  }

  void of_element(const Member& member, std::size_t depth, bool taken, bool last) {
    if (member.kind == Kind::kMessage) {
      const std::size_t begin = reader_.at();
      of_type(member.number, depth, taken);
      if (last) found_.bytes = reader_.since(begin);
    } else if (member.kind == Kind::kText) {
      std::string_view text;
      reader_.text(text);
      if (taken) found_.texts.push_back(text);
    } else if (member.kind == Kind::kTime) {
      reader_.skip(4, 2);
    } else {
      const double number = kNumbers[member.number].read(reader_);
      if (taken) found_.numbers.push_back(number);
    }
  }

  const MessageLayout& layout_;
  const Path& path_;
  Found& found_;
  MessageReader reader_;
};

bool MessageLayout::read(std::span<const std::byte> message, const Path& path, Found& found) const {
  found.numbers.clear();
  found.texts.clear();
  found.bytes = {};
  return Walk(*this, message, path, found).walk();
}

}  // namespace sweepscope
