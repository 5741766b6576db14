// Clouds of 3D scanners: the first byte chooses the encoding and the message's type, the rest are messages of
// a few hundred bytes each, one after the other, to one reader.
#include "core/recording/messages/point_cloud.hpp"

#include "tests/fuzz/memory_file.hpp"

int fuzz_point_cloud(const std::uint8_t* bytes, std::size_t size) {
  if (size < 4) return 0;
  const auto encoding = bytes[0] % 2 == 0 ? sweepscope::Encoding::kRos1 : sweepscope::Encoding::kCdr;
  const std::size_t most = 1 + bytes[1] + 256U * bytes[2];
  std::span<const std::byte> rest = std::as_bytes(std::span(bytes + 3, size - 3));
  sweepscope::CloudReader reader;
  sweepscope::RawLaser laser;
  for (std::int64_t time_ns = 0; !rest.empty(); time_ns += 100'000'000) {
    const std::span<const std::byte> message = rest.first(std::min(rest.size(), most));
    const std::size_t lines_before = laser.scans.size();
    const auto cloud = (bytes[0] & 2) == 0 ? sweepscope::decode_cloud(encoding, message)
                                           : sweepscope::decode_livox(encoding, message);
    if (!reader.add(cloud, time_ns, laser) && laser.scans.size() != lines_before)
      __builtin_trap();  // nothing is added where it refuses
    rest = rest.subspan(message.size());
  }
  for (const sweepscope::RawScan& scan : laser.scans)
    if (scan.first_range + scan.beams > laser.ranges_m.size()) __builtin_trap();
  return 0;
}
