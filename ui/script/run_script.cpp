#include "ui/script/script.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <random>
#include <thread>

#include "render/images/image_difference.hpp"
#include "ui/commands/commands.hpp"
#include "ui/explorer/observables.hpp"
#include "ui/host/imgui_host.hpp"

namespace sweepscope::ui {
namespace {

constexpr double kFrame_s = 1.0 / 60;

tl::unexpected<Error> wrong(std::string message) {
  return failure(ExitCode::kWrongUsage, std::move(message));
}

tl::unexpected<Error> unmet(std::string message) {
  return failure(ExitCode::kImageDiffers, std::move(message));
}

std::optional<double> number(const std::string& word) {
  const auto value = parse_value({.name = "number"}, word);
  return value ? std::optional(std::get<double>(*value)) : std::nullopt;
}

std::optional<int> button_named(const std::string& name) {
  if (name == "left") return 0;
  if (name == "right") return 1;
  if (name == "middle") return 2;
  return std::nullopt;
}

/// Words of one line while it is carried out.
class Words {
 public:
  explicit Words(const std::vector<std::string>& words) : words_(words) {}
  bool any() const { return next_ < words_.size(); }
  std::string take() { return any() ? words_[next_++] : std::string(); }
  std::string peek() const { return any() ? words_[next_] : std::string(); }
  std::string rest() {
    std::string text;
    while (any()) text += (text.empty() ? "" : " ") + take();
    return text;
  }

 private:
  const std::vector<std::string>& words_;
  std::size_t next_ = 1;
};

/// Pictures of the interface just as a person sees it, finished or not, named by the time since the first.
class Film {
 public:
  Film(std::filesystem::path folder, double every_s) : folder_(std::move(folder)), every_s_(every_s) {}

  void after_frame(Ui& ui) {
    const double now_s = std::chrono::duration<double>(Clock::now() - begin_).count();
    if (now_s < next_s_ || !written_) return;
    next_s_ = now_s + every_s_;
    std::error_code failed;
    std::filesystem::create_directories(folder_, failed);
    written_ = write_png(ui.screenshot(), (folder_ / fmt::format("{:08.3f}s.png", now_s)).string());
  }
  const Result<void>& written() const { return written_; }

 private:
  using Clock = std::chrono::steady_clock;
  std::filesystem::path folder_;
  double every_s_ = 0, next_s_ = 0;
  Clock::time_point begin_ = Clock::now();
  Result<void> written_;
};

class Runner {
 public:
  Runner(Ui& ui, double max_s, ScriptRecorder* recorder) : ui_(ui), max_s_(max_s), recorder_(recorder) {}

  Result<void> run(const Script::Line& line) {
    struct Step {
      Result<void> (Runner::*run)(Words&);
      bool sends_events = false;  // which are recorded in its place
    };
    static const std::map<std::string, Step> kSteps{
        {"click", {&Runner::click, true}}, {"double-click", {&Runner::double_click, true}},
        {"mouse", {&Runner::mouse, true}}, {"drag", {&Runner::drag, true}},
        {"wheel", {&Runner::wheel, true}}, {"key", {&Runner::key, true}},
        {"type", {&Runner::type, true}},   {"drop", {&Runner::drop, true}},
        {"hover", {&Runner::hover, true}}, {"wander", {&Runner::wander, true}},
        {"film", {&Runner::film}},         {"frames", {&Runner::frames}},
        {"wait", {&Runner::wait}},         {"screenshot", {&Runner::screenshot}},
        {"expect", {&Runner::expect}}};
    const auto step = kSteps.find(line.words[0]);
    const bool sends_events = step != kSteps.end() && step->second.sends_events;
    if (recorder_ != nullptr && !sends_events) recorder_->add_line(line.text);
    if (step == kSteps.end()) return command(line.text);
    Words words(line.words);
    auto done = (this->*step->second.run)(words);
    if (done && words.any()) return wrong("too many words: " + words.rest());
    return done;
  }

  /// What a film that runs could not write.
  Result<void> end() const { return film_ ? film_->written() : Result<void>(); }

 private:
  /// What it exports is there when the line is done.
  Result<void> command(const std::string& line) {
    if (auto there = wait_for_need(line); !there) return there;
    auto done = ui_.explorer().perform(line);
    settle();
    if (!done) return done;
    done = wait_until([&] { return !ui_.is_exporting(); }, "the file", max_s_);
    if (auto why = ui_.explorer().exports.take_failure()) return tl::unexpected(*why);
    return done;
  }

  /// A line waits for the work that it needs and that is under way: a recording that is still being opened,
  /// an estimate, both maps solved and with all their points.
  Result<void> wait_for_need(const std::string& line) {
    const auto call = parse_call(line);
    if (!call || call->command->needs == Need::kNothing) return {};
    const Explorer& explorer = ui_.explorer();
    const Need need = call->command->needs;
    if (explorer.recording.is_opening())
      if (auto there = wait_until([&] { return !explorer.recording.is_opening(); }, "the recording", max_s_);
          !there)
        return there;
    if (const auto& why = explorer.recording.failure()) return tl::unexpected(*why);
    if (need == Need::kEstimate && explorer.estimating.is_running())
      return wait_until([&] { return !explorer.estimating.is_running(); }, "the estimate", max_s_);
    if (need == Need::kMaps && explorer.loaded() != nullptr)
      return wait_until([&] { return explorer.at_rest(); }, "both maps", max_s_);
    return {};
  }

  void frame(std::span<const InputEvent> events, double seconds) {
    if (recorder_ != nullptr) recorder_->add_events(events);
    ui_.frame(events, seconds);
    if (film_) film_->after_frame(ui_);
  }

  void pump(std::span<const InputEvent> events) {
    frame(events, kFrame_s);
    while (ui_.has_input()) frame({}, kFrame_s);
  }
  /// ImGui takes a frame or two to place new items.
  void settle() {
    for (int i = 0; i < 3; ++i) frame({}, kFrame_s);
  }
  void send(std::vector<InputEvent> events) {
    pump(events);
    settle();
  }

  /// "X Y", or the middle of something with a name; "at SHARE SHARE" after a name is a place within it.
  Result<PixelPoint> place(Words& words) {
    const std::string first = words.take();
    if (const auto x = number(first)) {
      const auto y = number(words.take());
      if (!y) return wrong("a place is X Y in pixels, or a name");
      return PixelPoint{*x, *y};
    }
    const auto rect = ui_.anchor(first);
    if (!rect) {
      std::string names;
      for (const std::string& name : ui_.anchor_names()) names += (names.empty() ? "" : ", ") + name;
      return wrong(fmt::format("there is no place \"{}\"; the places are: {}", first, names));
    }
    double across = 0.5, down = 0.5;
    if (words.peek() == "at") {
      words.take();
      const auto x = number(words.take()), y = number(words.take());
      if (!x || !y) return wrong("\"at\" needs two fractions, such as 0.2 0.5");
      across = *x;
      down = *y;
    }
    return PixelPoint{std::round(rect->left + across * rect->width),
                      std::round(rect->top + down * rect->height)};
  }

  Result<void> hover(Words& words) {
    return place(words).map([&](PixelPoint at) {
      send({InputEvent::move(at.x, at.y)});
      for (int i = 0; i < 60; ++i) frame({}, kFrame_s);
    });
  }

  Result<void> click(Words& words) {
    return place(words).map([&](PixelPoint at) {
      send({InputEvent::move(at.x, at.y)});
      send({InputEvent::press(0, true), InputEvent::press(0, false)});
    });
  }

  Result<void> double_click(Words& words) {
    return place(words).map([&](PixelPoint at) {
      send({InputEvent::move(at.x, at.y)});
      send({InputEvent::press(0, true), InputEvent::press(0, false), InputEvent::press(0, true),
            InputEvent::press(0, false)});
    });
  }

  Result<void> mouse(Words& words) {
    const std::string what = words.take();
    if (what == "move") {
      return place(words).map([&](PixelPoint at) { send({InputEvent::move(at.x, at.y)}); });
    }
    const auto button = button_named(words.any() ? words.take() : "left");
    if (!button || (what != "down" && what != "up"))
      return wrong("mouse move PLACE, mouse down|up [left|right|middle]");
    send({InputEvent::press(*button, what == "down")});
    return {};
  }

  /// In ten moves, as a hand does.
  Result<void> drag(Words& words) {
    const auto from = place(words);
    if (!from) return tl::unexpected(from.error());
    std::optional<PixelPoint> to;
    if (words.peek() == "by") {
      words.take();
      const auto x = number(words.take()), y = number(words.take());
      if (!x || !y) return wrong("drag FROM by X Y");
      to = PixelPoint{from->x + *x, from->y + *y};
    } else if (words.peek() == "to") {
      words.take();
      const auto there = place(words);
      if (!there) return tl::unexpected(there.error());
      to = *there;
    } else {
      return wrong("drag FROM to PLACE, or drag FROM by X Y");
    }
    const auto button = button_named(words.any() ? words.take() : "left");
    if (!button) return wrong("the button is left, right or middle");
    send({InputEvent::move(from->x, from->y)});
    send({InputEvent::press(*button, true)});
    for (int i = 1; i <= 10; ++i)
      send({InputEvent::move(std::round(from->x + (to->x - from->x) * i / 10),
                             std::round(from->y + (to->y - from->y) * i / 10))});
    send({InputEvent::press(*button, false)});
    return {};
  }

  Result<void> wheel(Words& words) {
    const auto clicks = number(words.take());
    if (!clicks) return wrong("wheel needs a number of clicks; up is positive");
    send({InputEvent::scroll(*clicks)});
    return {};
  }

  Result<void> key(Words& words) {
    const std::string text = words.take();
    const auto chord = parse_chord(text);
    if (!chord)
      return wrong(
          fmt::format("\"{}\" is not a key; keys are for example A, 7, Space and Ctrl+Shift+Z", text));
    send({InputEvent::stroke(chord->key, true, chord->modifiers),
          InputEvent::stroke(chord->key, false, chord->modifiers)});
    send({InputEvent::stroke(chord->key, false, 0)});
    return {};
  }

  Result<void> type(Words& words) {
    send({InputEvent::words(words.rest())});
    return {};
  }

  Result<void> drop(Words& words) {
    send({InputEvent::drop(words.rest())});
    return {};
  }

  Result<void> film(Words& words) {
    const std::string folder = words.take();
    if (folder.empty()) return wrong("film FOLDER [SECONDS], or film off");
    const double every_s = words.any() ? number(words.take()).value_or(-1) : 0.1;
    if (every_s < 0) return wrong("film FOLDER [SECONDS]: the seconds between two pictures, 0 for all");
    auto done = end();
    film_.reset();
    if (folder != "off") film_.emplace(folder, every_s);
    return done;
  }

  Result<void> frames(Words& words) {
    const auto count = number(words.take());
    if (!count || *count < 0 || *count > 1e6) return wrong("frames needs a number");
    for (int i = 0; i < static_cast<int>(*count); ++i) frame({}, kFrame_s);
    return {};
  }

  /// A person who tries everything: clicks, drags, scrolls, keys and words wherever there is something.
  Result<void> wander(Words& words) {
    const auto actions = number(words.take());
    const auto seed = words.any() ? number(words.take()) : std::optional(1.0);
    if (!actions || !seed || *actions < 0 || *seed < 0) return wrong("wander ACTIONS [SEED]");
    std::mt19937 random(static_cast<std::uint32_t>(*seed));
    for (int i = 0; i < static_cast<int>(*actions); ++i) wander_once(random);
    // The window has reported a file that could not be written, as to a person: not a fault of the script.
    auto done = wait_until([&] { return !ui_.is_exporting(); }, "the file", max_s_);
    (void)ui_.explorer().exports.take_failure();
    return done;
  }

  void wander_once(std::mt19937& random) {
    const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
    std::vector<std::string> names = ui_.anchor_names();
    std::erase_if(names, [](const std::string& name) { return name.ends_with("quit"); });
    const auto somewhere = [&] {
      const PixelRect rect = *ui_.anchor(names[below(names.size())]);
      const auto share = [&] { return 0.1 + 0.8 * static_cast<double>(below(1000)) / 1000; };
      return PixelPoint{std::round(rect.left + share() * rect.width),
                        std::round(rect.top + share() * rect.height)};
    };
    const PixelPoint at = names.empty() ? PixelPoint{600, 400} : somewhere();
    const int button = below(4) == 0 ? 1 : 0;
    switch (below(8)) {
      case 0: {
        const Shortcut& shortcut = shortcuts()[below(shortcuts().size())];
        const Chord chord = *parse_chord(shortcut.chord);
        if (shortcut.line == "quit") return;
        send({InputEvent::stroke(chord.key, true, chord.modifiers), InputEvent::stroke(chord.key, false, 0)});
        return;
      }
      case 1:
        return send({InputEvent::words(std::to_string(below(100))), InputEvent::stroke(keys::kEnter, true, 0),
                     InputEvent::stroke(keys::kEnter, false, 0)});
      case 2:
        return send({InputEvent::move(at.x, at.y), InputEvent::scroll(static_cast<double>(below(9)) - 4)});
      case 3: {
        const PixelPoint to = names.empty() ? at : somewhere();
        send({InputEvent::move(at.x, at.y)});
        send({InputEvent::press(button, true)});
        for (const double part : {0.3, 0.6, 1.0})
          send({InputEvent::move(std::round(at.x + part * (to.x - at.x)),
                                 std::round(at.y + part * (to.y - at.y)))});
        return send({InputEvent::press(button, false)});
      }
      default:
        send({InputEvent::move(at.x, at.y)});
        return send({InputEvent::press(button, true), InputEvent::press(button, false)});
    }
  }

  Result<void> wait_until(const std::function<bool()>& there, const std::string& what, double max_s) {
    const auto begin = std::chrono::steady_clock::now();
    while (!there()) {
      frame({}, kFrame_s);
      if (std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() > max_s)
        return unmet(fmt::format("{} was not reached within {} s", what, max_s));
      if (ui_.explorer().background.busy())
        std::this_thread::sleep_for(std::chrono::milliseconds(25));  // the work comes first
    }
    settle();
    return {};
  }

  Result<void> wait(Words& words) {
    const Explorer& explorer = ui_.explorer();
    const std::string what = words.take();
    const double max_s = words.any() ? number(words.take()).value_or(max_s_) : max_s_;
    if (what == "loaded")
      return wait_until([&] { return !explorer.recording.is_opening() && !explorer.page.is_surveying(); },
                        what, max_s);
    if (what == "estimated")
      return wait_until([&] { return !explorer.recording.is_opening() && !explorer.estimating.is_running(); },
                        what, max_s);
    if (what != "solved") return wrong("wait loaded, wait estimated or wait solved");
    frame({}, kFrame_s);
    return wait_until([&] { return explorer.at_rest() && ui_.pictures_done(); }, what, max_s);
  }

  /// The interface as it is, its pictures drawn to the end; with the whole answer of a recording that was
  /// opened, or the picture would show how fast the machine is.
  Image picture() {
    if (ui_.explorer().is_answering())
      (void)wait_until([&] { return !ui_.explorer().is_answering(); }, "the answer", max_s_);
    for (int i = 0; i < 600 && !ui_.pictures_done(); ++i) frame({}, kFrame_s);
    frame({}, kFrame_s);
    return ui_.screenshot();
  }

  Result<void> screenshot(Words& words) {
    const std::string path = words.take();
    return ui_.explorer()
        .files.check_outputs({path})
        .and_then([&] { return check_type(path, kPictureTypes); })
        .and_then([&] { return write_picture(picture(), path); });
  }

  Result<void> expect(Words& words) {
    const std::string name = words.take();
    if (name == "picture") return expect_picture(words.take());
    const auto now = observe(ui_.explorer(), name);
    if (!now) return wrong(fmt::format("\"{}\" cannot be observed; see view --help", name));
    const std::string relation = words.take();
    if (relation == "is" || relation == "contains") {
      const std::string wanted = words.rest();
      const bool met = relation == "is" ? *now == wanted : now->find(wanted) != std::string::npos;
      if (!met)
        return unmet(fmt::format("expected {} {} \"{}\", but it is \"{}\"", name, relation, wanted, *now));
      return {};
    }
    if (relation != "near" && relation != "above" && relation != "below")
      return wrong("expect NAME is|contains|near|above|below VALUE");
    const auto value = number(*now), wanted = number(words.take());
    if (!wanted) return wrong("expect NAME near|above|below needs a number");
    const double within = relation == "near" ? number(words.take()).value_or(1e-9) : 0;
    const bool met = value && (relation == "near"    ? std::abs(*value - *wanted) <= within
                               : relation == "above" ? *value > *wanted
                                                     : *value < *wanted);
    if (!met) return unmet(fmt::format("expected {} {} {}, but it is \"{}\"", name, relation, *wanted, *now));
    return {};
  }

  Result<void> expect_picture(const std::string& path) {
    const Image actual = picture();
    const auto expected = read_png(path);
    if (!expected) {
      (void)write_png(actual, path + ".actual.png");
      return unmet(fmt::format("{}; what was drawn is in {}.actual.png", expected.error().message, path));
    }
    const ImageDifference difference = compare_images(actual, *expected);
    if (difference.passes) return {};
    (void)write_png(actual, path + ".actual.png");
    return unmet(fmt::format("the picture differs from {}: {}; what was drawn is in {}.actual.png", path,
                             describe(difference), path));
  }

  Ui& ui_;
  double max_s_;
  ScriptRecorder* recorder_;
  std::optional<Film> film_;
};

}  // namespace

Result<void> run_script(Ui& ui, const Script& script, double max_s, ScriptRecorder* recorder) {
  Runner runner(ui, max_s, recorder);
  ui.frame({}, kFrame_s);
  for (const Script::Line& line : script.lines) {
    const auto done = runner.run(line);
    if (!done)
      return failure(done.error().code,
                     fmt::format("{}:{}: {}", script.name, line.number, done.error().message));
    if (ui.wants_quit()) break;
  }
  return runner.end();
}

}  // namespace sweepscope::ui
