// What viewers sent, as the explorer takes it.
#include "ui/serve/mailbox.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace sweepscope::ui {
namespace {

using Clock = Mailbox::Clock;
constexpr double kLong_s = 1e6;

InputMessage wheel(std::uint32_t number) {
  return {number, {InputEvent::scroll(number)}};
}

TEST(Mailboxes, AMoveReplacesTheMoveBeforeItAndNothingElse) {
  Mailbox mailbox;
  EXPECT_TRUE(mailbox.add({1, {InputEvent::move(1, 1), InputEvent::move(2, 2), InputEvent::scroll(1)}}));
  EXPECT_TRUE(mailbox.add({2, {InputEvent::move(3, 3), InputEvent::move(4, 4)}}));
  const auto arrived = mailbox.wait(kLong_s);
  ASSERT_EQ(arrived.events.size(), 3U);
  EXPECT_EQ(arrived.events[0].x, 2);
  EXPECT_EQ(arrived.events[2].x, 4);
  EXPECT_EQ(arrived.input_number, 2U);
}

TEST(Mailboxes, WhatComesUntilAPictureCanBeSentIsTakenTogether) {
  Mailbox mailbox(std::chrono::hours(10));
  mailbox.set_sendable(std::nullopt);
  (void)mailbox.add(wheel(1));
  std::thread network([&] {
    (void)mailbox.add(wheel(2));
    (void)mailbox.add(wheel(3));
    mailbox.set_sendable(Clock::now());
  });
  const auto arrived = mailbox.wait(kLong_s);
  network.join();
  EXPECT_EQ(arrived.events.size(), 3U);
  EXPECT_EQ(arrived.input_number, 3U);
}

TEST(Mailboxes, DrawingBeginsSoThatItEndsWhenThePictureCanBeSent) {
  Mailbox mailbox(std::chrono::hours(10));
  const auto at = Clock::now() + std::chrono::hours(1);
  mailbox.set_sendable(at);
  (void)mailbox.add(wheel(1));
  EXPECT_EQ(mailbox.wait(kLong_s, std::chrono::hours(2)).events.size(), 1U) << "it takes longer: at once";
  (void)mailbox.add(wheel(2));
  const auto drawing = std::chrono::hours(1) - std::chrono::milliseconds(20);
  (void)mailbox.wait(kLong_s, drawing);
  EXPECT_GE(Clock::now(), at - drawing);
}

TEST(Mailboxes, APageThatDoesNotAnswerHoldsTheExplorerUpNoLongerThanGiven) {
  Mailbox mailbox(std::chrono::milliseconds(1));
  mailbox.set_sendable(std::nullopt);
  (void)mailbox.add(wheel(1));
  EXPECT_EQ(mailbox.wait(kLong_s).events.size(), 1U);
}

TEST(Mailboxes, MoreInputThanTheExplorerCanTakeIsRefused) {
  Mailbox mailbox;
  bool taken = true;
  for (int i = 0; i < 10000 && taken; ++i) taken = mailbox.add(wheel(1));
  EXPECT_FALSE(taken);
}

}  // namespace
}  // namespace sweepscope::ui
