#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "core/error.hpp"
#include "ui/host/input.hpp"

namespace sweepscope::ui {

/// The line of a script that does what an event did; empty for one that needs none, such as the release of a
/// key. What was held while a button was pressed is a comment: scripts cannot hold a key.
std::string script_line(const InputEvent& event);

/// Writes what a person or a script does as the lines of a script, as it happens: run with the same --size,
/// it does the same. Places are in pixels.
class ScriptRecorder {
 public:
  /// Replaces the file. ExitCode::kWrongUsage with the system's reason if it cannot be written.
  static Result<ScriptRecorder> create(const std::filesystem::path& path);

  /// What a frame took in, whether the interface was at rest after it, and whether it began work: where there
  /// was work, a script has to wait as well.
  void add_frame(std::span<const InputEvent> events, bool at_rest, bool began_work = false);
  /// A line of a script that is no event: a command, or something that it waits for or expects.
  void add_line(const std::string& line);
  /// The events of a frame of a script, which says itself where it waits.
  void add_events(std::span<const InputEvent> events);
  /// After the last frame: whether all of it was written.
  Result<void> end();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::string name_;
  std::unique_ptr<std::FILE, Close> file_;
  bool failed_ = false;
  bool was_busy_ = false;
};

}  // namespace sweepscope::ui
