#pragma once

#include <gtest/gtest.h>

#include "tests/scratch_folder.hpp"

namespace sweepscope::test {

/// A fresh folder of its own for each test, gone afterwards.
class FolderTest : public ::testing::Test {
  const ScratchFolder scratch_;

 protected:
  const std::filesystem::path folder_ = scratch_.path();
};

}  // namespace sweepscope::test
