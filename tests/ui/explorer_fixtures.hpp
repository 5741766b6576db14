#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <thread>

#include "tests/scratch_folder.hpp"
#include "ui/explorer/explorer.hpp"

namespace sweepscope::test {

/// Frames until nothing is left to do.
inline void rest(ui::Explorer& explorer) {
  do {
    explorer.update(1.0 / 60);
    if (explorer.background.busy()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  } while (!explorer.at_rest());
}

inline void perform(ui::Explorer& explorer, const std::string& line) {
  const auto done = explorer.perform(line);
  EXPECT_TRUE(done) << line << ": " << done.error().message;
}

inline std::filesystem::path scratch(const std::string& name) {
  static const ScratchFolder folder;
  return folder / name;
}

class InARoom : public testing::Test {
 protected:
  void SetUp() override {
    perform(explorer_, "sample room-1");
    rest(explorer_);
    ASSERT_NE(explorer_.loaded(), nullptr);
  }
  ui::Explorer explorer_;
};

}  // namespace sweepscope::test
