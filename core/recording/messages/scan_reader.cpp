#include "core/recording/messages/scan_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "core/recording/messages/message_archives.hpp"

namespace sweepscope {
namespace {

struct ScanType {
  std::string_view name;
  MessageKind kind;
};
constexpr ScanType kScanTypes[] = {{"sensor_msgs/LaserScan", MessageKind::kLaserScan},
                                   {"sensor_msgs/MultiEchoLaserScan", MessageKind::kMultiEcho}};

/// The number of the echo that is used, of at least one.
std::size_t chosen_echo(Echo echo, const PackedArray<float>& ranges_m,
                        const PackedArray<float>* intensities) {
  if (echo == Echo::kLast) return ranges_m.size() - 1;
  std::size_t strongest = 0;
  if (echo == Echo::kFirst || intensities == nullptr) return strongest;
  for (std::size_t i = 1; i < std::min(ranges_m.size(), intensities->size()); ++i)
    if ((*intensities)[i] > (*intensities)[strongest]) strongest = i;
  return strongest;
}

PackedArray<float> packed(const std::vector<float>& numbers) {
  return {std::as_bytes(std::span(numbers)), false};
}

}  // namespace

Result<ScanReader> ScanReader::by_definition(const MessageTopic& topic,
                                             const std::optional<std::string>& field, Echo echo) {
  auto layout = MessageLayout::parse(topic);
  if (!layout) return tl::unexpected(layout.error());
  std::vector<std::string> fields;
  for (const ScanType& scan : kScanTypes)
    for (std::string& name : layout->fields_of(scan.name)) fields.push_back(std::move(name));
  const std::string about = fmt::format("topic {} ({})", topic.name, topic.type);
  if (fields.empty())
    return unreadable(fmt::format("{} is neither a sensor_msgs/LaserScan nor holds one", about));
  if (!field && fields.size() > 1)
    return unreadable(
        fmt::format("{} holds several scans. Name one in a rig file (laser: {{topic: {}, field: {}}}, given "
                    "with --rig). Its scans: {}",
                    about, topic.name, fields.front(), fmt::join(fields, ", ")));
  const std::string name = field.value_or(fields.front());
  ScanReader reader(MessageKind::kLaserScan, topic.encoding, echo);
  reader.within_ = layout->find(name);
  const auto* const type = std::ranges::find_if(kScanTypes, [&](const ScanType& scan) {
    return reader.within_ && layout->is_single(*reader.within_) &&
           layout->is_message(*reader.within_, scan.name);
  });
  if (type == std::end(kScanTypes))
    return unreadable(fmt::format("{} has no scan \"{}\", the rig's laser.field. Its scans: {}", about, name,
                                  fmt::join(fields, ", ")));
  reader.kind_ = type->kind;
  reader.layout_ = std::move(*layout);
  return reader;
}

std::optional<ScanMessage> ScanReader::read(std::span<const std::byte> message) {
  if (within_) {
    constexpr std::size_t kIdentifier_bytes = 4;
    if (!layout_.read(message, *within_, found_) || found_.bytes.empty()) return std::nullopt;
    scan_bytes_.clear();
    if (encoding_ == Encoding::kCdr) scan_bytes_.assign(message.begin(), message.begin() + kIdentifier_bytes);
    scan_bytes_.insert(scan_bytes_.end(), found_.bytes.begin(), found_.bytes.end());
    message = scan_bytes_;
  }
  return kind_ == MessageKind::kMultiEcho ? read_echoes(message) : decode_laser_scan(encoding_, message);
}

std::optional<ScanMessage> ScanReader::read_echoes(std::span<const std::byte> message) {
  MessageReader reader(encoding_, message);
  ScanMessage scan;
  reader.header(scan.header_ns, scan.frame);
  reader.numbers(scan.angle_min_rad, scan.angle_max_rad, scan.angle_increment_rad, scan.time_increment_s,
                 scan.scan_time_s, scan.range_min_m, scan.range_max_m);
  const auto read_beams = [&](std::vector<PackedArray<float>>& beams) {
    beams.clear();
    reader.list(beams, [](MessageReader& of_beam, PackedArray<float>& echoes) { of_beam.array(echoes); });
  };
  read_beams(range_echoes_);
  read_beams(intensity_echoes_);
  if (!reader.at_end()) return std::nullopt;
  const bool strengths = intensity_echoes_.size() == range_echoes_.size();
  without_strength_ |= echo_ == Echo::kStrongest && !strengths;
  ranges_m_.clear();
  intensities_.clear();
  for (std::size_t i = 0; i < range_echoes_.size(); ++i) {
    const PackedArray<float>* const strength = strengths ? &intensity_echoes_[i] : nullptr;
    const bool any = range_echoes_[i].size() > 0;
    const std::size_t echo = any ? chosen_echo(echo_, range_echoes_[i], strength) : 0;
    ranges_m_.push_back(any ? range_echoes_[i][echo] : std::numeric_limits<float>::infinity());
    if (strengths) intensities_.push_back(echo < strength->size() ? (*strength)[echo] : 0);
  }
  scan.ranges_m = packed(ranges_m_);
  scan.intensities = packed(intensities_);
  return scan;
}

}  // namespace sweepscope
