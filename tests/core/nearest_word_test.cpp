#include "core/nearest_word.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace sweepscope {
namespace {

const std::vector<std::string> kWords{"info", "convert", "estimate", "compare", "calibrate", "view"};

TEST(NearestWord, FindsWhatWasMeantByASlipOfTheFingers) {
  EXPECT_EQ(nearest_word("estimte", kWords), "estimate");
  EXPECT_EQ(nearest_word("veiw", kWords), "view");
  EXPECT_EQ(nearest_word("comparee", kWords), "compare");
  EXPECT_EQ(nearest_word("infp", kWords), "info");
  EXPECT_EQ(nearest_word("cal", kWords), "calibrate");
}

TEST(NearestWord, NamesNothingWhereNothingIsNear) {
  for (const char* word : {"", "walk.bag", "help", "c", "xyz"})
    EXPECT_EQ(nearest_word(word, kWords), "") << word;
  EXPECT_EQ(nearest_word(std::string(5000, 'a'), kWords), "");
  EXPECT_EQ(nearest_word("view", std::vector<std::string>{}), "");
}

}  // namespace
}  // namespace sweepscope
