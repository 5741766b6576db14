// What viewers get and may send, without a network.
#include "ui/serve/hub.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/folder_test.hpp"

namespace sweepscope::ui {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

struct FakeLink : ViewerLink {
  std::vector<std::string> texts, frames;
  std::string closed;
  bool busy = false;

  void send_text(std::string text) override { texts.push_back(std::move(text)); }
  void send_frame(std::string bytes) override { frames.push_back(std::move(bytes)); }
  bool is_sending() const override { return busy; }
  void close(std::string_view why) override { closed = why; }
};

ServedPicture picture_of(int shade) {
  auto image = std::make_shared<Image>(640, 480);
  std::fill(image->rgba.begin(), image->rgba.end(), static_cast<std::uint8_t>(shade));
  image->make_opaque();
  return {image, 0, 0, 0, false};
}

class Hubs : public test::FolderTest {
 protected:
  void shown(int viewer, std::size_t frame) {
    hub_.receive(viewer, R"({"type":"shown","frame":)" + std::to_string(frame) + "}", now_);
  }

  Mailbox mailbox_;
  Hub hub_{{.max_viewers = 2, .once = true, .roots = {}}, mailbox_};
  FakeLink first_, second_;
  Hub::Time now_{};
};

TEST_F(Hubs, TheLatestPictureWinsAndNoneQueue) {
  const int viewer = hub_.join(first_, now_).value();
  for (int i = 0; i < 50; ++i) {
    now_ += milliseconds(100);
    hub_.show(picture_of(i), now_);
  }
  EXPECT_EQ(first_.frames.size(), 2U) << "two frames wait for the page, and no more";
  shown(viewer, 1);
  ASSERT_EQ(first_.frames.size(), 3U);
  EXPECT_NE(first_.frames[2], first_.frames[1]);
  EXPECT_EQ(first_.closed, "");
}

TEST_F(Hubs, AViewerThatShowsNothingIsCutOffAndTheOtherGoesOn) {
  (void)hub_.join(first_, now_);
  const int other = hub_.join(second_, now_).value();
  for (int i = 0; i < 40; ++i) {
    now_ += seconds(1);
    hub_.show(picture_of(i), now_);
    shown(other, second_.frames.size());
  }
  EXPECT_EQ(first_.frames.size(), 2U);
  EXPECT_NE(first_.closed.find("does not show"), std::string::npos);
  EXPECT_EQ(second_.closed, "");
  EXPECT_GE(second_.frames.size(), 40U);
}

TEST_F(Hubs, AtRestNothingIsSentAndNothingIsDue) {
  const int viewer = hub_.join(first_, now_).value();
  hub_.show(picture_of(1), now_);
  while (const auto next = hub_.next_wake(now_)) {
    ASSERT_LT(first_.frames.size(), 20U);
    now_ = std::max(now_, *next);
    hub_.pump(now_);
    shown(viewer, first_.frames.size());
  }
  const std::size_t frames = first_.frames.size();
  EXPECT_GE(frames, 2U) << "a JPEG, and then every pixel";
  now_ += seconds(100);
  hub_.show(picture_of(1), now_);
  EXPECT_EQ(first_.frames.size(), frames) << "an equal picture is not sent again";
}

TEST_F(Hubs, AFloodEndsTheConnection) {
  const int viewer = hub_.join(first_, now_).value();
  for (int i = 0; i < 5000 && first_.closed.empty(); ++i)
    hub_.receive(viewer, R"({"type":"input","number":1,"events":[["wheel",1]]})", now_);
  EXPECT_EQ(first_.closed, "too many messages");
  const std::size_t kept = mailbox_.wait(0).events.size();
  EXPECT_LE(kept, 4096U);
  hub_.receive(viewer, R"({"type":"input","number":2,"events":[["wheel",1]]})", now_ + seconds(9));
  EXPECT_TRUE(mailbox_.wait(0).events.empty());
}

TEST_F(Hubs, AMessageThatIsNotInTheProtocolEndsTheConnection) {
  const int viewer = hub_.join(first_, now_).value();
  hub_.receive(viewer, R"({"type":"open","file":"/etc/passwd"})", now_);
  EXPECT_NE(first_.closed, "");
}

TEST_F(Hubs, OnlyTheDriversInputCounts) {
  const int driver = hub_.join(first_, now_).value(), other = hub_.join(second_, now_).value();
  hub_.receive(other, R"({"type":"input","number":1,"events":[["wheel",1]]})", now_);
  hub_.receive(other, R"({"type":"size","width":500,"height":500,"scale":1})", now_);
  hub_.receive(other, R"({"type":"paste","text":"x"})", now_);
  const Mailbox::Arrived ignored = mailbox_.wait(0);
  EXPECT_TRUE(ignored.events.empty());
  EXPECT_FALSE(ignored.size);
  EXPECT_FALSE(ignored.pasted);
  hub_.receive(other, R"({"type":"control","what":"ask"})", now_);
  hub_.receive(driver, R"({"type":"control","what":"give"})", now_);
  const Mailbox::Arrived size = mailbox_.wait(0);
  ASSERT_TRUE(size.size) << "the picture takes the size of the new driver's page";
  EXPECT_EQ(size.size->width_px, 500);
  hub_.receive(other, R"({"type":"input","number":1,"events":[["wheel",1]]})", now_);
  EXPECT_EQ(mailbox_.wait(0).events.size(), 1U);
}

TEST_F(Hubs, WhatADriverHeldIsReleasedWhenItIsGone) {
  const int driver = hub_.join(first_, now_).value();
  hub_.receive(driver, R"({"type":"input","number":1,"events":[["press",0,true,0],["key","A",true,1]]})",
               now_);
  (void)mailbox_.wait(0);
  hub_.leave(driver, true, now_);
  const auto events = mailbox_.wait(0).events;
  ASSERT_EQ(events.size(), 2U);
  for (const InputEvent& event : events) EXPECT_FALSE(event.down);
}

TEST_F(Hubs, OneViewerTooManyIsRefused) {
  EXPECT_TRUE(hub_.join(first_, now_));
  EXPECT_TRUE(hub_.join(second_, now_));
  FakeLink third;
  EXPECT_FALSE(hub_.join(third, now_));
}

TEST_F(Hubs, OnceIsOverWhenTheLastViewerLeftAndNotWhenAConnectionBroke) {
  EXPECT_FALSE(hub_.is_over(now_ + seconds(1000))) << "nobody came yet";
  int viewer = hub_.join(first_, now_).value();
  hub_.leave(viewer, true, now_);
  EXPECT_FALSE(hub_.is_over(now_ + seconds(30))) << "it may come back";
  viewer = hub_.join(first_, now_ + seconds(30)).value();
  EXPECT_FALSE(hub_.is_over(now_ + seconds(1000)));
  hub_.leave(viewer, false, now_ + seconds(40));
  EXPECT_TRUE(hub_.is_over(now_ + seconds(44)));
}

TEST_F(Hubs, FilesAreOfferedUnderAddressesThatCannotBeGuessed) {
  std::ofstream(folder_ / "map 1.pcd") << "points";
  (void)hub_.join(first_, now_);
  hub_.offer(folder_ / "map 1.pcd");
  const std::string& text = first_.texts.back();
  const std::size_t at = text.find("/download/");
  ASSERT_NE(at, text.npos) << text;
  EXPECT_NE(text.find("/map%201.pcd"), text.npos) << text;
  EXPECT_EQ(hub_.offered(text.substr(at + 10, 64)), std::filesystem::canonical(folder_ / "map 1.pcd"));
  EXPECT_FALSE(hub_.offered(std::string(64, '0')));
  EXPECT_FALSE(hub_.offered(""));
}

}  // namespace
}  // namespace sweepscope::ui
