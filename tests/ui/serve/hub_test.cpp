// What viewers get and may send, without a network.
#include "ui/serve/hub.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <random>

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

/// One that no format makes small.
ServedPicture noise(unsigned seed) {
  auto image = std::make_shared<Image>(640, 480);
  std::minstd_rand random(seed);
  for (std::uint8_t& value : image->rgba) value = static_cast<std::uint8_t>(random() >> 8);
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

TEST_F(Hubs, APictureCanBeSentAtOnceAfterItsPaceOrWhenThePageHasShownOne) {
  EXPECT_EQ(hub_.sendable_at(now_), Hub::Time()) << "nobody looks";
  const int driver = hub_.join(first_, now_).value();
  (void)hub_.join(second_, now_);
  now_ += seconds(1);
  EXPECT_EQ(hub_.sendable_at(now_), Hub::Time());
  first_.busy = true;
  EXPECT_EQ(hub_.sendable_at(now_), std::nullopt) << "the network has not taken the last one";
  first_.busy = false;
  hub_.show(noise(1), now_);
  const auto later = hub_.sendable_at(now_);
  ASSERT_TRUE(later);
  EXPECT_GT(*later, now_) << "the frame was larger than what may be sent at once";
  now_ = *later;
  EXPECT_EQ(hub_.sendable_at(now_), Hub::Time());
  hub_.show(noise(2), now_);
  EXPECT_EQ(hub_.sendable_at(now_ + seconds(9)), std::nullopt) << "two frames wait for the page";
  shown(driver, 1);
  EXPECT_EQ(hub_.sendable_at(now_ + seconds(9)), Hub::Time());
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

/// What the hub answers to an announced file: its address, or why not.
std::string announced(Hub& hub, FakeLink& link, int viewer, const std::string& name, const std::string& size,
                      Hub::Time now) {
  hub.receive(viewer, R"({"type":"upload","name":")" + name + R"(","size_bytes":)" + size + "}", now);
  return link.texts.back();
}

class HubsWithAFolder : public Hubs {
 protected:
  std::string id_of(const std::string& answer) const {
    const std::size_t at = answer.find("/upload/");
    EXPECT_NE(at, answer.npos) << answer;
    return answer.substr(at + 8, 64);
  }

  Hub rooted_{{.max_viewers = 2, .once = true, .roots = FileRoots::of({{folder_}}).value()}, mailbox_};
};

TEST_F(HubsWithAFolder, AnAnnouncedFileIsTakenOnceAndOpened) {
  const int driver = rooted_.join(first_, now_).value();
  const std::string id = id_of(announced(rooted_, first_, driver, "run 7.bag", "9", now_));
  EXPECT_FALSE(rooted_.begin_upload(std::string(64, '0'), 9, now_));
  EXPECT_FALSE(rooted_.begin_upload("", 9, now_));
  const auto upload = rooted_.begin_upload(id, 9, now_);
  ASSERT_TRUE(upload);
  EXPECT_EQ(upload->path, std::filesystem::canonical(folder_) / "run 7.bag");
  EXPECT_FALSE(rooted_.begin_upload(id, 9, now_)) << "it is already being sent";
  (void)mailbox_.wait(0);
  EXPECT_TRUE(rooted_.end_upload(*upload, true));
  const auto events = mailbox_.wait(0).events;
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].what, InputEvent::What::kDrop);
  EXPECT_EQ(events[0].text, upload->path);
  EXPECT_FALSE(rooted_.begin_upload(id, 9, now_)) << "once";
}

TEST_F(HubsWithAFolder, OnlyWhatIsAsLongAsAnnouncedAndInTimeIsTaken) {
  const int driver = rooted_.join(first_, now_).value();
  std::string id = id_of(announced(rooted_, first_, driver, "a.bag", "9", now_));
  EXPECT_FALSE(rooted_.begin_upload(id, 10, now_));
  EXPECT_FALSE(rooted_.begin_upload(id, 9, now_)) << "one try";
  id = id_of(announced(rooted_, first_, driver, "a.bag", "9", now_));
  EXPECT_FALSE(rooted_.begin_upload(id, 9, now_ + seconds(61)));
}

TEST_F(HubsWithAFolder, WhoStoppedDrivingHasTheFileKeptButNotOpened) {
  const int driver = rooted_.join(first_, now_).value(), other = rooted_.join(second_, now_).value();
  const auto upload =
      rooted_.begin_upload(id_of(announced(rooted_, first_, driver, "a.bag", "9", now_)), 9, now_);
  rooted_.receive(other, R"({"type":"control","what":"ask"})", now_);
  rooted_.receive(driver, R"({"type":"control","what":"give"})", now_);
  (void)mailbox_.wait(0);
  EXPECT_FALSE(rooted_.end_upload(upload.value(), true));
  EXPECT_TRUE(mailbox_.wait(0).events.empty());
}

TEST_F(HubsWithAFolder, WhatMayNotBeSentIsRefusedWithTheReason) {
  const int driver = rooted_.join(first_, now_).value(), other = rooted_.join(second_, now_).value();
  const auto refusal = [&](const std::string& name, const std::string& size) {
    const std::string answer = announced(rooted_, first_, driver, name, size, now_);
    EXPECT_EQ(answer.find("/upload/"), answer.npos) << answer;
    return answer;
  };
  for (const char* name : {"", "..", ".bashrc", "../x.bag", "/etc/x", "a/b.bag", "a\\u001b[2J", "a\\nb"})
    EXPECT_NE(refusal(name, "9").find("plain name"), std::string::npos) << name;
  EXPECT_NE(refusal(std::string(300, 'a'), "9").find("plain name"), std::string::npos);
  EXPECT_NE(refusal("huge.bag", "900000000000000").find("free"), std::string::npos);
  std::ofstream(folder_ / "there.bag") << "x";
  std::filesystem::create_symlink("nowhere", folder_ / "link.bag");
  EXPECT_NE(refusal("there.bag", "9").find("already exists"), std::string::npos);
  EXPECT_NE(refusal("link.bag", "9").find("already exists"), std::string::npos);
  EXPECT_NE(announced(rooted_, second_, other, "a.bag", "9", now_).find("Only the viewer who drives"),
            std::string::npos);
  (void)id_of(announced(rooted_, first_, driver, "a.bag", "9", now_));
  EXPECT_NE(refusal("a.bag", "9").find("already being sent"), std::string::npos);
  (void)id_of(announced(rooted_, first_, driver, "b.bag", "9", now_));
  EXPECT_NE(refusal("c.bag", "9").find("Two files"), std::string::npos);
  const int unlimited = hub_.join(second_, now_).value();
  EXPECT_NE(announced(hub_, second_, unlimited, "a.bag", "9", now_).find("--root"), std::string::npos);
  EXPECT_EQ(first_.closed + second_.closed, "");
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
