// A small server of the Foxglove WebSocket protocol plays a recording; the offset is that of the file.
#include "core/live/foxglove_source.hpp"

#include <gtest/gtest.h>

#include "core/live/calibration.hpp"
#include "core/live/foxglove_protocol.hpp"
#include "core/recording/formats/read_raw_recording.hpp"
#include "core/recording/formats/read_recording.hpp"
#include "core/recording/formats/recording_writer.hpp"
#include "core/simulation/simulate.hpp"
#include "core/simulation/write_simulation.hpp"
#include "tests/core/live/foxglove_player.hpp"
#include "tests/folder_test.hpp"

namespace sweepscope {
namespace {

using foxglove_test::FoxglovePlayer;
using foxglove_test::playlist_of;

class FoxgloveSource : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::ScratchFolder>();
    SimulationOptions options;
    options.scene = "room-1";
    options.offset_s = 0.0173;
    options.duration_s = 5.0;
    const auto simulated = simulate(options, Job());
    ASSERT_TRUE(simulated);
    ASSERT_TRUE(write_bag(*simulated, *folder_ / "room.bag", Job()));
    const auto raw = read_raw_recording(*folder_ / "room.bag", {}, Job());
    ASSERT_TRUE(raw);
    ASSERT_TRUE(write_recording(raw->lasers.at(0), raw->joints.at(0), RecordingFormat::kMcap, "none",
                                *folder_ / "room.mcap", Job()));
  }
  static void TearDownTestSuite() { folder_.reset(); }
  /// Of the file, and of what a server that plays it says.
  void expect_same(const char* file, const char* subprotocol, std::vector<std::size_t> cuts) const {
    const auto recording = read_recording(*folder_ / file, {}, Job());
    ASSERT_TRUE(recording);
    const auto of_file = estimate(*recording, {}, Job());
    ASSERT_TRUE(of_file && of_file->offset_s);
    CalibrationOptions options;
    options.seconds = recording->scans.back().first_beam_s - recording->scans.front().first_beam_s - 1e-6;
    options.every_s = options.silence_s = 1e9;
    const FoxglovePlayer server(playlist_of(*folder_ / file), subprotocol, std::move(cuts));
    auto source = open_foxglove_source(server.url(), options.rig);
    ASSERT_TRUE(source) << source.error().message;
    const auto end = listen(**source, options, Job(), [](const HeardSoFar&, const Result<Estimate>&) {});
    ASSERT_TRUE(end) << end.error().message;
    EXPECT_EQ(*end, ListeningEnd::kHeardEnough);
    // What comes behind the last scan counts in the file, too.
    const auto last_ns = [](const RawRecording& raw) { return raw.joints.at(0).stamps.back().header_ns; };
    const auto whole = read_raw_recording(*folder_ / file, {}, Job());
    ASSERT_TRUE(whole);
    while (last_ns((*source)->so_far()) != last_ns(*whole))
      ASSERT_TRUE((*source)->listen(std::chrono::seconds(1)));
    const auto heard = calibrate((*source)->heard(), options, Job());
    source->reset();
    ASSERT_TRUE(heard) << heard.error().message;
    ASSERT_TRUE(heard->offset_s);
    EXPECT_EQ(*heard->offset_s, *of_file->offset_s);
    EXPECT_EQ(heard->scans, of_file->scans);
  }
  inline static std::unique_ptr<test::ScratchFolder> folder_;
};

TEST_F(FoxgloveSource, FindsTheOffsetOfTheFileInBothDialectsAndEncodings) {
  expect_same("room.bag", "foxglove.websocket.v1", {});
  expect_same("room.bag", "foxglove.sdk.v1", {});
  expect_same("room.mcap", "foxglove.websocket.v1", {});
  expect_same("room.mcap", "foxglove.sdk.v1", {});
}

TEST_F(FoxgloveSource, GoesOnAfterACutConnection) {
  expect_same("room.mcap", "foxglove.sdk.v1", {150, 400});
  expect_same("room.bag", "foxglove.websocket.v1", {300});
}

TEST_F(FoxgloveSource, AServerOfAnotherProtocolIsRefused) {
  const FoxglovePlayer server(playlist_of(*folder_ / "room.bag"), "chat.v1", {});
  const Rig rig;
  const auto source = open_foxglove_source(server.url(), rig);
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().code, ExitCode::kUnreadableInput);
  EXPECT_NE(source.error().message.find("the server supports none of foxglove.sdk.v1"), std::string::npos)
      << source.error().message;
}

TEST(FoxgloveAddress, IsReadWithItsDefaults) {
  const auto whole = parse_foxglove_address("ws://robot.local:9000/bridge?x=1");
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->host, "robot.local");
  EXPECT_EQ(whole->port, "9000");
  EXPECT_EQ(whole->path, "/bridge?x=1");
  const auto bare = parse_foxglove_address("ws://[::1]");
  ASSERT_TRUE(bare);
  EXPECT_EQ(bare->host, "::1");
  EXPECT_EQ(bare->port, "8765");
  EXPECT_EQ(bare->path, "/");
  for (const char* wrong :
       {"", "localhost:8765", "http://localhost", "wss://localhost", "ws://", "ws://:8765", "ws://host:port",
        "ws://host:65536", "ws://host:99999", "ws://host:0", "ws://[::1", "ws://a b:1"})
    EXPECT_FALSE(parse_foxglove_address(wrong)) << wrong;
}

TEST(FoxgloveSourceAddress, NobodyThereIsSaid) {
  const Rig rig;
  EXPECT_EQ(open_foxglove_source("localhost", rig).error().code, ExitCode::kWrongUsage);
  const auto nobody = open_foxglove_source("ws://127.0.0.1:9", rig);
  ASSERT_FALSE(nobody);
  EXPECT_EQ(nobody.error().code, ExitCode::kUnreadableInput);
  EXPECT_TRUE(nobody.error().message.starts_with("ws://127.0.0.1:9/: cannot be reached"))
      << nobody.error().message;
}

TEST(FoxgloveProtocol, WhatIsNotOfItIsLeftOut) {
  EXPECT_FALSE(parse_foxglove_text("{"));
  EXPECT_FALSE(parse_foxglove_text("[]"));
  EXPECT_FALSE(parse_foxglove_text(R"({"op": "advertise", "channels": [{"id": -1}]})"));
  EXPECT_FALSE(parse_foxglove_text(R"({"op": "unadvertise", "channelIds": [1e300]})"));
  EXPECT_FALSE(parse_foxglove_text(R"({"op": "unadvertise", "channelIds": [-1]})"));
  EXPECT_TRUE(parse_foxglove_text(R"({"op": "status", "level": 0, "message": ""})")->advertised.empty());
  EXPECT_EQ(parse_foxglove_text(R"({"op": "unadvertise", "channelIds": [1, 2]})")->withdrawn.size(), 2U);
  EXPECT_EQ(foxglove_subscribe_text({{1, 10}}),
            R"({"op":"subscribe","subscriptions":[{"channelId":10,"id":1}]})");
}

}  // namespace
}  // namespace sweepscope
