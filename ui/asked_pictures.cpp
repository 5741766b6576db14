#include "ui/asked_pictures.hpp"

#include <algorithm>
#include <utility>

#include "render/vector/vector_file.hpp"

namespace sweepscope::ui {
namespace {

void write_in_background(Explorer& explorer, const std::string& path,
                         std::function<Result<void>(const Job&)> write) {
  explorer.exports.start({.title = "Writing " + path,
                          .done = "The picture is saved in " + whole_path(path) + ".",
                          .file = path,
                          .write = std::move(write)});
}

Image part_of(const Image& image, const PixelRect& place) {
  Image part(static_cast<int>(place.width), static_cast<int>(place.height));
  for (int y = 0; y < part.height_px; ++y)
    std::copy_n(image.pixel(static_cast<int>(place.left), static_cast<int>(place.top) + y),
                Image::kChannels * static_cast<std::size_t>(part.width_px), part.pixel(0, y));
  return part;
}

}  // namespace

Result<void> AskedPictures::ask(const std::string& file, const std::string& what, const std::string& size) {
  if (auto right = check_type(file, kPictureTypes); !right) return right;
  if (!size.empty()) {
    if (what != "maps") return not_now("Only the maps can have a size: export-picture FILE maps 3840x2400");
    if (auto usable = parse_figure_size(size); !usable) return tl::unexpected(usable.error());
  }
  wait_for({file, what, size});
  return {};
}

Result<void> AskedPictures::ask_figure(const std::string& file, const std::string& size,
                                       const std::string& parts) {
  Asked asked{file, "", size.empty() ? kUsualFigureSize : size};
  asked.figure = true;
  if (auto right = check_picture_path(file); !right) return right;
  if (auto usable = parse_figure_size(asked.size); !usable) return tl::unexpected(usable.error());
  const auto shown = parts.empty() ? Result<FigureParts>(FigureParts()) : parse_figure_parts(parts);
  if (!shown) return tl::unexpected(shown.error());
  asked.parts = *shown;
  wait_for(std::move(asked));
  return {};
}

void AskedPictures::wait_for(Asked asked) {
  asked_ = std::move(asked);
  frames_to_wait_ = 2;
}

void AskedPictures::take(const std::function<Image()>& screenshot, const Frame& frame) {
  if (!asked_ || frames_to_wait_-- > 0 || !frame.is_whole) return;
  const Asked asked = *std::exchange(asked_, std::nullopt);
  if (!asked.size.empty() && explorer_.loaded() != nullptr) return write_maps(asked, frame.pane_aspect);
  Image image = screenshot();
  if (asked.what == "maps" && frame.maps) image = part_of(image, *frame.maps);
  write_in_background(explorer_, asked.file, [image = std::move(image), path = asked.file](const Job&) {
    return ui::write_picture(image, path);
  });
}

/// At a size of its own: drawn in the background, with a context of its own.
void AskedPictures::write_maps(const Asked& asked, double pane_aspect) {
  const auto [width_px, height_px] = *parse_figure_size(asked.size);
  auto picture = maps_picture(explorer_, width_px, height_px, pane_aspect, asked.parts);
  if (!picture) return explorer_.messages.error(picture.error());
  write_in_background(
      explorer_, asked.file,
      [picture = std::move(*picture), path = asked.file, figure = asked.figure](const Job&) -> Result<void> {
        if (figure) return sweepscope::write_picture(path, picture);
        return sweepscope::draw(picture).and_then(
            [&](const Image& image) { return ui::write_picture(image, path); });
      });
}

}  // namespace sweepscope::ui
