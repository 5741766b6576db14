// Displays of other scales, between which a window, or the page of a served explorer, may move.
#include <gtest/gtest.h>

#include "render/gl/offscreen_context.hpp"
#include "ui/script/script.hpp"
#include "ui/ui.hpp"

namespace sweepscope::ui {
namespace {

TEST(DisplayScale, BackAtItsFirstScaleTheInterfaceLooksAsBefore) {
  const auto context = *gl::make_resizable_context(1000, 700);
  Ui ui(*context,
        {.explorer = {}, .display_scale = 1, .recent_list = {}, .preferences = {}, .draw_budget_s = 0});
  const auto run = [&](const std::string& lines) {
    const auto done = run_script(ui, *parse_script(lines, "test"), 300);
    ASSERT_TRUE(done) << done.error().message;
  };
  run("sample room-1\nwait solved\nframes 3\n");
  const Image first = ui.screenshot();
  context->resize(780, 900);
  ui.set_display_scale(1.5);
  run("wait solved\nframes 3\n");
  context->resize(1000, 700);
  ui.set_display_scale(1);
  run("wait solved\nframes 3\n");
  EXPECT_TRUE(ui.screenshot() == first);
}

}  // namespace
}  // namespace sweepscope::ui
