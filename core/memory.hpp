#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace sweepscope {

/// The files in which the system reports its memory; others in tests.
struct MemorySources {
  std::filesystem::path meminfo = "/proc/meminfo";
  std::filesystem::path statm = "/proc/self/statm";
  std::filesystem::path cgroup = "/sys/fs/cgroup";
};

/// How much more memory this program may take before the system, its control group (version 1 or 2) or its
/// limit of address space (RLIMIT_AS) refuses it; empty if the system does not report it.
std::optional<std::uint64_t> available_memory_bytes(const MemorySources& sources = {});

/// The number behind a name in /proc/meminfo, in bytes.
std::optional<std::uint64_t> meminfo_bytes(std::string_view text, std::string_view name);

/// One sentence with both numbers if `needed_bytes` exceeds what is available.
std::optional<std::string> memory_warning(const std::string& what, std::uint64_t needed_bytes,
                                          std::optional<std::uint64_t> available_bytes);

}  // namespace sweepscope
