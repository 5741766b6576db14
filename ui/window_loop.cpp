#include "ui/window_loop.hpp"

#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/io/printable_text.hpp"
#include "render/gl/window.hpp"
#include "ui/host/imgui_host.hpp"
#include "ui/preferences.hpp"
#include "ui/recent.hpp"
#include "ui/script/recorder.hpp"

namespace sweepscope::ui {
namespace {

std::string utf8(unsigned code) {
  std::string text;
  const auto add = [&](unsigned byte) { text += static_cast<char>(byte); };
  if (code < 0x80) {
    add(code);
  } else if (code < 0x800) {
    add(0xC0 | code >> 6);
    add(0x80 | (code & 0x3F));
  } else {
    add(0xE0 | (code >> 12 & 0x0F));
    add(0x80 | (code >> 6 & 0x3F));
    add(0x80 | (code & 0x3F));
  }
  return text;
}

/// What the window reported since the last frame.
class EventQueue {
 public:
  explicit EventQueue(gl::Window& window) {
    window.events.moved = [this](double x, double y) {
      // Of moves in a row only the last one counts.
      if (!events_.empty() && events_.back().what == InputEvent::What::kMove) events_.pop_back();
      events_.push_back(InputEvent::move(x, y));
    };
    window.events.pressed = [this](int button, bool down, int modifiers) {
      events_.push_back(InputEvent::press(button, down, static_cast<unsigned>(modifiers) & 7));
    };
    window.events.scrolled = [this](double clicks) { events_.push_back(InputEvent::scroll(clicks)); };
    window.events.key = [this](int key, bool down, int modifiers) {
      events_.push_back(InputEvent::stroke(key, down, static_cast<unsigned>(modifiers) & 7));
    };
    window.events.typed = [this](unsigned code) { events_.push_back(InputEvent::words(utf8(code))); };
    window.events.dropped = [this](const std::string& path) { events_.push_back(InputEvent::drop(path)); };
    window.events.changed = [this] { changed_ = true; };
  }

  bool any() const { return !events_.empty() || changed_; }
  std::vector<InputEvent> take() {
    changed_ = false;
    return std::exchange(events_, {});
  }

 private:
  std::vector<InputEvent> events_;
  bool changed_ = true;
};

void use_cursor(gl::Window& window) {
  switch (ImGui::GetMouseCursor()) {
    case ImGuiMouseCursor_Hand:
      return window.set_cursor(gl::Cursor::kHand);
    case ImGuiMouseCursor_TextInput:
      return window.set_cursor(gl::Cursor::kText);
    case ImGuiMouseCursor_ResizeEW:
      return window.set_cursor(gl::Cursor::kResizeX);
    default:
      return window.set_cursor(gl::Cursor::kArrow);
  }
}

/// Names the recording.
void use_title(gl::Window& window, const Ui& ui, std::string& shown) {
  const Loaded* loaded = ui.explorer().loaded();
  const std::string title =
      loaded != nullptr ? printable_line(loaded->recording.name) + " - sweepscope" : "sweepscope";
  if (title != shown) window.set_title(shown = title);
}

/// What is copied goes to the system's clipboard. What that holds is asked for when it is to be pasted: its
/// owner may take long to answer.
class ClipboardLink {
 public:
  void before(gl::Window& window, Ui& ui, std::span<const InputEvent> events) {
    const auto has = [&](Key key) {
      return std::any_of(events.begin(), events.end(), [&](const InputEvent& event) {
        return event.what == InputEvent::What::kKey && event.down && event.key == key &&
               (event.modifiers & kCtrl) != 0;
      });
    };
    if (has('V')) ui.clipboard() = last_ = window.clipboard();
    // The same text may be copied again, over what the system has by now. What was copied before is not: the
    // key may be used frames later.
    if (has('C')) ui.clipboard() = last_ = "";
  }
  void after(gl::Window& window, Ui& ui) {
    if (ui.clipboard() != last_) window.set_clipboard(last_ = ui.clipboard());
  }

 private:
  std::string last_;
};

/// Nothing more is computed, drawn or taken in.
bool at_rest(const Ui& ui) {
  return ui.explorer().at_rest() && ui.pictures_done() && !ui.has_input();
}

using Clock = std::chrono::steady_clock;

double seconds_between(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

void loop(gl::Window& window, Ui& ui, ScriptRecorder* recorder, bool scale_given) {
  constexpr int kFramesAfterEvent = 4;  // ImGui needs at most these
  constexpr double kTooltip_s = 0.7;    // a tooltip comes while the mouse rests
  constexpr double kFrame_s = 1.0 / 60;
  constexpr double kWorking_s = 1.0 / 8;  // where only progress is to be shown
  constexpr double kIdle_s = 1;
  EventQueue queue(window);
  ClipboardLink clipboard;
  std::string title;
  auto last = Clock::now(), last_event = last;
  int frames_due = kFramesAfterEvent;
  while (!ui.wants_quit()) {
    const Background& background = ui.explorer().background;
    const bool moves =
        frames_due > 0 || ui.animates() || seconds_between(last_event, Clock::now()) < kTooltip_s;
    const bool goes_on =
        background.busy() || ui.explorer().messages.shown();  // a message goes after its time
    const double interval_s = moves ? kFrame_s : goes_on ? kWorking_s : kIdle_s;
    const double waited_s = interval_s == kIdle_s ? 0 : seconds_between(last, Clock::now());
    window.wait(std::max(1e-3, interval_s - waited_s));
    if (window.take_close()) ui.quit();
    const auto now = Clock::now();
    const double seconds = seconds_between(last, now);
    if (queue.any()) {
      frames_due = kFramesAfterEvent;
      last_event = now;
    } else if (!background.has_finished() && (interval_s == kIdle_s || seconds < interval_s)) {
      continue;
    }
    last = now;
    if (!scale_given) ui.set_display_scale(window.scale());
    const std::vector<InputEvent> events = queue.take();
    clipboard.before(window, ui, events);
    const std::size_t started = background.started();
    ui.frame(events, std::clamp(seconds, 1e-3, 0.25));
    clipboard.after(window, ui);
    if (recorder != nullptr) recorder->add_frame(events, at_rest(ui), background.started() > started);
    if (ui.wants_quit()) break;  // nobody waits for its picture
    ui.paint();
    window.present();
    use_cursor(window);
    use_title(window, ui, title);
    frames_due = std::max(0, frames_due - 1);
  }
}

}  // namespace

Result<void> run_in_window(Ui::Options options, const WindowOptions& wanted, const std::string& first_line,
                           std::span<const Script> scripts) {
  auto window = gl::make_window(wanted.width_px, wanted.height_px, "sweepscope");
  if (!window)
    return failure(window.error().code,
                   window.error().message +
                       ". Without a display: --serve shows this interface in a browser, also over ssh; "
                       "--headless, with --script or --run, draws it; `sweepscope report` and `sweepscope "
                       "compare` need none.");
  options.recent_list = recent_list_path();
  options.preferences = preferences_path();
  return run_explorer(**window, std::move(options), wanted.record, {gl::wake_window, {}}, first_line,
                      scripts);
}

Result<void> run_explorer(gl::Window& window, Ui::Options options, const std::filesystem::path& record,
                          const WindowHooks& hooks, const std::string& first_line,
                          std::span<const Script> scripts) {
  window.make_current();
  const bool scale_given = options.scale_given;
  if (!scale_given) options.display_scale = window.scale();
  Ui ui(window, std::move(options));
  if (hooks.started) hooks.started(ui);
  ui.explorer().background.on_progress(hooks.wake);
  ui.explorer().background.come_after_the_interface();
  if (!first_line.empty()) ui.explorer().messages.show_failure(ui.explorer().perform(first_line));
  for (const Script& script : scripts) {
    if (auto done = run_script(ui, script); !done) return done;
  }
  if (record.empty()) {
    loop(window, ui, nullptr, scale_given);
    return {};
  }
  return ScriptRecorder::create(record).and_then([&](ScriptRecorder recorder) {
    loop(window, ui, &recorder, scale_given);
    return recorder.end();
  });
}

namespace {

/// Whether a script goes on from the page that a recording with something to choose gives, rather than from
/// its maps.
bool uses_page(std::span<const Script> scripts) {
  const auto begins = [](const Script& script) {
    return std::any_of(script.lines.begin(), script.lines.end(), [](const Script::Line& line) {
      return line.words[0] == "open-chosen" || line.words[0].starts_with("choose") ||
             line.text.find("chosen-") != std::string::npos ||
             line.text.find("button open-chosen") != std::string::npos;
    });
  };
  return std::any_of(scripts.begin(), scripts.end(), begins);
}

}  // namespace

Result<void> run_headless(gl::Context& context, Ui::Options options, const std::string& first_line,
                          std::span<const Script> scripts, const std::filesystem::path& record) {
  std::optional<ScriptRecorder> recorder;
  if (!record.empty()) {
    auto created = ScriptRecorder::create(record);
    if (!created) return tl::unexpected(created.error());
    recorder = std::move(*created);
  }
  Ui ui(context, std::move(options));
  if (!first_line.empty()) {
    if (auto done = ui.explorer().perform(first_line); !done) return done;
    const Script wait{"REC", {{1, {"wait", "loaded"}, "wait loaded"}}};
    if (auto done = run_script(ui, wait); !done) return done;
    const auto& why = ui.explorer().recording.failure();
    if (why && !(ui.explorer().page.choosing() != nullptr && uses_page(scripts))) return tl::unexpected(*why);
    if (!why && ui.explorer().loaded() == nullptr && ui.explorer().messages.shown())
      return unreadable(ui.explorer().messages.shown()->text);
  }
  for (const Script& script : scripts) {
    if (auto done = run_script(ui, script, kMaxWait_s, recorder ? &*recorder : nullptr); !done) return done;
  }
  return recorder ? recorder->end() : Result<void>();
}

}  // namespace sweepscope::ui
