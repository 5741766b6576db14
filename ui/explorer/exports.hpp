#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "render/images/image.hpp"
#include "ui/explorer/messages.hpp"
#include "ui/jobs/background.hpp"

namespace sweepscope::ui {

/// Refuses a name that ends as files of another type do: "x.png" for a session. `types`: such as {"json"}.
Result<void> check_type(const std::string& file, std::span<const std::string_view> types);

/// The endings of pictures that are written, and their file: as JPEG where its name says so, else as PNG.
inline constexpr std::array<std::string_view, 3> kPictureTypes{"png", "jpg", "jpeg"};
Result<void> write_picture(const Image& image, const std::filesystem::path& file);

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
