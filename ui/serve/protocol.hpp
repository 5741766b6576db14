#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/error.hpp"
#include "render/images/transport_image.hpp"
#include "ui/host/input.hpp"

namespace sweepscope::ui {

/// What a page sends: JSON objects with a "type" (docs/remote.md).
struct InputMessage {
  std::uint32_t number = 0;  // counted by the page
  std::vector<InputEvent> events;
};
/// The size of the page in pixels of its display, of which there are `scale` to a pixel at 100 %.
struct SizeMessage {
  int width_px = 0, height_px = 0;
  double scale = 1;
};
/// A frame is on the screen.
struct ShownMessage {
  std::uint32_t frame = 0;
};
/// Text to paste where the keyboard is.
struct PasteMessage {
  std::string text;
};
/// The page lost the keyboard: nothing is held any longer.
struct BlurMessage {};
/// A file that the page would send, before it does.
struct UploadMessage {
  std::string name;
  std::uint64_t size_bytes = 0;
};
enum class Control { kAsk, kGive, kKeep };
struct ControlMessage {
  Control what = Control::kAsk;
};
using PageMessage = std::variant<InputMessage, SizeMessage, ShownMessage, PasteMessage, BlurMessage,
                                 ControlMessage, UploadMessage>;

/// Sizes of a picture that are possible, in pixels.
inline constexpr int kMinServedSide_px = 240, kMaxServedSide_px = 4096;
/// No message of a page is longer.
inline constexpr std::size_t kMaxPageMessage_bytes = std::size_t{64} * 1024;

/// Reads a message. Numbers out of range are limited; anything else that is not in the protocol is an error
/// (ExitCode::kUnreadableInput).
Result<PageMessage> parse_page_message(std::string_view text);

/// A changed part of the picture.
struct FramePart {
  enum class Format : std::uint8_t { kJpeg = 0, kPng = 1 };
  ImageRect place;
  Format format = Format::kJpeg;
  std::string bytes;
};

/// A picture as a page gets it: what differs from the one before.
struct Frame {
  std::uint32_t number = 0;
  std::uint32_t input_number = 0;  // of the last input that it shows
  std::uint32_t wait_us = 0;       // from the arrival of that input until the explorer took it
  std::uint32_t draw_us = 0;       // what the explorer needed to draw it
  std::uint32_t held_us = 0;       // from then until it could be sent
  std::uint32_t encode_us = 0;     // what its parts needed
  int width_px = 0, height_px = 0;
  bool exact = false;    // after it the page shows every pixel as it was drawn
  bool at_rest = false;  // nothing moves and nothing is computed
  std::vector<FramePart> parts;
};

/// Little-endian: number, input_number, wait_us, draw_us, held_us, encode_us (32 bits each), width, height
/// (16), flags (16: 1 exact, 2 at rest), count of parts (16); for each left, top, width, height (16 each),
/// format (16), size in bytes (32), and its bytes.
std::string to_bytes(const Frame& frame);

}  // namespace sweepscope::ui
