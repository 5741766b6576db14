#include "core/io/lzf.hpp"

namespace sweepscope {

std::optional<std::string> lzf_unpack(std::string_view packed, std::size_t unpacked_bytes) {
  // Three bytes unpack to 264 at the most, so a size beyond that is broken and not worth allocating.
  if (unpacked_bytes / 88 > packed.size()) return std::nullopt;
  std::string out;
  out.reserve(unpacked_bytes);
  std::size_t in = 0;
  const auto next = [&] { return static_cast<std::size_t>(static_cast<unsigned char>(packed[in++])); };
  while (in < packed.size()) {
    const std::size_t control = next();
    if (control < 32) {  // a run of literal bytes
      const std::size_t length = control + 1;
      if (length > packed.size() - in || length > unpacked_bytes - out.size()) return std::nullopt;
      out.append(packed.substr(in, length));
      in += length;
      continue;
    }
    std::size_t length = control >> 5;  // a copy of earlier output, which may overlap what it writes
    if (packed.size() - in < (length == 7 ? 2U : 1U)) return std::nullopt;
    if (length == 7) length += next();
    length += 2;
    const std::size_t distance = ((control & 31) << 8) + next() + 1;
    if (distance > out.size() || length > unpacked_bytes - out.size()) return std::nullopt;
    for (std::size_t i = 0; i < length; ++i) out.push_back(out[out.size() - distance]);
  }
  if (out.size() != unpacked_bytes) return std::nullopt;
  return out;
}

}  // namespace sweepscope
