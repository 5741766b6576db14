#include "render/vector/vector_file.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace sweepscope {

namespace {

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension;
}

}  // namespace

Result<void> check_picture_path(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".png" || extension == ".svg" || extension == ".pdf") return {};
  return failure(ExitCode::kWrongUsage,
                 fmt::format("{}: a picture is written as .png, .svg or .pdf", path.string()));
}

Result<void> write_picture(const std::filesystem::path& path, const Picture& picture,
                           std::span<const PngText> texts, Canvas& canvas) {
  if (auto checked = check_picture_path(path); !checked) return checked;
  const std::string extension = lower_extension(path);
  if (extension == ".svg") return write_svg(path, picture, texts);
  if (extension == ".pdf") return write_pdf(path, picture, texts);
  return canvas.draw(picture).and_then([&](const Image& image) { return write_png(image, path, texts); });
}

Result<void> write_picture(const std::filesystem::path& path, const Picture& picture,
                           std::span<const PngText> texts) {
  return make_canvas(Backend::kOffscreen).and_then([&](const std::unique_ptr<Canvas>& canvas) {
    return write_picture(path, picture, texts, *canvas);
  });
}

}  // namespace sweepscope
