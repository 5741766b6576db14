#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <memory>
#include <vector>

#include "app/commands.hpp"
#include "app/live_outputs.hpp"
#include "app/progress.hpp"
#include "app/recording_options.hpp"
#include "app/say.hpp"
#include "core/io/output_check.hpp"
#include "core/live/foxglove_source.hpp"
#include "core/live/ros_source.hpp"
#include "core/live/stream_source.hpp"

namespace sweepscope::app {
namespace {

struct LiveArguments {
  std::string source, address;  // the address: of a Foxglove server
  RecordingOptions recording;   // --rig, --laser, --motor, --joint, --stamps and --threads
  std::optional<double> offset_ms;
  bool follow = false;
  std::string every = "sweep";
  double follow_s = 8;
  LiveFrames frames;
  std::filesystem::path folder;
  bool served = false, listen_anywhere = false;
  std::string serve_at;
  std::vector<std::string> hosts, origins;
};

constexpr std::uint16_t kDefaultPort = 8766;

constexpr const char* kNotes =
    "\nClouds are in the base frame, with the motor's motion removed and that of the rig left in. Topics of "
    "ros and --serve: /sweepscope/cloud (sensor_msgs/PointCloud2 with x, y, z, intensity and time in s since "
    "the stamp), /tf (the laser's pose, of the frame LASER_corrected), /sweepscope/offset_ms "
    "(std_msgs/Float64).\n"
    "Without ros, --serve and -o, lines on standard output; the first three name their columns, and the cells "
    "of a cloud hold a number for each point with spaces between them:\n"
    "  cloud,stamp_s,x_m,y_m,z_m,intensity,time_s\n"
    "  pose,stamp_s,x_m,y_m,z_m,qx,qy,qz,qw\n"
    "  offset,stamp_s,offset_ms,sigma_ms\n"
    "Standard input (-) is that of calibrate. It ends with the input, or with Ctrl-C (exit code 130).";

/// What contradicts itself, whatever arrives.
Result<void> check_arguments(const LiveArguments& options) {
  const auto refuse = [](const char* why) { return failure(ExitCode::kWrongUsage, why); };
  if ((options.source == "foxglove") == options.address.empty())
    return refuse(options.address.empty() ? "live foxglove needs an address, such as ws://localhost:8765"
                                          : "an address belongs to live foxglove");
  if (!options.offset_ms && !options.follow)
    return refuse(
        "live needs the offset: --offset-ms X (see estimate, or calibrate), or --follow to estimate it "
        "whenever the rig is stationary");
  return {};
}

/// Where scans come from, and what clouds go to.
struct LiveEnds {
  std::unique_ptr<LiveSource> source;
  std::vector<std::unique_ptr<LiveOutput>> outputs;
};

Result<std::unique_ptr<ui::FoxgloveServer>> start_server(const LiveArguments& options) {
  const auto address = ui::allowed_listen_address(options.serve_at, options.listen_anywhere, kDefaultPort);
  if (!address) return tl::unexpected(address.error());
  ui::FoxgloveServer::Options with;
  with.address = *address;
  with.access = {{options.listen_anywhere, options.hosts}, options.origins};
  with.topics = live_topics();
  with.kept_topic = std::size_t(LiveTopic::kOffset);
  return ui::FoxgloveServer::start(std::move(with));
}

/// Outputs first: a wrong one shows before anything is waited for.
Result<LiveEnds> open_ends(const LiveArguments& options, const Rig& rig) {
  LiveEnds ends;
  if (options.served) {
    auto server = start_server(options);
    if (!server) return tl::unexpected(server.error());
    say("Clouds are served at ws://{}{}\n", (*server)->address().text(),
        (*server)->address().loopback ? "" : ", without encryption, to everyone who reaches this machine");
    ends.outputs.push_back(live_published(served_by(std::move(*server))));
  }
  if (options.source == "ros") {
    auto system = open_ros_system(rig);
    if (!system) return tl::unexpected(system.error());
    ends.source = std::move(system->source);
    ends.outputs.push_back(live_published(std::move(system->publisher)));
  } else if (options.source == "foxglove") {
    auto source = open_foxglove_source(options.address, rig);
    if (!source) return tl::unexpected(source.error());
    ends.source = std::move(*source);
  } else {
    ends.source = std::make_unique<StreamSource>(STDIN_FILENO, "standard input", rig);
  }
  if (!options.folder.empty()) {
    auto folder = live_folder(options.folder);
    if (!folder) return tl::unexpected(folder.error());
    ends.outputs.push_back(std::move(*folder));
  }
  if (ends.outputs.empty()) ends.outputs.push_back(live_lines());
  return ends;
}

/// From the first message to the last.
class LiveRun {
 public:
  LiveRun(const LiveArguments& options, const Rig& rig, LiveEnds ends, const Progress& progress)
      : frames_(options.frames),
        ends_(std::move(ends)),
        progress_(progress),
        clouds_(cloud_options(options, rig)) {
    if (options.offset_ms) {
      given_ = FollowedOffset{*options.offset_ms * 1e-3, 0};
      clouds_.set_offset(given_->offset_s);
    }
    if (!options.follow) return;
    CalibrationOptions calibration;
    calibration.seconds = options.follow_s;
    calibration.stamps = options.recording.stamps;
    follower_.emplace(calibration, given_ ? std::optional(given_->offset_s) : std::nullopt);
  }

  Result<void> run() {
    constexpr std::chrono::milliseconds kAtATime(20);
    while (!progress_.job().cancelled()) {
      const auto more = ends_.source->listen(kAtATime);
      if (!more) return tl::unexpected(more.error());
      auto news = clouds_.take(ends_.source->take());
      if (!news) return tl::unexpected(news.error());
      if (auto passed = pass_on(*news); !passed) return passed;
      if (follower_) say_all(follower_->follow(clouds_));
      if (!*more) return finish();
      say_if_it_waits();
    }
    return failure(ExitCode::kInterrupted, fmt::format("interrupted; {}", words_of_counts()));
  }

 private:
  static LiveCloudOptions cloud_options(const LiveArguments& options, const Rig& rig) {
    LiveCloudOptions with;
    with.rig = rig;
    with.stamps = options.recording.stamps;
    with.each_scan = options.every == "scan";
    with.keep_s = options.follow ? options.follow_s : 0;
    return with;
  }

  /// Once, if laser and motor are not there after 10 s.
  void say_if_it_waits() {
    constexpr std::chrono::seconds kSoon(10);
    if (waited_ || clouds_.rig() || std::chrono::steady_clock::now() - began_ < kSoon) return;
    waited_ = true;
    const HeardSoFar heard = heard_so_far(clouds_.kept());
    say_all({fmt::format("No clouds yet: {} scans and {} motor samples were received. Waiting for more.",
                         heard.scans, heard.motor_samples)});
  }

  Result<void> finish() {
    if (follower_ && !follower_->offset()) {
      auto rest = clouds_.finish();  // chooses laser and motor where the input was short
      if (!rest) return tl::unexpected(rest.error());
      say_all(rest->warnings);
      say_all(follower_->finish(clouds_));
    }
    auto news = clouds_.finish();
    if (!news) return tl::unexpected(news.error());
    if (auto passed = pass_on(*news); !passed) return passed;
    say_all({"The input ended: " + words_of_counts() + "."});
    if (follower_ && !follower_->offset())
      return failure(ExitCode::kNotIdentifiable, "the input ended before the offset was found");
    return {};
  }

  Result<void> pass_on(const LiveNews& news) {
    say_all(news.warnings);
    if (!clouds_.rig()) return {};
    if (frames_.laser.empty())
      frames_.laser = (clouds_.laser_frame().empty() ? "laser" : clouds_.laser_frame()) + "_corrected";
    const auto& offset = follower_ ? follower_->offset() : given_;
    const auto newest_ns = clouds_.newest_scan_ns();
    const bool changed = offset && newest_ns && (!told_ || told_->offset_s != offset->offset_s);
    for (const auto& output : ends_.outputs) {
      if (changed)
        if (auto written = output->write(*offset, *newest_ns); !written) return written;
      if (auto written = output->write(news, frames_); !written) return written;
    }
    if (changed) told_ = offset;
    count_ += news.clouds.size();
    for (const LiveCloud& cloud : news.clouds) points_ += cloud.points.size();
    return {};
  }

  void say_all(const std::vector<std::string>& lines) const {
    for (const std::string& line : lines) progress_.say(line);
  }
  std::string words_of_counts() const { return fmt::format("{} clouds, {} points", count_, points_); }

  LiveFrames frames_;
  LiveEnds ends_;
  const Progress& progress_;
  LiveClouds clouds_;
  std::optional<FollowedOffset> given_, told_;
  std::optional<OffsetFollower> follower_;
  std::size_t count_ = 0, points_ = 0;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  bool waited_ = false;  // was said
};

Result<void> run_live(const LiveArguments& options) {
  if (auto checked = check_arguments(options); !checked) return checked;
  const auto rig = options.recording.running_rig();
  if (!rig) return tl::unexpected(rig.error());
  const Progress progress;
  auto ends = open_ends(options, *rig);
  if (!ends) return tl::unexpected(ends.error());
  return LiveRun(options, *rig, std::move(*ends), progress).run();
}

void declare_offset(CLI::App& command, LiveArguments& options) {
  constexpr const char* kGroup = "The offset";
  command.add_option("--offset-ms", options.offset_ms, "The offset: t_motor = t_laser + offset")
      ->check(finite_number())
      ->check(CLI::Range(-10'000.0, 10'000.0))
      ->type_name("X")
      ->group(kGroup);
  command
      .add_flag("--follow", options.follow,
                "Estimate the offset again and again while the rig is stationary, and use it once it differs "
                "by more than its standard deviation; --offset-ms is the first one")
      ->group(kGroup);
  command.add_option("--follow-s", options.follow_s, "How many seconds of scans such an estimate uses")
      ->check(finite_number())
      ->check(CLI::Range(2.0, 60.0))
      ->capture_default_str()
      ->type_name("S")
      ->group(kGroup);
}

void declare_serving(CLI::App& command, LiveArguments& options) {
  constexpr const char* kGroup = "Foxglove clients";
  CLI::Option* serve =
      command.add_option("--serve", options.serve_at,
                         "Serve the clouds by the Foxglove WebSocket protocol (default: 127.0.0.1:8766)");
  serve->expected(0, 1)->type_name("[ADDRESS:PORT]")->group(kGroup);
  command
      .add_flag("--listen-anywhere", options.listen_anywhere,
                "Allow an ADDRESS that other machines can reach; nothing is encrypted")
      ->group(kGroup)
      ->needs(serve);
  const auto several = [&](const char* name, std::vector<std::string>& values, const char* help,
                           const char* type) {
    command.add_option(name, values, help)
        ->type_name(type)
        ->group(kGroup)
        ->needs(serve)
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  };
  several("--host", options.hosts,
          "A name under which clients reach it, such as that of a reverse proxy; repeatable", "NAME");
  several("--origin", options.origins,
          "A page that may connect, such as https://app.foxglove.dev; repeatable. Programs that are no "
          "browsers need none",
          "URL");
}

void declare(CLI::App& command, LiveArguments& options) {
  const bool ros = ros_source_is_built();
  command
      .add_option(
          "SOURCE", options.source,
          ros ? "- for lines on standard input, or ros for a running ROS 1 system, or foxglove with an "
                "address"
              : "- for lines on standard input, or foxglove with an address (a running ROS 1 system: "
                "not built in here)")
      ->required()
      ->check(CLI::IsMember(ros ? std::vector<std::string>{"-", "ros", "foxglove"}
                                : std::vector<std::string>{"-", "foxglove"}));
  command.add_option("ADDRESS", options.address,
                     "ws://HOST:PORT of a Foxglove WebSocket server, such as ROS 2's foxglove_bridge");
  options.recording.declare_rig(
      command, "Rig file: topics, joint, stamps and mount (default: detected, rolling about x)");
  declare_stamps(command, options.recording.stamps);
  declare_offset(command, options);
  command.add_option("--every", options.every, "A cloud for each sweep, or for each scan")
      ->capture_default_str()
      ->check(CLI::IsMember({"sweep", "scan"}))
      ->type_name("sweep|scan");
  command.add_option("--base-frame", options.frames.base, "The frame of the clouds and the parent in /tf")
      ->capture_default_str()
      ->type_name("NAME");
  command
      .add_option("-o,--output", options.folder,
                  "Write each cloud into this new folder: 000000.pcd, 000001.pcd ...")
      ->type_name("DIR");
  options.recording.threads = 1;
  command.add_option("--threads", options.recording.threads, "Number of threads")
      ->capture_default_str()
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  declare_serving(command, options);
  command.footer(kNotes);
}

}  // namespace

void add_live(CLI::App& app, ExitCode& exit_code) {
  CLI::App* command =
      app.add_subcommand("live", "Publish corrected clouds while the rig runs, to ROS 1, Foxglove or a pipe");
  const auto options = std::make_shared<LiveArguments>();
  declare(*command, *options);
  command->callback([options, command, &exit_code] {
    const auto threads = options->recording.limit_threads();
    options->served = command->count("--serve") > 0;
    if (const auto done = run_live(*options); !done) exit_code = fail(done.error());
  });
}

}  // namespace sweepscope::app
