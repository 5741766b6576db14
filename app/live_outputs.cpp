#include "app/live_outputs.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "core/io/cloud_file.hpp"

namespace sweepscope::app {
namespace {

std::string seconds_text(std::int64_t ns) {
  return fmt::format("{}.{:09}", ns / kSecond_ns, ns % kSecond_ns);
}

/// Numbers of all points, with spaces between them.
template <typename Number>
void append_cell(std::string& line, const MapCloud& cloud, const Number& number) {
  char before = ',';
  for (const MapPoint& point : cloud.points) {
    fmt::format_to(std::back_inserter(line), "{}{}", before, number(point));
    before = ' ';
  }
  if (cloud.points.empty()) line += ',';
}

class LinesOutput : public LiveOutput {
 public:
  Result<void> write(const LiveNews& news, const LiveFrames&) override {
    std::string lines;
    for (const LivePose& pose : news.poses) lines += line_of(pose);
    for (const LiveCloud& cloud : news.clouds) lines += line_of(cloud);
    return print(lines);
  }
  Result<void> write(const FollowedOffset& offset, std::int64_t stamp_ns) override {
    return print(fmt::format("offset,{},{},{}\n", seconds_text(stamp_ns), offset.offset_s * 1e3,
                             offset.sigma_s * 1e3));
  }

 private:
  static std::string line_of(const LivePose& pose) {
    const Eigen::Vector3d& p_m = pose.base_from_laser.translation_m;
    const Eigen::Quaterniond& q = pose.base_from_laser.rotation;
    return fmt::format("pose,{},{},{},{},{},{},{},{}\n", seconds_text(pose.stamp_ns), p_m.x(), p_m.y(),
                       p_m.z(), q.x(), q.y(), q.z(), q.w());
  }
  static std::string line_of(const LiveCloud& cloud) {
    std::string line = "cloud," + seconds_text(cloud.stamp_ns());
    append_cell(line, cloud.points, [](const MapPoint& point) { return point.x; });
    append_cell(line, cloud.points, [](const MapPoint& point) { return point.y; });
    append_cell(line, cloud.points, [](const MapPoint& point) { return point.z; });
    append_cell(line, cloud.points, [](const MapPoint& point) { return point.intensity; });
    append_cell(line, cloud.points,
                [&](const MapPoint& point) { return static_cast<float>(point.time_s - cloud.begin_s); });
    return line + '\n';
  }

  Result<void> print(const std::string& lines) {
    if (lines.empty()) return {};
    if (!std::exchange(named_, true))
      std::fputs(
          "cloud,stamp_s,x_m,y_m,z_m,intensity,time_s\n"
          "pose,stamp_s,x_m,y_m,z_m,qx,qy,qz,qw\n"
          "offset,stamp_s,offset_ms,sigma_ms\n",
          stdout);
    std::fwrite(lines.data(), 1, lines.size(), stdout);
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return {};
    return failure(ExitCode::kWrongUsage, "standard output: cannot be written");
  }

  bool named_ = false;
};

class FolderOutput : public LiveOutput {
 public:
  explicit FolderOutput(std::filesystem::path folder) : folder_(std::move(folder)) {}

  Result<void> write(const LiveNews& news, const LiveFrames&) override {
    for (LiveCloud cloud : news.clouds) {
      const double epoch_s = double(cloud.epoch_ns) * 1e-9;
      for (MapPoint& point : cloud.points.points) point.time_s += epoch_s;
      if (auto done = write_cloud(folder_ / fmt::format("{:06}.pcd", clouds_++), cloud.points); !done)
        return done;
    }
    return {};
  }
  Result<void> write(const FollowedOffset&, std::int64_t) override { return {}; }

 private:
  std::filesystem::path folder_;
  std::size_t clouds_ = 0;
};

class PublishedOutput : public LiveOutput {
 public:
  explicit PublishedOutput(std::unique_ptr<LivePublisher> publisher) : publisher_(std::move(publisher)) {}

  Result<void> write(const LiveNews& news, const LiveFrames& frames) override {
    if (!news.poses.empty()) publisher_->publish(live_message(news.poses, frames.base, frames.laser));
    for (const LiveCloud& cloud : news.clouds) publisher_->publish(live_message(cloud, frames.base));
    return {};
  }
  Result<void> write(const FollowedOffset& offset, std::int64_t stamp_ns) override {
    publisher_->publish(live_offset_message(offset.offset_s, stamp_ns));
    return {};
  }

 private:
  std::unique_ptr<LivePublisher> publisher_;
};

class ServedPublisher : public LivePublisher {
 public:
  explicit ServedPublisher(std::unique_ptr<ui::FoxgloveServer> server) : server_(std::move(server)) {}
  void publish(const LiveMessage& message) override {
    server_->publish(std::size_t(message.topic), message.stamp_ns, message.bytes);
  }

 private:
  std::unique_ptr<ui::FoxgloveServer> server_;
};

}  // namespace

std::unique_ptr<LiveOutput> live_lines() {
  return std::make_unique<LinesOutput>();
}

Result<std::unique_ptr<LiveOutput>> live_folder(const std::filesystem::path& folder) {
  std::error_code failed;
  if (!std::filesystem::create_directory(folder, failed))
    return failure(ExitCode::kWrongUsage,
                   fmt::format("{}: {}", folder.string(),
                               failed ? "cannot be made: " + failed.message() : "exists already"));
  return std::make_unique<FolderOutput>(folder);
}

std::unique_ptr<LiveOutput> live_published(std::unique_ptr<LivePublisher> publisher) {
  return std::make_unique<PublishedOutput>(std::move(publisher));
}

std::unique_ptr<LivePublisher> served_by(std::unique_ptr<ui::FoxgloveServer> server) {
  return std::make_unique<ServedPublisher>(std::move(server));
}

}  // namespace sweepscope::app
