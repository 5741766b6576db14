#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace sweepscope {

/// Where the system says how much memory there is; other places in tests.
struct MemorySources {
  std::filesystem::path meminfo = "/proc/meminfo";
  std::filesystem::path statm = "/proc/self/statm";
  std::filesystem::path cgroup = "/sys/fs/cgroup";
};

/// How much more memory this program may take before the system, its control group (version 1 or 2) or its
/// limit of address space (RLIMIT_AS) refuses it; none where the system does not say.
std::optional<std::uint64_t> available_memory_bytes(const MemorySources& sources = {});

/// The number behind a name in /proc/meminfo, in bytes.
std::optional<std::uint64_t> meminfo_bytes(std::string_view text, std::string_view name);

/// One sentence that says both numbers where `needed_bytes` are more than are available.
std::optional<std::string> memory_warning(const std::string& what, std::uint64_t needed_bytes,
                                          std::optional<std::uint64_t> available_bytes);

}  // namespace sweepscope
