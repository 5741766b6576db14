// How long the explorer lets a person wait, in the very interface, without a display. Run by hand, on a quiet
// machine: tests/benchmark/explorer, which adds what needs a window.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <thread>

#include "render/gl/default_framebuffer.hpp"
#include "tests/scratch_folder.hpp"
#include "ui/host/imgui_host.hpp"
#include "ui/ui.hpp"

namespace sweepscope::ui {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Durations in milliseconds.
class Times {
 public:
  void add(double seconds) { ms_.push_back(1e3 * seconds); }
  bool any() const { return !ms_.empty(); }
  /// The value that this part of them stays below.
  double at(double part) const {
    std::vector<double> sorted = ms_;
    std::sort(sorted.begin(), sorted.end());
    return sorted[static_cast<std::size_t>(part * static_cast<double>(sorted.size() - 1))];
  }
  std::size_t count() const { return ms_.size(); }

 private:
  std::vector<double> ms_;
};

void print(const std::string& what, const std::string& measured, const std::string& wanted) {
  fmt::print("| {:<58} | {:>30} | {:>22} |\n", what, measured, wanted);
}

/// A row of frame times: the longest is how long the interface was blocked.
void print_frames(const std::string& what, const Times& times) {
  print("longest frame while " + what,
        fmt::format("{:.0f} ms ({} frames, 99 % {:.0f})", times.at(1), times.count(), times.at(0.99)),
        "100 ms");
}

[[noreturn]] void give_up(const std::string& why) {
  fmt::print(stderr, "{}\n", why);
  std::exit(1);
}

/// The interface, frame by frame at the pace of a display.
class Person {
 public:
  explicit Person(gl::Context& context) : ui_(context, Ui::Options()) {
    explorer().background().come_after_the_interface();  // as in a window
  }

  Explorer& explorer() { return ui_.explorer(); }
  Ui& ui() { return ui_; }

  void perform(const std::string& line) {
    if (const auto done = explorer().perform(line); !done) give_up(line + ": " + done.error().message);
  }
  /// One frame; its duration in seconds.
  double frame(std::vector<InputEvent> events = {}) {
    const auto begin = Clock::now();
    ui_.frame(events, 1.0 / 60);
    const double took_s = seconds_since(begin);
    if (took_s < 1.0 / 60) std::this_thread::sleep_for(std::chrono::duration<double>(1.0 / 60 - took_s));
    return took_s;
  }
  /// Frames until something is so.
  template <typename Condition>
  Times until(const Condition& there) {
    Times times;
    const auto begin = Clock::now();
    do {
      times.add(frame());
      if (seconds_since(begin) > 900) give_up("That took longer than 15 minutes.");
    } while (!there());
    return times;
  }
  Times until_rest() {
    frame();
    return until([&] { return explorer().at_rest() && ui_.pictures_done(); });
  }
  PixelPoint middle_of(const std::string& anchor) {
    const auto rect = ui_.anchor(anchor);
    if (!rect) give_up("nothing is called " + anchor);
    return {rect->left + rect->width / 2, rect->top + rect->height / 2};
  }
  /// A drag by `moves` steps: how long each frame took from the move to the picture that follows it.
  Times drag(const std::string& anchor, int moves, double right_px, double down_px) {
    PixelPoint at = middle_of(anchor);
    frame({InputEvent::move(at.x, at.y)});
    frame({InputEvent::press(0, true)});
    Times times;
    for (int i = 0; i < moves; ++i) {
      at.x += (i / 20) % 2 == 0 ? right_px : -right_px;
      at.y += (i / 20) % 2 == 0 ? down_px : -down_px;
      times.add(frame({InputEvent::move(at.x, at.y)}));
    }
    frame({InputEvent::press(0, false)});
    return times;
  }

 private:
  Ui ui_;
};

/// Points per second of the loop's one step, over about two seconds.
template <typename Step>
double rate(std::size_t points, const Step& step) {
  step();
  const auto begin = Clock::now();
  int rounds = 0;
  while (seconds_since(begin) < 2) {
    step();
    ++rounds;
  }
  return static_cast<double>(points) * rounds / seconds_since(begin);
}

void measure_placing(Person& person) {
  const CloudRequest request = *person.explorer().pane(Side::kA).request;
  const Beams& beams = request.placement.loaded->beams;
  std::vector<std::array<float, 3>> places(beams.size());
  print("points of the recording", fmt::format("{:.2f} million", static_cast<double>(beams.size()) / 1e6),
        "1.7 million");
  print("points placed anew per second",
        fmt::format("{:.1f} million",
                    1e-6 * rate(beams.size(),
                                [&] { replace_points(beams, request.placement.map->path, 0.0203, places); })),
        "at least 20 million");
  print("the same with colours, in the order of drawing",
        fmt::format(
            "{:.1f} million",
            1e-6 * rate(beams.size(), [&] { (void)place_cloud(request.placement, request.look, false); })),
        "");
}

void measure_slices(Person& person, gl::Context& context) {
  const Pane& pane = person.explorer().pane(Side::kA);
  LiveView view(context);
  view.resize(600, 800);
  Camera camera;
  camera.position_m = {0, 0, 1000};
  camera.view_height_m = 40;
  view.set_camera(camera);
  view.show(pane.coarse->points, pane.full->points);
  Times slices;
  while (!view.done()) {
    const auto begin = Clock::now();
    view.draw(1e-3);  // one slice takes longer
    gl::finish_drawing(context);
    slices.add(seconds_since(begin));
  }
  print("a slice of progressive drawing, longest",
        fmt::format("{:.0f} ms ({} slices, median {:.0f})", slices.at(1), slices.count(), slices.at(0.5)),
        "50 ms");
}

void measure_moves(Person& person, const std::string& when) {
  const Times handle = person.drag("handle a", 100, 2, 0);
  print("handle's move to the new picture, median and 95 %" + when,
        fmt::format("{:.0f} ms, {:.0f} ms", handle.at(0.5), handle.at(0.95)), "100 ms, 200 ms");
  const Times camera = person.drag("map a", 100, 5, 1);
  print("camera drag, both maps, median and 5 % slowest" + when,
        fmt::format("{:.0f}, {:.0f} frames/s", 1e3 / camera.at(0.5), 1e3 / camera.at(0.95)), "15 frames/s");
}

void measure_work(Person& person, const std::filesystem::path& folder) {
  Explorer& explorer = person.explorer();
  print_frames("all points are placed and drawn", person.until_rest());
  person.perform("offset-a 21.5");
  measure_moves(person, "; solving");
  print_frames("maps are solved", person.until_rest());
  person.perform("search range");
  person.perform("search-range 19 29 1");
  person.perform("estimate");
  print_frames("the offset is estimated", person.until_rest());
  for (const char* colouring : {"intensity", "blur", "features", "elevation"}) {
    person.perform(std::string("colouring ") + colouring);
    print_frames(std::string("colours change: ") + colouring, person.until_rest());
  }
  person.perform("layout difference");
  print_frames("the difference is made", person.until_rest());
  person.perform("layout side-by-side");
  (void)person.until_rest();
  person.perform("profile -1 0 1 0");
  print_frames("a profile is made", person.until_rest());
  for (const std::string& line :
       {"export-cloud a " + (folder / "a.pcd").string(), "export-picture " + (folder / "a.png").string(),
        "save-session " + (folder / "a.json").string(), "export-report " + (folder / "report").string()}) {
    person.perform(line);
    print_frames(line.substr(0, line.find(' ')), person.until_rest());
    if (const auto why = explorer.take_export_failure()) give_up(why->message);
  }
}

void measure(const std::string& recording, gl::Context& context, const std::filesystem::path& folder) {
  Person person(context);
  for (int i = 0; i < 5; ++i) person.frame();
  person.perform("offset-a 19");
  person.perform("offset-b 24");
  const auto begin = Clock::now();
  person.perform("open " + quoted(recording));
  Times loading = person.until([&] { return person.explorer().loaded() != nullptr; });
  loading.add(person.frame());
  print("from opening to the first picture", fmt::format("{:.2f} s", seconds_since(begin)), "1 s");
  print_frames("a recording is opened", loading);
  person.explorer().hold_handle(false);
  print_frames("the first two maps are solved", person.until_rest());
  measure_placing(person);
  measure_slices(person, context);
  measure_moves(person, "");
  measure_work(person, folder);
}

}  // namespace
}  // namespace sweepscope::ui

int main(int argc, char** argv) {
  using namespace sweepscope;
  if (argc != 2) ui::give_up("usage: sweepscope_explorer_benchmark RECORDING");
  auto context = gl::make_offscreen_context(1600, 1000);
  if (!context) ui::give_up(context.error().message);
  const test::ScratchFolder folder;
  fmt::print("| {:<58} | {:>30} | {:>22} |\n|{:-<60}|{:->31}:|{:->23}:|\n", "what", "measured", "wanted", "",
             "", "");
  ui::measure(argv[1], **context, folder.path());
  return 0;
}
