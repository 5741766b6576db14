#include "ui/serve/uploads.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/io/atomic_file.hpp"
#include "core/io/printable_text.hpp"
#include "ui/serve/http/access.hpp"

namespace sweepscope::ui {
namespace {

constexpr std::size_t kMaxUploads = 2, kMaxName_bytes = 200;
constexpr std::chrono::minutes kUntilBegin(1);
constexpr std::uint64_t kKeptFree_bytes = std::uint64_t{256} << 20;  // a full disk stops a robot

tl::unexpected<Error> refused(const std::string& why) {
  return failure(ExitCode::kWrongUsage, why);
}

/// A name without folders, not hidden, and that shows what it is.
bool is_plain_name(const std::string& name) {
  return !name.empty() && name.size() <= kMaxName_bytes && name.front() != '.' &&
         name.find('/') == name.npos && printable_line(name) == name;
}

}  // namespace

Result<std::filesystem::path> Uploads::place_of(const UploadMessage& message) const {
  if (!is_plain_name(message.name))
    return refused("A file needs a plain name of at most 200 bytes that does not begin with a dot.");
  if (!roots_.limited()) return refused("This program was started without a folder for files (--root).");
  const std::filesystem::path folder = roots_.folders().front(), path = folder / message.name;
  std::error_code failed;
  if (std::filesystem::exists(std::filesystem::symlink_status(path, failed)))
    return refused(fmt::format("{} already exists. Open it with Ctrl-O.", message.name));
  if (!roots_.can_write(path)) return refused(fmt::format("{} cannot be written.", message.name));
  if (auto possible = check_writable(path); !possible) return refused(possible.error().message);
  const auto space = std::filesystem::space(folder, failed);
  if (failed) return refused(fmt::format("{}: {}", folder.string(), failed.message()));
  if (message.size_bytes > space.available || space.available - message.size_bytes < kKeptFree_bytes)
    return refused(fmt::format("{} has {:.1f} MB and would not leave 256 MB free: {} has {:.1f} MB free.",
                               message.name, static_cast<double>(message.size_bytes) / 1e6, folder.string(),
                               static_cast<double>(space.available) / 1e6));
  return path;
}

Result<std::string> Uploads::announce(int viewer, const UploadMessage& message, Time now) {
  std::erase_if(announced_, [&](const Announced& one) { return !one.running && now >= one.expires; });
  auto path = place_of(message);
  if (!path) return tl::unexpected(path.error());
  for (const Announced& one : announced_)
    if (one.upload.path == *path) return refused(fmt::format("{} is already being sent.", message.name));
  if (announced_.size() >= kMaxUploads)
    return refused("Two files are already being sent. Wait until they have arrived.");
  announced_.push_back({{random_token(), viewer, std::move(*path), message.size_bytes}, now + kUntilBegin});
  return announced_.back().upload.id;
}

std::optional<Upload> Uploads::begin(std::string_view id, Time now) {
  Announced* found = nullptr;
  for (Announced& one : announced_)
    if (equal_in_constant_time(id, one.upload.id)) found = &one;
  if (found == nullptr || found->running || now >= found->expires) return std::nullopt;
  found->running = true;
  return found->upload;
}

void Uploads::end(const std::string& id) {
  std::erase_if(announced_, [&](const Announced& one) { return one.upload.id == id; });
}

}  // namespace sweepscope::ui
