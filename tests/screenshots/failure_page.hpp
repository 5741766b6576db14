#pragma once

#include <filesystem>
#include <string>

#include "core/error.hpp"

namespace sweepscope::screenshots {

/// What a person reads about a picture that failed.
struct Failure {
  std::string name, command;
  std::string score;  // why, and how much differs
  std::string facts;  // what it was drawn by
};

/// index.html in the failure's folder: those of actual.png, expected.png and difference.png that are there,
/// side by side, with the score. Beside it score.txt and facts.txt.
Result<void> write_failure_page(const std::filesystem::path& folder, const Failure& failure);

/// index.html in the folder of all failures: a link for each folder with a score. Tests that end at the same
/// time take turns.
Result<void> write_failure_index(const std::filesystem::path& folder);

}  // namespace sweepscope::screenshots
