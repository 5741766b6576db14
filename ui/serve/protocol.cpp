#include "ui/serve/protocol.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

namespace sweepscope::ui {
namespace {

using PageJson = nlohmann::json;

constexpr std::size_t kMaxEvents = 64, kMaxTyped_bytes = 256, kMaxPasted_bytes = std::size_t{32} * 1024;

tl::unexpected<Error> wrong(const std::string& what) {
  return unreadable("a page's message: " + what);
}

std::optional<double> number_in(const PageJson& value, double least, double greatest) {
  if (!value.is_number()) return std::nullopt;
  const double number = value.get<double>();
  if (!std::isfinite(number)) return std::nullopt;
  return std::clamp(number, least, greatest);
}

std::uint32_t counted(const PageJson& message, const char* key) {
  const auto found = message.find(key);
  const auto number = found == message.end() ? std::nullopt : number_in(*found, 0, 4294967295.0);
  return static_cast<std::uint32_t>(number.value_or(0));
}

const std::string* text_in(const PageJson& value, std::size_t max_bytes) {
  const auto* text = value.get_ptr<const std::string*>();
  return text != nullptr && text->size() <= max_bytes ? text : nullptr;
}

/// Characters that control a terminal, or end a text early, are left out.
std::string without_controls(const std::string& text, bool lines) {
  std::string out;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code >= 0x20 && code != 0x7F) out += c;
    if (lines && (c == '\n' || c == '\t')) out += c;
  }
  return out;
}

std::optional<bool> flag_in(const PageJson& value) {
  return value.is_boolean() ? std::optional(value.get<bool>()) : std::nullopt;
}

std::optional<unsigned> modifiers_in(const PageJson& value) {
  const auto number = number_in(value, 0, 7);
  return number ? std::optional(static_cast<unsigned>(*number)) : std::nullopt;
}

std::optional<InputEvent> move(const PageJson& event) {
  constexpr double kFar_px = 16384;
  if (event.size() != 3) return std::nullopt;
  const auto x = number_in(event[1], -kFar_px, kFar_px), y = number_in(event[2], -kFar_px, kFar_px);
  if (!x || !y) return std::nullopt;
  return InputEvent::move(*x, *y);
}

std::optional<InputEvent> press(const PageJson& event) {
  if (event.size() != 4) return std::nullopt;
  const auto button = number_in(event[1], 0, 2);
  const auto down = flag_in(event[2]);
  const auto modifiers = modifiers_in(event[3]);
  if (!button || !down || !modifiers) return std::nullopt;
  return InputEvent::press(static_cast<int>(*button), *down, *modifiers);
}

std::optional<InputEvent> wheel(const PageJson& event) {
  const auto clicks = event.size() == 2 ? number_in(event[1], -50, 50) : std::nullopt;
  return clicks ? std::optional(InputEvent::scroll(*clicks)) : std::nullopt;
}

std::optional<InputEvent> key(const PageJson& event) {
  if (event.size() != 4) return std::nullopt;
  const std::string* name = text_in(event[1], 16);
  const auto down = flag_in(event[2]);
  const auto modifiers = modifiers_in(event[3]);
  const auto chord = name != nullptr ? parse_chord(*name) : std::nullopt;
  if (!chord || chord->modifiers != 0 || !down || !modifiers) return std::nullopt;
  return InputEvent::stroke(chord->key, *down, *modifiers);
}

std::optional<InputEvent> typed(const PageJson& event) {
  const std::string* text = event.size() == 2 ? text_in(event[1], kMaxTyped_bytes) : nullptr;
  return text != nullptr ? std::optional(InputEvent::words(without_controls(*text, false))) : std::nullopt;
}

std::optional<InputEvent> event_of(const PageJson& event) {
  const std::string* what = event.is_array() && !event.empty() ? text_in(event[0], 16) : nullptr;
  if (what == nullptr) return std::nullopt;
  if (*what == "move") return move(event);
  if (*what == "press") return press(event);
  if (*what == "wheel") return wheel(event);
  if (*what == "key") return key(event);
  if (*what == "text") return typed(event);
  return std::nullopt;
}

Result<PageMessage> input(const PageJson& message) {
  const auto events = message.find("events");
  if (events == message.end() || !events->is_array() || events->size() > kMaxEvents)
    return wrong("input needs at most 64 events");
  InputMessage input{counted(message, "number"), {}};
  for (const PageJson& event : *events) {
    auto read = event_of(event);
    if (!read) return wrong("an event that is not known");
    input.events.push_back(std::move(*read));
  }
  return input;
}

Result<PageMessage> size(const PageJson& message) {
  const auto part = [&](const char* key, double least, double greatest) {
    const auto found = message.find(key);
    return found == message.end() ? std::nullopt : number_in(*found, least, greatest);
  };
  const auto width = part("width", kMinServedSide_px, kMaxServedSide_px);
  const auto height = part("height", kMinServedSide_px, kMaxServedSide_px);
  const auto scale = part("scale", 0.5, 4);
  if (!width || !height || !scale) return wrong("size needs width, height and scale");
  return SizeMessage{static_cast<int>(*width), static_cast<int>(*height), *scale};
}

Result<PageMessage> paste(const PageJson& message) {
  const auto found = message.find("text");
  const std::string* text = found == message.end() ? nullptr : text_in(*found, kMaxPasted_bytes);
  if (text == nullptr) return wrong("paste needs a text");
  return PasteMessage{without_controls(*text, true)};
}

Result<PageMessage> control(const PageJson& message) {
  const auto found = message.find("what");
  const std::string* what = found == message.end() ? nullptr : text_in(*found, 16);
  if (what != nullptr && *what == "ask") return ControlMessage{Control::kAsk};
  if (what != nullptr && *what == "give") return ControlMessage{Control::kGive};
  if (what != nullptr && *what == "keep") return ControlMessage{Control::kKeep};
  return wrong("control needs ask, give or keep");
}

Result<PageMessage> upload(const PageJson& message) {
  constexpr std::size_t kMaxName_bytes = 1024;
  constexpr double kMaxFile_bytes = 1e15;
  const auto name = message.find("name"), size = message.find("size_bytes");
  const std::string* text = name == message.end() ? nullptr : text_in(*name, kMaxName_bytes);
  const bool counted = size != message.end() && size->is_number_unsigned() && *size <= kMaxFile_bytes;
  if (text == nullptr || !counted) return wrong("upload needs a name and a size in bytes");
  return UploadMessage{*text, size->get<std::uint64_t>()};
}

void put(std::string& out, std::uint32_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i) & 0xFF);
}

}  // namespace

Result<PageMessage> parse_page_message(std::string_view text) {
  if (text.size() > kMaxPageMessage_bytes) return wrong("it is too long");
  const PageJson message = PageJson::parse(text, nullptr, false);
  const auto found = message.is_object() ? message.find("type") : message.end();
  const std::string* type = message.is_object() && found != message.end() ? text_in(*found, 16) : nullptr;
  if (type == nullptr) return wrong("it is no JSON object with a type");
  if (*type == "input") return input(message);
  if (*type == "size") return size(message);
  if (*type == "shown") return ShownMessage{counted(message, "frame")};
  if (*type == "paste") return paste(message);
  if (*type == "blur") return BlurMessage{};
  if (*type == "control") return control(message);
  if (*type == "upload") return upload(message);
  return wrong("its type is not known");
}

std::string to_bytes(const Frame& frame) {
  std::string out;
  for (const std::uint32_t number :
       {frame.number, frame.input_number, frame.wait_us, frame.draw_us, frame.held_us, frame.encode_us})
    put(out, number, 4);
  put(out, static_cast<std::uint32_t>(frame.width_px), 2);
  put(out, static_cast<std::uint32_t>(frame.height_px), 2);
  put(out, (frame.exact ? 1U : 0U) | (frame.at_rest ? 2U : 0U), 2);
  put(out, static_cast<std::uint32_t>(frame.parts.size()), 2);
  for (const FramePart& part : frame.parts) {
    for (const int side : {part.place.left, part.place.top, part.place.width, part.place.height})
      put(out, static_cast<std::uint32_t>(side), 2);
    put(out, static_cast<std::uint32_t>(part.format), 2);
    put(out, static_cast<std::uint32_t>(part.bytes.size()), 4);
    out += part.bytes;
  }
  return out;
}

}  // namespace sweepscope::ui
