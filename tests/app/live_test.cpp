#include <csignal>
#include <fstream>
#include <future>
#include <map>
#include <random>
#include <sstream>
#include <thread>

#include "core/io/cloud_file.hpp"
#include "core/live/foxglove_protocol.hpp"
#include "core/live/live_messages.hpp"
#include "core/live/web_socket.hpp"
#include "core/recording/messages/messages.hpp"
#include "tests/core/live/foxglove_player.hpp"
#include "tests/program.hpp"

namespace sweepscope {
namespace {

using foxglove_test::FoxglovePlayer;
using foxglove_test::Played;
using foxglove_test::Playlist;
using foxglove_test::playlist_of;

/// A point and its time after the cloud's stamp.
struct LivePoint {
  float x_m = 0, y_m = 0, z_m = 0, intensity = 0, time_s = 0;
};
using LivePoints = std::vector<LivePoint>;
using StampedClouds = std::map<std::int64_t, LivePoints>;  // by the stamp, ns

LivePoints points_of(const CloudMessage& cloud) {
  LivePoints points;
  for (std::size_t i = 0; i < cloud.points(); ++i) {
    const auto value = [&](std::size_t field) {
      return static_cast<float>(cloud.value(i, cloud.fields.at(field)));
    };
    points.push_back({value(0), value(1), value(2), value(3), value(4)});
  }
  return points;
}

void add_cloud(std::span<const std::byte> bytes, StampedClouds& clouds) {
  const auto cloud = decode_cloud(Encoding::kRos1, bytes);
  ASSERT_TRUE(cloud);
  EXPECT_EQ(cloud->frame, "base_link");
  clouds[cloud->header_ns] = points_of(*cloud);
}

std::vector<float> numbers_of(const std::string& cell) {
  std::istringstream in(cell);
  return {std::istream_iterator<float>(in), {}};
}

std::int64_t ns_of(const std::string& seconds) {
  const std::size_t point = seconds.find('.');
  return std::stoll(seconds.substr(0, point)) * 1'000'000'000 + std::stoll(seconds.substr(point + 1));
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

/// The lines that live prints.
struct LiveLines {
  StampedClouds clouds;
  std::size_t poses = 0;
  std::vector<std::string> offsets;
};
LiveLines parsed_lines(const std::string& text) {
  LiveLines lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() < 2 || cells[1] == "stamp_s") continue;
    if (cells[0] == "pose") ++lines.poses;
    if (cells[0] == "offset") lines.offsets.push_back(cells.at(2));
    if (cells[0] != "cloud") continue;
    std::vector<std::vector<float>> columns;
    for (std::size_t i = 2; i < 7; ++i) columns.push_back(numbers_of(cells.at(i)));
    LivePoints& points = lines.clouds[ns_of(cells[1])];
    for (std::size_t i = 0; i < columns[0].size(); ++i)
      points.push_back(
          {columns[0][i], columns[1].at(i), columns[2].at(i), columns[3].at(i), columns[4].at(i)});
  }
  return lines;
}

/// All of `expected` but the first and the last cloud, which apply may join to others.
void expect_same(const StampedClouds& live, const StampedClouds& expected) {
  ASSERT_GE(expected.size(), 10U);
  for (auto one = std::next(expected.begin()); one != std::prev(expected.end()); ++one) {
    const auto other = live.find(one->first);
    ASSERT_NE(other, live.end()) << "no cloud of " << one->first;
    ASSERT_EQ(other->second.size(), one->second.size());
    for (std::size_t i = 0; i < one->second.size(); ++i) {
      const LivePoint &a = one->second[i], &b = other->second[i];
      ASSERT_LT(std::hypot(a.x_m - b.x_m, a.y_m - b.y_m, a.z_m - b.z_m), 1e-5F);
      ASSERT_NEAR(a.time_s, b.time_s, 1e-6F);
      ASSERT_EQ(a.intensity, b.intensity);
    }
  }
}

class LiveCommand : public test::ProgramTest {
 protected:
  void SetUp() override {
    make({"simulate room-1 --duration-s 8 --offset-ms 17.3 --motor triangle -o room.bag",
          "convert room.bag -o tables", "convert room.bag -o room.mcap",
          "apply room.bag --offset-ms 17.3 --assume stationary --clouds /sweeps --tf -o applied.bag"});
    std::ofstream stream(folder_ / "stream.csv");
    std::multimap<std::string, std::string> lines;  // by the stamp, whose digits are as many everywhere
    for (const char* word : {"scan", "motor"}) {
      std::ifstream table(folder_ / (word == std::string("scan") ? "tables/scans.csv" : "tables/motor.csv"));
      std::string line;
      std::getline(table, line);
      stream << word << ',' << line << '\n';
      while (std::getline(table, line)) lines.emplace(line.substr(0, line.find(',')), word + (',' + line));
    }
    for (const auto& [stamp, line] : lines) stream << line << '\n';
  }
  /// What `apply --clouds` writes.
  StampedClouds applied() const {
    StampedClouds clouds;
    const Playlist list = playlist_of(folder_ / "applied.bag");
    for (const Played& message : list.messages)
      if (list.topics[message.topic].name == "/sweeps") add_cloud(message.bytes, clouds);
    return clouds;
  }
};

TEST_F(LiveCommand, PrintsTheCloudsOfALineStream) {
  const Outcome outcome = run("live - --offset-ms 17.3 <stream.csv");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const LiveLines lines = parsed_lines(outcome.out);
  expect_same(lines.clouds, applied());
  EXPECT_GE(lines.poses, 790U);
  EXPECT_EQ(lines.offsets, std::vector<std::string>{"17.3"});
  EXPECT_NE(outcome.err.find("The input ended: "), std::string::npos) << outcome.err;
}

TEST_F(LiveCommand, WritesCloudsIntoAFolder) {
  const Outcome outcome = run("live - --offset-ms 17.3 -o clouds <stream.csv");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  const auto first = read_cloud(folder_ / "clouds/000003.pcd");
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_GT((*first)->size(), 5000U);
  EXPECT_EQ(run("live - --offset-ms 17.3 -o clouds <stream.csv").exit_code, 2) << "it exists";
}

TEST_F(LiveCommand, PlacesEachScanWhereItIsAskedTo) {
  const Outcome outcome = run("live - --offset-ms 17.3 --every scan <stream.csv");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  StampedClouds whole;
  const StampedClouds scans = parsed_lines(outcome.out).clouds;
  EXPECT_GE(scans.size(), 310U);
  std::size_t points = 0, expected = 0;
  for (const auto& [stamp, cloud] : scans) points += cloud.size();
  for (const auto& [stamp, cloud] : applied()) expected += cloud.size();
  EXPECT_GE(points, expected);
}

TEST_F(LiveCommand, FollowsTheOffset) {
  const Outcome outcome = run("live - --follow --follow-s 5 <stream.csv");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const LiveLines lines = parsed_lines(outcome.out);
  ASSERT_GE(lines.offsets.size(), 1U) << outcome.err;
  EXPECT_NEAR(std::stod(lines.offsets.front()), 17.3, 0.15);
  EXPECT_GE(lines.clouds.size(), 5U);
  EXPECT_NE(outcome.err.find("The offset is 17."), std::string::npos) << outcome.err;
}

TEST_F(LiveCommand, SaysThatAWrongOffsetHasChanged) {
  // Long enough that an estimate ends before the input does: it waits for the words.
  std::ofstream(folder_ / "follow.sh")
      << "mkfifo lines\n"
         "\"$1\" live - --offset-ms 12 --follow --follow-s 5 <lines "
         ">clouds.csv 2>words &\n"
         "program=$!\n"
         "exec 3>lines\n"
         "cat stream.csv >&3\n"
         "until grep -q 'The offset has changed to 17' words; do\n"
         "  kill -0 $program || exit 1; tail -n 1 stream.csv >&3; sleep 0.05\n"
         "done\n"
         "exec 3>&-\n"
         "wait $program\n";
  const Outcome outcome = test::run_shell(folder_, "bash follow.sh '" SWEEPSCOPE_EXECUTABLE "'");
  EXPECT_EQ(outcome.exit_code, 0) << test::contents_of(folder_ / "words");
  const LiveLines lines = parsed_lines(test::contents_of(folder_ / "clouds.csv"));
  ASSERT_EQ(lines.offsets.size(), 2U);
  EXPECT_EQ(lines.offsets[0], "12");
  EXPECT_NEAR(std::stod(lines.offsets[1]), 17.3, 0.15);
}

TEST_F(LiveCommand, WrongUseAndBadInputAreSaid) {
  std::ofstream(folder_ / "profile.yaml") << "motor: {profile: {turns_per_s: 0.5}}";
  for (const char* command : {"live - --offset-ms 17.3", "calibrate -"}) {
    const Outcome of_profile = run(std::string(command) + " --rig profile.yaml </dev/null");
    EXPECT_EQ(of_profile.exit_code, 2) << command;
    EXPECT_NE(of_profile.err.find("needs messages of its motor"), std::string::npos) << of_profile.err;
  }
  const auto expect = [&](const std::string& arguments, int code, const std::string& words) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, code) << arguments;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << arguments << ": " << outcome.err;
  };
  expect("live - </dev/null", 2, "live needs the offset");
  expect("live foxglove --offset-ms 1", 2, "needs an address");
  expect("live foxglove localhost:1 --offset-ms 1", 2, "is not the address of a Foxglove server");
  expect("live foxglove ws://127.0.0.1:9 --offset-ms 1", 3, "cannot be reached");
  expect("live - ws://127.0.0.1:9 --offset-ms 1 </dev/null", 2, "an address belongs to live foxglove");
  expect("live - --offset-ms 1 --serve 0.0.0.0:0 </dev/null", 2, "add --listen-anywhere");
  expect("live - --offset-ms 1 --serve nonsense </dev/null", 2, "ADDRESS:PORT is needed");
  expect("live - --offset-ms 1 </dev/null", 3, "standard input: No scans were received.");
  expect("live - --offset-ms 1 <tables/scans.csv", 3, "standard input: No scans were received.");
  expect("live - --offset-ms 1 --joint wheel <stream.csv", 3,
         "No motor angles of the joint wheel were received.");
  expect("live - --offset-ms 99999 </dev/null", 2, "--offset-ms");
}

/// The program in the background of a shell.
class RunningLive {
 public:
  RunningLive(std::filesystem::path folder, const std::string& arguments) : folder_(std::move(folder)) {
    const std::string command =
        "env --default-signal -u DISPLAY bash -c 'echo $$ >pid.part; mv pid.part pid; "
        "exec \"" SWEEPSCOPE_EXECUTABLE "\" " +
        arguments + "'";
    outcome_ = std::async(std::launch::async, [this, command] { return test::run_shell(folder_, command); });
  }
  /// Waits for words on stderr; what stands behind them in their line.
  std::string said(const std::string& words) const {
    while (outcome_.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready) {
      const std::string err = test::contents_of(folder_ / "said.err");
      const std::size_t at = err.find(words);
      if (at == err.npos || err.find('\n', at) == err.npos) continue;
      return err.substr(at + words.size(), err.find('\n', at) - at - words.size());
    }
    ADD_FAILURE() << "it ended: " << test::contents_of(folder_ / "said.err");
    return "";
  }
  test::Outcome interrupted() {
    kill(std::stoi(test::contents_of(folder_ / "pid")), SIGINT);
    return outcome_.get();
  }

 private:
  std::filesystem::path folder_;
  std::future<test::Outcome> outcome_;
};

/// A client of --serve: collects messages until the clouds with these stamps have come.
struct Served {
  StampedClouds clouds;
  std::size_t transforms = 0;
  double offset_ms = 0;
};
class ServedClient {
 public:
  explicit ServedClient(const std::string& url) {
    auto socket = WebSocket::connect(*parse_foxglove_address(url), kFoxgloveSubprotocols);
    EXPECT_TRUE(socket) << socket.error().message;
    socket_ = std::move(*socket);
  }
  /// Subscribes to all channels, and waits until the server has heard of it: it sends the offset at once.
  void subscribe() {
    std::vector<FoxgloveSubscription> all;
    while (all.empty()) {
      const auto message = next();
      const std::string text(reinterpret_cast<const char*>(message.bytes.data()), message.bytes.size());
      const auto news = parse_foxglove_text(text);
      ASSERT_TRUE(news) << text;
      for (const FoxgloveChannel& channel : news->advertised) {
        topics_[std::uint32_t(all.size())] = channel.topic;
        all.push_back({std::uint32_t(all.size()), channel.id});
      }
    }
    ASSERT_EQ(all.size(), 3U);
    ASSERT_TRUE(socket_->send(foxglove_subscribe_text(all)));
  }
  /// The length of a list of ROS 1.
  static std::uint32_t count_of(std::span<const std::byte> message) {
    std::uint32_t count = 0;
    std::memcpy(&count, message.data(), sizeof count);
    return count;
  }
  Served until(std::int64_t stamp_ns) {
    Served served;
    while (served.clouds.empty() || served.clouds.rbegin()->first < stamp_ns) {
      const auto message = next();
      const auto data = parse_foxglove_bytes(message.bytes);
      if (!data) continue;
      const std::string topic = topics_[data->subscription];
      if (topic == "/sweepscope/cloud") add_cloud(data->bytes, served.clouds);
      if (topic == "/tf") served.transforms += count_of(data->bytes);
      if (topic == "/sweepscope/offset_ms") std::memcpy(&served.offset_ms, data->bytes.data(), 8);
    }
    return served;
  }

 private:
  WebSocketMessage next() {
    for (;;) {
      auto message = socket_->receive(std::chrono::seconds(1));
      if (!message) throw std::runtime_error(message.error().message);
      if (*message) return std::move(**message);
    }
  }
  std::unique_ptr<WebSocket> socket_;
  std::map<std::uint32_t, std::string> topics_;
};

class ServedLive : public LiveCommand {
 protected:
  /// Of a server that plays this list: the clouds that a client of --serve gets are those of apply.
  void expect_served(Playlist list, std::vector<std::size_t> cuts) {
    FoxglovePlayer player(std::move(list), "foxglove.websocket.v1", std::move(cuts), true);
    RunningLive live(folder_, "live foxglove " + player.url() + " --offset-ms 17.3 --serve 127.0.0.1:0");
    ServedClient client(live.said("Clouds are served at "));
    client.subscribe();
    player.play();
    const StampedClouds expected = applied();
    const Served served = client.until(std::prev(expected.end(), 2)->first);
    expect_same(served.clouds, expected);
    EXPECT_GE(served.transforms, 700U);
    EXPECT_EQ(served.offset_ms, 17.3);
    const test::Outcome outcome = live.interrupted();
    EXPECT_EQ(outcome.exit_code, 130) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }
};

/// Each message up to 150 ms later than it was; `seed` decides which ones.
Playlist reordered(Playlist list, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::pair<std::int64_t, Played>> delayed;
  for (Played& message : list.messages) {
    const double late_s = 0.15 * double(random()) / 4294967296.0;
    delayed.emplace_back(message.log_ns + std::llround(late_s * 1e9), std::move(message));
  }
  std::ranges::stable_sort(delayed, {}, &std::pair<std::int64_t, Played>::first);
  for (std::size_t i = 0; i < delayed.size(); ++i) list.messages[i] = std::move(delayed[i].second);
  return list;
}

TEST_F(ServedLive, CloudsAreThoseOfApply) {
  expect_served(playlist_of(folder_ / "room.bag"), {});
  expect_served(playlist_of(folder_ / "room.mcap"), {});
}

TEST_F(ServedLive, CloudsAreTheSameOfLateAndReorderedMessages) {
  expect_served(reordered(playlist_of(folder_ / "room.bag"), 1), {});
}

TEST_F(ServedLive, CloudsAreTheSameAfterKilledConnections) {
  expect_served(playlist_of(folder_ / "room.bag"), {300, 700});
}

TEST_F(ServedLive, AnInterruptionEndsItWhileNothingArrives) {
  FoxglovePlayer player(playlist_of(folder_ / "room.bag"), "foxglove.sdk.v1", {});
  RunningLive live(folder_, "live foxglove " + player.url() + " --offset-ms 17.3 -o clouds");
  while (!exists("clouds/000009.pcd")) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  const test::Outcome outcome = live.interrupted();
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_NE(outcome.err.find("interrupted"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace sweepscope
