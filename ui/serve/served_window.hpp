#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "render/gl/offscreen_context.hpp"
#include "render/gl/window.hpp"
#include "ui/serve/server.hpp"

namespace sweepscope::ui {

/// The page of a browser as a window: its input comes from the driver's page, and what is presented goes to
/// all pages. Nothing is read back while nobody looks.
class ServedWindow final : public gl::Window {
 public:
  ServedWindow(std::unique_ptr<gl::OffscreenContext> context, Mailbox& mailbox, Server& server)
      : context_(std::move(context)), mailbox_(mailbox), server_(server) {}

  /// Whether nothing moves and nothing is computed, for the pages to know.
  std::function<bool()> at_rest;
  /// Whether events that were taken wait for a later picture.
  std::function<bool()> has_input;

  void make_current() override { context_->make_current(); }
  void release() override { context_->release(); }
  bool is_current() const override { return context_->is_current(); }
  int width_px() const override { return context_->width_px(); }
  int height_px() const override { return context_->height_px(); }
  std::string renderer() const override { return context_->renderer(); }
  void present() override;

  void wait(double max_s) override;
  bool take_close() override { return server_.is_over() && !std::exchange(told_over_, true); }
  double scale() const override { return scale_; }
  void set_title(const std::string& title) override;
  void set_cursor(gl::Cursor cursor) override;
  std::string clipboard() const override { return clipboard_; }
  void set_clipboard(const std::string& text) override;

 private:
  using Clock = std::chrono::steady_clock;
  void resize(const SizeMessage& size);
  void hand_on(const InputEvent& event);

  std::unique_ptr<gl::OffscreenContext> context_;
  Mailbox& mailbox_;
  Server& server_;
  double scale_ = 1;
  bool told_over_ = false;
  std::string clipboard_;
  PageState state_;
  std::uint32_t input_number_ = 0, wait_us_ = 0;
  std::uint32_t drawn_input_ = 0;           // the last one of which nothing waits
  Clock::time_point taken_ = Clock::now();  // when the events of the next picture were taken
  Clock::duration drawing_{};               // the time of a picture, from the last ones
};

}  // namespace sweepscope::ui
