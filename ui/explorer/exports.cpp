#include "ui/explorer/exports.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "core/io/atomic_file.hpp"
#include "render/images/transport_image.hpp"

namespace sweepscope::ui {
namespace {

constexpr const char* kExport = "export";
constexpr std::array<std::string_view, 16> kTypes{"png", "jpg",  "jpeg", "svg",  "pdf", "pcd",
                                                  "ply", "csv",  "json", "yaml", "yml", "html",
                                                  "bag", "mcap", "db3",  "tum"};

/// Without its dot, in small letters.
std::string type_of(const std::filesystem::path& file) {
  std::string type = file.extension().string();
  if (!type.empty()) type.erase(0, 1);
  std::ranges::transform(type, type.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return type;
}

}  // namespace

Result<void> check_type(const std::string& file, std::span<const std::string_view> types) {
  const std::string type = type_of(file);
  const bool is_other = std::ranges::find(types, type) == types.end();
  if (!is_other || std::ranges::find(kTypes, type) == kTypes.end()) return {};
  return failure(ExitCode::kWrongUsage, fmt::format("{}: this file is not written as .{}. Use .{}", file,
                                                    type, fmt::join(types, " or .")));
}

Result<void> write_picture(const Image& image, const std::filesystem::path& file) {
  constexpr int kQuality = 92;
  const std::string type = type_of(file);
  if (type != "jpg" && type != "jpeg") return write_png(image, file);
  return write_file(file, encode_jpeg(image, {0, 0, image.width_px, image.height_px}, kQuality));
}

void Exports::start(Export wanted) {
  background_.start(
      kExport, kExport, wanted.title,
      [this, write = std::move(wanted.write), done = std::move(wanted.done),
       file = std::move(wanted.file)](const Job& job) -> Background::Finish {
        const auto end = write(job);
        if (end) return [this, done, file] { written(file, done); };
        return [this, why = end.error()] {
          failure_ = why;
          messages_.error(why);
        };
      },
      std::move(wanted.steps));
}

void Exports::written(const std::filesystem::path& file, const std::string& message) const {
  messages_.note(message);
  if (wrote) wrote(file);
}

bool Exports::is_running() const {
  return background_.has(kExport);
}

}  // namespace sweepscope::ui
