#include <fmt/format.h>
#include <sys/wait.h>

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include "core/io/atomic_file.hpp"
#include "render/images/image.hpp"
#include "render/images/image_difference.hpp"
#include "tests/screenshots/failure_page.hpp"
#include "tests/screenshots/machine_facts.hpp"
#include "tests/screenshots/manifest.hpp"

namespace sweepscope::screenshots {
namespace {

namespace fs = std::filesystem;

const fs::path kBaselines = fs::path(SWEEPSCOPE_SOURCE_DIR) / "screenshots";
const fs::path kData = fs::path(SWEEPSCOPE_SOURCE_DIR) / "tests/screenshots/data";
const fs::path kJourneys = fs::path(SWEEPSCOPE_SOURCE_DIR) / "tests/screenshots/journeys";
const fs::path kFailures = fs::path(SWEEPSCOPE_BINARY_DIR) / "screenshots";
const fs::path kInputs = fs::path(SWEEPSCOPE_BINARY_DIR) / "screenshots-input";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// As one word of the shell.
std::string quoted(const fs::path& path) {
  return "'" + replaced(path.string(), "'", "'\\''") + "'";
}

/// Runs the executable in the folder of inputs, in an environment in which pictures are the same everywhere.
/// What it says goes to `log`.
Result<void> run_program(const std::string& arguments, const fs::path& log) {
  const std::string command = fmt::format(
      "cd {} && env -u DISPLAY -u WAYLAND_DISPLAY -u LANGUAGE TZ=UTC LANG=C.UTF-8 LC_ALL=C.UTF-8 {} {} >{} "
      "2>&1",
      quoted(kInputs), quoted(SWEEPSCOPE_EXECUTABLE), arguments, quoted(log));
  const int status = std::system(command.c_str());
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  const std::string how = WIFEXITED(status) ? fmt::format("ended with exit code {}", WEXITSTATUS(status))
                                            : std::string("was killed by a signal");
  return unreadable(
      fmt::format("sweepscope {}\n{}; it said:\n{}", arguments, how, read_file(log).value_or("nothing")));
}

Result<void> empty_folder(const fs::path& folder) {
  std::error_code error;
  fs::remove_all(folder, error);
  fs::create_directories(folder, error);
  if (error) return unreadable(fmt::format("{}: {}", folder.string(), error.message()));
  return {};
}

Result<void> prepare(const Manifest& manifest) {
  if (auto emptied = empty_folder(kInputs); !emptied) return emptied;
  std::error_code error;
  fs::create_directories(kFailures, error);
  // Beside the other inputs, as a path that a picture shows may not depend on where the sources lie.
  for (const fs::path& folder : {kData, kJourneys}) {
    fs::copy(folder, kInputs / folder.filename(), fs::copy_options::recursive, error);
    if (error) return unreadable(fmt::format("{}: {}", folder.string(), error.message()));
  }
  const auto facts = machine_facts();
  if (!facts) return tl::unexpected(facts.error());
  fmt::print("{}", *facts);
  if (auto written = write_file(kInputs / "facts.txt", *facts); !written) return written;
  for (const std::string& command : manifest.preparation) {
    if (auto done = run_program(command, kInputs / "said.txt"); !done) return done;
  }
  return {};
}

/// Makes the picture at `path` and reads it; a size other than the manifest's is a failure that leaves it.
Result<Image> make_picture(const Screenshot& picture, const std::string& command, const fs::path& path) {
  if (!picture.made.empty()) {
    std::error_code error;
    fs::copy_file(kInputs / picture.made, path, error);
    if (error) return unreadable(fmt::format("{}: {}", (kInputs / picture.made).string(), error.message()));
  } else {
    const fs::path log = path.parent_path() / "said.txt";
    const auto done = run_program(replaced(command, "{out}", quoted(path)), log);
    if (!done) return tl::unexpected(done.error());
  }
  auto image = read_png(path);
  if (image && (image->width_px != picture.width_px || image->height_px != picture.height_px)) {
    return unreadable(fmt::format("The picture has {} x {} pixels; the manifest says {} x {}.",
                                  image->width_px, image->height_px, picture.width_px, picture.height_px));
  }
  return image;
}

/// Whether a picture is its baseline, and what is to be said about it.
struct Verdict {
  bool passes = false;
  std::string score;
};

/// Draws a picture into `folder`, beside it what it should be and where they differ.
Verdict judge(const std::string& name, const Screenshot& picture, const std::string& command,
              const fs::path& folder) {
  const auto actual = make_picture(picture, command, folder / "actual.png");
  const fs::path baseline = kBaselines / (name + ".png");
  std::error_code none;
  fs::copy_file(baseline, folder / "expected.png", none);
  if (!actual) return {false, actual.error().message};
  if (none) {
    return {
        false,
        fmt::format(
            "There is no baseline screenshots/{0}.png. Look at actual.png; ./check --accept {0} takes it.",
            name)};
  }
  const auto expected = read_png(baseline);
  if (!expected) return {false, expected.error().message};
  const auto difference = compare_images(*actual, *expected);
  if (difference.same_size) {
    const auto written = write_png(difference_picture(*actual, *expected), folder / "difference.png");
    if (!written) return {false, written.error().message};
  }
  return {difference.passes, describe(difference)};
}

Result<void> keep_failure(const fs::path& folder, const std::string& command, const std::string& score) {
  const std::string facts = read_file(kInputs / "facts.txt").value_or("unknown");
  return write_failure_page(folder, {folder.filename().string(), command, score, facts}).and_then([] {
    return write_failure_index(kFailures);
  });
}

/// A passing picture leaves nothing; a failing one leaves its page.
Result<void> settle(const fs::path& folder, const std::string& command, bool passes,
                    const std::string& score) {
  fmt::print("{}\n", score);
  if (passes) {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
    return write_failure_index(kFailures);
  }
  if (auto kept = keep_failure(folder, command, score); !kept) return kept;
  return failure(ExitCode::kImageDiffers,
                 fmt::format("{}: look at {}", folder.filename().string(), (folder / "index.html").string()));
}

Result<void> run(const Manifest& manifest, const std::string& name) {
  const Screenshot& picture = manifest.pictures.at(name);
  const fs::path folder = kFailures / name;
  if (auto emptied = empty_folder(folder); !emptied) return emptied;
  const Verdict verdict = judge(name, picture, picture.command, folder);
  return settle(folder, picture.made.empty() ? picture.command : picture.made, verdict.passes, verdict.score);
}

/// Passes where the gate turns the spoiled picture down, and it was the gate that did.
Result<void> run_control(const Manifest& manifest, const std::string& name) {
  const Control& control = manifest.controls.at(name);
  const Screenshot& picture = manifest.pictures.at(control.of);
  const std::string command = replaced(picture.command, control.replace, control.by);
  const fs::path folder = kFailures / ("control-" + name);
  if (auto emptied = empty_folder(folder); !emptied) return emptied;
  const Verdict verdict = judge(control.of, picture, command, folder);
  const bool compared = fs::exists(folder / "difference.png");
  const std::string said = !compared        ? "could not be compared: "
                           : verdict.passes ? "passes, and must not: "
                                            : "is turned down, as it must be: ";
  return settle(folder, command, compared && !verdict.passes, "The spoiled picture " + said + verdict.score);
}

Result<void> accept(const Manifest& manifest, std::span<const std::string> names) {
  const char* ci = std::getenv("CI");
  if (ci != nullptr && std::string(ci) == "true") {
    return failure(ExitCode::kWrongUsage, "Baselines are accepted by a person who looked, not by CI.");
  }
  if (auto prepared = prepare(manifest); !prepared) return prepared;
  for (const std::string& name : names) {
    const Screenshot& picture = manifest.pictures.at(name);
    const fs::path folder = kFailures / name;
    if (auto emptied = empty_folder(folder); !emptied) return emptied;
    const auto made = make_picture(picture, picture.command, folder / "actual.png");
    if (!made) return tl::unexpected(made.error());
    const auto bytes = read_file(folder / "actual.png");
    if (!bytes) return tl::unexpected(bytes.error());
    const fs::path baseline = kBaselines / (name + ".png");
    if (auto written = write_file(baseline, *bytes); !written) return written;
    fmt::print("{}\n", baseline.string());
    fs::remove_all(folder);
  }
  fmt::print("Look at each of these before you commit them.\n");
  return write_failure_index(kFailures);
}

/// Every picture and control is a test, and every baseline belongs to a picture.
Result<void> check(const Manifest& manifest, std::span<const std::string> tests) {
  const std::set<std::string> tested(tests.begin(), tests.end());
  std::set<std::string> listed;
  for (const auto& [name, picture] : manifest.pictures) listed.insert(name);
  for (const auto& [name, control] : manifest.controls) listed.insert("control." + name);
  if (tested != listed) return unreadable("the tests are not those of the manifest: configure again");
  for (const auto& entry : fs::directory_iterator(kBaselines)) {
    const fs::path file = entry.path().filename();
    const bool baseline = file.extension() == ".png" && manifest.pictures.contains(file.stem().string());
    if (baseline || file == "manifest.yaml" || manifest.other_files.contains(file.string())) continue;
    return unreadable(fmt::format("{}: no picture of the manifest has this baseline", entry.path().string()));
  }
  return {};
}

Result<void> obey(const std::string& order, std::span<const std::string> names) {
  const auto manifest = read_manifest(kBaselines / "manifest.yaml");
  if (!manifest) return tl::unexpected(manifest.error());
  if (order == "check") return check(*manifest, names);
  for (const std::string& name : names) {
    const bool known =
        order == "control" ? manifest->controls.contains(name) : manifest->pictures.contains(name);
    if (!known) {
      return failure(ExitCode::kWrongUsage, fmt::format("screenshots/manifest.yaml has no {}", name));
    }
  }
  if (order == "list" && names.empty()) {
    for (const auto& [name, picture] : manifest->pictures) fmt::print("{}\n", name);
    return {};
  }
  if (order == "prepare" && names.empty()) return prepare(*manifest);
  if (order == "run" && names.size() == 1) return run(*manifest, names[0]);
  if (order == "control" && names.size() == 1) return run_control(*manifest, names[0]);
  if (order == "accept" && !names.empty()) return accept(*manifest, names);
  return failure(ExitCode::kWrongUsage,
                 "prepare | run NAME | control NAME | accept NAME... | list | check TEST...");
}

}  // namespace
}  // namespace sweepscope::screenshots

int main(int count, char** words) {
  const std::vector<std::string> said(words + 1, words + count);
  const std::span<const std::string> names(said);
  try {
    const auto done =
        sweepscope::screenshots::obey(said.empty() ? "" : said[0], said.empty() ? names : names.subspan(1));
    if (done) return 0;
    fmt::print(stderr, "screenshot_runner: {}\n", done.error().message);
    return static_cast<int>(done.error().code);
  } catch (const std::exception& error) {
    fmt::print(stderr, "screenshot_runner: {}\n", error.what());
    return 1;
  }
}
