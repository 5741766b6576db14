#include "ui/serve/served_window.hpp"

#include <utility>

#include "render/gl/default_framebuffer.hpp"

namespace sweepscope::ui {
namespace {

const char* css_name(gl::Cursor cursor) {
  switch (cursor) {
    case gl::Cursor::kHand:
      return "pointer";
    case gl::Cursor::kText:
      return "text";
    case gl::Cursor::kResizeX:
      return "ew-resize";
    case gl::Cursor::kArrow:
      break;
  }
  return "default";
}

/// The characters of a text that is UTF-8 for certain.
std::vector<unsigned> code_points(const std::string& text) {
  std::vector<unsigned> codes;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xC0U) == 0x80U && !codes.empty())
      codes.back() = codes.back() << 6U | (byte & 0x3FU);
    else
      codes.push_back(byte < 0x80 ? byte : byte & (byte < 0xE0 ? 0x1FU : byte < 0xF0 ? 0x0FU : 0x07U));
  }
  return codes;
}

}  // namespace

void ServedWindow::wait(double max_s) {
  const Mailbox::Arrived arrived = mailbox_.wait(max_s, drawing_);
  taken_ = Clock::now();
  input_number_ = arrived.input_number;
  wait_us_ = arrived.wait_us;
  if (arrived.size) resize(*arrived.size);
  if (arrived.pasted) clipboard_ = *arrived.pasted;
  for (const InputEvent& event : arrived.events) hand_on(event);
  if (arrived.repaint && events.changed) events.changed();
}

void ServedWindow::resize(const SizeMessage& size) {
  const bool same = size.width_px == width_px() && size.height_px == height_px();
  if (same && size.scale == scale_) return;
  scale_ = size.scale;
  if (!same) context_->resize(size.width_px, size.height_px);
  if (events.changed) events.changed();
}

void ServedWindow::hand_on(const InputEvent& event) {
  const int modifiers = static_cast<int>(event.modifiers);
  switch (event.what) {
    case InputEvent::What::kMove:
      if (events.moved) events.moved(event.x, event.y);
      break;
    case InputEvent::What::kButton:
      if (events.pressed) events.pressed(event.button, event.down, modifiers);
      break;
    case InputEvent::What::kWheel:
      if (events.scrolled) events.scrolled(event.wheel);
      break;
    case InputEvent::What::kKey:
      if (events.key) events.key(event.key, event.down, modifiers);
      break;
    case InputEvent::What::kText:
      for (const unsigned code : code_points(event.text))
        if (events.typed) events.typed(code);
      break;
    case InputEvent::What::kDrop:
      if (events.dropped) events.dropped(event.text);
      break;
  }
}

void ServedWindow::present() {
  if (!server_.has_viewers()) return;
  auto image = std::make_shared<const Image>(gl::read_default_framebuffer(*context_));
  const auto drawn = Clock::now();
  const auto draw = std::chrono::duration_cast<std::chrono::microseconds>(drawn - taken_);
  drawing_ = (3 * drawing_ + (drawn - taken_)) / 4;
  if (!has_input || !has_input()) drawn_input_ = input_number_;
  server_.show({std::move(image), drawn_input_, wait_us_, static_cast<std::uint32_t>(draw.count()),
                at_rest && at_rest(), drawn});
}

void ServedWindow::set_title(const std::string& title) {
  if (std::exchange(state_.title, title) != title) server_.tell(state_);
}

void ServedWindow::set_cursor(gl::Cursor cursor) {
  const std::string name = css_name(cursor);
  if (std::exchange(state_.cursor, name) != name) server_.tell(state_);
}

void ServedWindow::set_clipboard(const std::string& text) {
  clipboard_ = text;
  server_.copy(text);
}

}  // namespace sweepscope::ui
