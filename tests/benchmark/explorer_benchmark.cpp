// How long the explorer lets a person wait, in the very interface, without a display. Run by hand, on a quiet
// machine: tests/benchmark/explorer, which adds what needs a window. Moves are measured in the view from
// above, which is flat, and in the isometric one, with lighting and splats.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <thread>

#include "render/gl/default_framebuffer.hpp"
#include "tests/scratch_folder.hpp"
#include "ui/host/imgui_host.hpp"
#include "ui/model/view_camera.hpp"
#include "ui/ui.hpp"

namespace sweepscope::ui {
namespace {

using Clock = std::chrono::steady_clock;

/// Of all threads of this program. Other programs on the machine do not change it much.
double cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// What waited for the machine's processors over the last minute.
std::string load() {
  std::array<double, 1> loads{};
  return getloadavg(loads.data(), 1) == 1 ? fmt::format("{:.1f}", loads[0]) : "not known";
}

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
  fmt::print("| {:<76} | {:>32} | {:>20} |\n", what, measured, wanted);
}

/// A row of frame times: the longest is how long the interface was blocked.
void print_frames(const std::string& what, const Times& times) {
  print("longest frame while " + what,
        fmt::format("{:.0f} ms ({} frames, 99 % {:.0f})", times.at(1), times.count(), times.at(0.99)),
        "80 ms");
}

[[noreturn]] void give_up(const std::string& why) {
  fmt::print(stderr, "{}\n", why);
  std::exit(1);
}

/// The interface, frame by frame at the pace of a display.
class Person {
 public:
  explicit Person(gl::Context& context) : ui_(context, Ui::Options()) {
    explorer().background.come_after_the_interface();  // as in a window
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
    ui_.paint();
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
  struct Drag {
    Times frames;
    double cpu_s = 0;  // of each frame, at the mean
  };
  /// A drag by `moves` steps: how long each frame took from the move to the picture that follows it.
  Drag drag(const std::string& anchor, int moves, double right_px, double down_px) {
    frame();  // what was performed before may have moved it
    PixelPoint at = middle_of(anchor);
    frame({InputEvent::move(at.x, at.y)});
    frame({InputEvent::press(0, true)});
    Drag done;
    const double begin_s = cpu_s();
    for (int i = 0; i < moves; ++i) {
      at.x += (i / 20) % 2 == 0 ? right_px : -right_px;
      at.y += (i / 20) % 2 == 0 ? down_px : -down_px;
      done.frames.add(frame({InputEvent::move(at.x, at.y)}));
    }
    done.cpu_s = (cpu_s() - begin_s) / moves;
    frame({InputEvent::press(0, false)});
    return done;
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
  print("points of the recording", fmt::format("{:.2f} million", static_cast<double>(beams.size()) / 1e6),
        "1.7 million");
  print("points placed anew per second",
        fmt::format("{:.1f} million",
                    1e-6 * rate(beams.size(),
                                [&] { (void)place_beams(beams, request.placement.map->path, 0.0203); })),
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

/// The cues of depth that map A has as it is seen now.
std::string cues_in_words(const Settings& settings) {
  const ShownCues cues = cues_in(camera_of(settings.camera_a, settings.perspective), settings.cues);
  return cues.lighting && cues.splats ? "lit" : cues.lighting || cues.splats ? "partly lit" : "flat";
}

void print_camera(const std::string& what, const Person::Drag& camera) {
  print(what,
        fmt::format("{:.0f}, {:.0f} frames/s ({:.0f} ms CPU)", 1e3 / camera.frames.at(0.5),
                    1e3 / camera.frames.at(0.95), 1e3 * camera.cpu_s),
        "30 frames/s");
}

void measure_moves(Person& person, const std::string& when) {
  for (const char* from : {"top", "isometric"}) {
    person.perform(std::string("look ") + from);
    const bool plan = std::string_view(from) == "top";
    const std::string view =
        fmt::format(", {}, {}{}", from, cues_in_words(person.explorer().settings()), when);
    const Person::Drag handle = person.drag("handle a", 100, 2, 0);
    print("handle's move to the new picture, median and 95 %" + view,
          fmt::format("{:.0f} ms, {:.0f} ms ({:.0f} ms CPU)", handle.frames.at(0.5), handle.frames.at(0.95),
                      1e3 * handle.cpu_s),
          "60 ms, 100 ms");
    // A plan that is tilted is none.
    const Person::Drag camera = person.drag("map a", 100, 5, plan ? 0 : 1);
    print_camera("camera drag, both maps, median and 5 % slowest" + view, camera);
    print_frames("a handle is dragged" + view, handle.frames);
    print_frames("the camera is dragged" + view, camera.frames);
  }
  person.perform("look top");
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
    if (const auto why = explorer.exports.take_failure()) give_up(why->message);
  }
}

/// `poses`: the trajectory, so that nothing is solved and moves alone are measured; or empty.
void measure(const std::string& recording, const std::string& poses, gl::Context& context,
             const std::filesystem::path& folder) {
  const std::string loads = load();
  Person person(context);
  for (int i = 0; i < 5; ++i) person.frame();
  person.perform("offset-a 19");
  person.perform("offset-b 24");
  const auto begin = Clock::now();
  person.perform("open " + quoted(recording) + (poses.empty() ? "" : " " + quoted(poses)));
  Times loading = person.until([&] { return person.explorer().loaded() != nullptr; });
  loading.add(person.frame());
  const double first_s = seconds_since(begin);
  print("from opening to the first picture", fmt::format("{:.2f} s", first_s), "1 s");
  print_frames("a recording is opened", loading);
  person.explorer().maps.hold(false);
  print_frames("all points of the first picture are drawn",
               person.until([&] { return person.ui().shows_all_points(); }));
  print("from the first picture to all of its points",
        fmt::format("{:.2f} s", seconds_since(begin) - first_s), "3 s");
  print_frames("the first two maps are solved", person.until_rest());
  print("from the first picture to all points of both maps solved",
        fmt::format("{:.2f} s", seconds_since(begin) - first_s), "");
  measure_placing(person);
  measure_slices(person, context);
  measure_moves(person, "");
  if (poses.empty()) measure_work(person, folder);
  print("load of the machine before and after, this program included", loads + " and " + load(), "1");
}

}  // namespace
}  // namespace sweepscope::ui

int main(int argc, char** argv) {
  using namespace sweepscope;
  if (argc != 2 && argc != 3) ui::give_up("usage: sweepscope_explorer_benchmark RECORDING [POSES]");
  auto context = gl::make_offscreen_context(1600, 1000);
  if (!context) ui::give_up(context.error().message);
  const test::ScratchFolder folder;
  fmt::print("| {:<76} | {:>32} | {:>20} |\n|{:-<78}|{:->33}:|{:->21}:|\n", "what", "measured", "wanted", "",
             "", "");
  ui::measure(argv[1], argc == 3 ? argv[2] : "", **context, folder.path());
  return 0;
}
