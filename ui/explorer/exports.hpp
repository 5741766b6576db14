#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ui/explorer/messages.hpp"
#include "ui/jobs/background.hpp"

namespace sweepscope::ui {

/// A file to be written in the background.
struct Export {
  std::string title, done;  // done: the message once it is written
  std::filesystem::path file;
  std::function<Result<void>(const Job&)> write;
  std::vector<TaskStep> steps = {};
};

/// The files that commands write.
class Exports {
 public:
  Exports(Background& background, Messages& messages) : background_(background), messages_(messages) {}

  void start(Export wanted);
  /// Says that a file is written.
  void written(const std::filesystem::path& file, const std::string& message) const;
  bool is_running() const;
  /// The error of the last export; returned once.
  std::optional<Error> take_failure() { return std::exchange(failure_, std::nullopt); }

  /// Called with each file that is written.
  std::function<void(const std::filesystem::path&)> wrote;

 private:
  Background& background_;
  Messages& messages_;
  std::optional<Error> failure_;
};

}  // namespace sweepscope::ui
