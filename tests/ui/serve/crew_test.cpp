// Several viewers of one session.
#include "ui/serve/crew.hpp"

#include <gtest/gtest.h>

namespace sweepscope::ui {
namespace {

const Crew::Time kNow{};

TEST(Crew, TheFirstDrivesAndTheNextFollowsWhenItLeaves) {
  Crew crew;
  EXPECT_LT(crew.driver(), 0);
  for (const int viewer : {1, 2, 3}) crew.join(viewer);
  EXPECT_EQ(crew.driver(), 1);
  crew.leave(1);
  EXPECT_EQ(crew.driver(), 2);
  crew.leave(3);
  crew.leave(2);
  EXPECT_LT(crew.driver(), 0);
}

TEST(Crew, WhoAsksIsGivenControlByTheDriverAlone) {
  Crew crew;
  for (const int viewer : {1, 2, 3}) crew.join(viewer);
  crew.ask(3, kNow);
  crew.ask(2, kNow);
  EXPECT_EQ(crew.asking(), 3);
  crew.give(2);
  EXPECT_EQ(crew.driver(), 1);
  crew.keep(1);
  EXPECT_EQ(crew.asking(), 2);
  crew.give(1);
  EXPECT_EQ(crew.driver(), 2);
  EXPECT_LT(crew.asking(), 0);
}

TEST(Crew, ADriverWhoDoesNotAnswerGives) {
  Crew crew;
  crew.join(1);
  crew.join(2);
  crew.ask(2, kNow);
  EXPECT_FALSE(crew.expire(kNow + Crew::kMaxAnswer - std::chrono::milliseconds(1)));
  EXPECT_EQ(crew.expires_at(), kNow + Crew::kMaxAnswer);
  EXPECT_TRUE(crew.expire(kNow + Crew::kMaxAnswer));
  EXPECT_EQ(crew.driver(), 2);
  EXPECT_FALSE(crew.expires_at());
}

TEST(Crew, WhoAskedIsNextWhenTheDriverLeaves) {
  Crew crew;
  for (const int viewer : {1, 2, 3}) crew.join(viewer);
  crew.ask(3, kNow);
  crew.leave(1);
  EXPECT_EQ(crew.driver(), 3);
  EXPECT_LT(crew.asking(), 0);
}

}  // namespace
}  // namespace sweepscope::ui
