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

/// Writes what a person does as the lines of a script, as it happens: run with the same --size, it does the
/// same.
class ScriptRecorder {
 public:
  /// Replaces the file. ExitCode::kWrongUsage with the system's reason if it cannot be written.
  static Result<ScriptRecorder> create(const std::filesystem::path& path);

  /// What a frame took in, and whether the interface was at rest after it: where it was busy first, a script
  /// has to wait as well.
  void add_frame(std::span<const InputEvent> events, bool at_rest);
  /// After the last frame: whether all of it was written.
  Result<void> end();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void write(const std::string& line);

  std::string name_;
  std::unique_ptr<std::FILE, Close> file_;
  bool failed_ = false;
  bool was_busy_ = false;
};

}  // namespace sweepscope::ui
