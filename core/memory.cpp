#include "core/memory.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <fstream>

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The number that a text begins with; none of "max".
std::optional<std::uint64_t> number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [after, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() ? std::optional(value) : std::nullopt;
}

std::optional<std::uint64_t> left_of(std::optional<std::uint64_t> limit, std::optional<std::uint64_t> used) {
  if (!limit) return std::nullopt;
  return *limit - std::min(*limit, used.value_or(0));
}

std::optional<std::uint64_t> left_in_group(const fs::path& group) {
  if (const auto left =
          left_of(number(text_of(group / "memory.max")), number(text_of(group / "memory.current"))))
    return left;
  const fs::path version_1 = group / "memory";
  return left_of(number(text_of(version_1 / "memory.limit_in_bytes")),
                 number(text_of(version_1 / "memory.usage_in_bytes")));
}

std::optional<std::uint64_t> left_of_address_space(const fs::path& statm) {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return std::nullopt;
  const auto pages = number(text_of(statm));  // its first number is the whole address space
  return left_of(limit.rlim_cur, pages.value_or(0) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)));
}

}  // namespace

std::optional<std::uint64_t> meminfo_bytes(std::string_view text, std::string_view name) {
  constexpr std::uint64_t kKibibyte = 1024;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    if (!line.starts_with(name) || line.substr(name.size(), 1) != ":") continue;
    const std::size_t digit = line.find_first_of("0123456789");
    const auto kibibytes = digit == std::string_view::npos ? std::nullopt : number(line.substr(digit));
    return kibibytes ? std::optional(*kibibytes * kKibibyte) : std::nullopt;
  }
  return std::nullopt;
}

std::optional<std::uint64_t> available_memory_bytes(const MemorySources& sources) {
  std::optional<std::uint64_t> min;
  for (const auto& bytes : {meminfo_bytes(text_of(sources.meminfo), "MemAvailable"),
                            left_in_group(sources.cgroup), left_of_address_space(sources.statm)})
    if (bytes) min = std::min(min.value_or(*bytes), *bytes);
  return min;
}

std::optional<std::string> memory_warning(const std::string& what, std::uint64_t needed_bytes,
                                          std::optional<std::uint64_t> available_bytes) {
  constexpr double kGibibyte = 1024.0 * 1024 * 1024;
  if (!available_bytes || needed_bytes <= *available_bytes) return std::nullopt;
  return fmt::format("{} needs about {:.2g} GiB of memory, and {:.2g} GiB are available", what,
                     static_cast<double>(needed_bytes) / kGibibyte,
                     static_cast<double>(*available_bytes) / kGibibyte);
}

}  // namespace sweepscope
