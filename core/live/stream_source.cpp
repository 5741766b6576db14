#include "core/live/stream_source.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>

namespace sweepscope {
namespace {

constexpr std::size_t kLongestLine_bytes = std::size_t{1} << 26;

}  // namespace

StreamSource::StreamSource(int descriptor, std::string name, const Rig& rig)
    : descriptor_(descriptor), name_(std::move(name)), stream_(name_, rig) {}

Result<bool> StreamSource::listen(std::chrono::milliseconds max_wait) {
  pollfd ready{descriptor_, POLLIN, 0};
  const int count = poll(&ready, 1, static_cast<int>(max_wait.count()));
  if (count == 0 || (count < 0 && errno == EINTR)) return true;
  std::array<char, 1 << 16> bytes;
  const ssize_t got = count < 0 ? -1 : read(descriptor_, bytes.data(), bytes.size());
  if (got < 0) {
    if (errno == EINTR || errno == EAGAIN) return true;
    return unreadable(fmt::format("{}: cannot be read: {}", name_, std::strerror(errno)));
  }
  pending_.append(bytes.data(), static_cast<std::size_t>(got));
  if (got == 0 && !pending_.empty()) pending_ += '\n';
  if (auto taken = take_lines(); !taken) return tl::unexpected(taken.error());
  return got > 0;
}

Result<void> StreamSource::take_lines() {
  std::size_t begin = 0;
  for (std::size_t end = searched_; (end = pending_.find('\n', end)) != std::string::npos; begin = ++end) {
    if (auto taken = stream_.take(std::string_view(pending_).substr(begin, end - begin)); !taken)
      return taken;
  }
  pending_.erase(0, begin);
  searched_ = pending_.size();
  if (pending_.size() > kLongestLine_bytes)
    return unreadable(fmt::format("{}: a line is longer than {} bytes", name_, kLongestLine_bytes));
  return {};
}

}  // namespace sweepscope
