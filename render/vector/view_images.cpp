#include "render/vector/view_images.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>

namespace sweepscope {
namespace {

cairo_status_t read_some(void* rest, unsigned char* out, unsigned int length) {
  auto& bytes = *static_cast<std::string_view*>(rest);
  if (bytes.size() < length) return CAIRO_STATUS_READ_ERROR;
  std::memcpy(out, bytes.data(), length);
  bytes.remove_prefix(length);
  return CAIRO_STATUS_SUCCESS;
}

/// By way of PNG, which knows how the image's pixels are laid out.
Surface to_surface(const Image& image) {
  const std::string png = encode_png(image);
  std::string_view rest = png;
  return Surface(cairo_image_surface_create_from_png_stream(read_some, &rest));
}

Surface part_of(cairo_surface_t* whole, int left, int top, int width, int height) {
  Surface part(
      cairo_surface_create_similar_image(whole, cairo_image_surface_get_format(whole), width, height));
  cairo_t* painter = cairo_create(part.get());
  cairo_set_operator(painter, CAIRO_OPERATOR_SOURCE);
  cairo_set_source_surface(painter, whole, -left, -top);
  cairo_paint(painter);
  cairo_destroy(painter);
  return part;
}

/// Where the views lie in the picture: what is drawn of it. At least as large as a picture may be.
struct DrawnPart {
  int left = 0, top = 0, right = 0, bottom = 0;
};

DrawnPart drawn_part(const Picture& picture) {
  DrawnPart part{picture.width_px, picture.height_px, 0, 0};
  for (const View& view : picture.views) {
    part.left = std::min(part.left, static_cast<int>(std::floor(view.place.left)));
    part.top = std::min(part.top, static_cast<int>(std::floor(view.place.top)));
    part.right = std::max(part.right, static_cast<int>(std::ceil(view.place.right())));
    part.bottom = std::max(part.bottom, static_cast<int>(std::ceil(view.place.bottom())));
  }
  part.left = std::clamp(part.left, 0, picture.width_px - kMinPictureSidePx);
  part.top = std::clamp(part.top, 0, picture.height_px - kMinPictureSidePx);
  part.right = std::clamp(part.right, part.left + kMinPictureSidePx, picture.width_px);
  part.bottom = std::clamp(part.bottom, part.top + kMinPictureSidePx, picture.height_px);
  return part;
}

Picture scenes_of(const Picture& picture, const DrawnPart& part, int factor) {
  Picture scenes = picture;
  scenes.marks = {};
  scenes.width_px = factor * (part.right - part.left);
  scenes.height_px = factor * (part.bottom - part.top);
  for (View& view : scenes.views) {
    const PixelRect& place = view.place;
    view.place = {factor * (place.left - part.left), factor * (place.top - part.top), factor * place.width,
                  factor * place.height};
    for (CloudLayer& cloud : view.scene.clouds) cloud.point_size_px *= factor;
    if (view.scene.lighting) {
      view.scene.lighting->radius_px *= factor;
      view.scene.lighting->splat_px *= factor;
    }
    if (view.scene.grid) {
      view.scene.grid->line_px *= factor;
      view.scene.grid->text_px *= factor;
    }
    view.scene.paths.clear();  // flat_marks has them
    view.scene.scanner.reset();
    view.scene.labels.clear();
  }
  return scenes;
}

}  // namespace

Result<std::vector<ViewImage>> view_images(const Picture& picture) {
  if (auto usable = check_size(picture); !usable) return tl::unexpected(usable.error());
  std::vector<ViewImage> images;
  if (picture.views.empty()) return images;
  const int longest = std::max(picture.width_px, picture.height_px),
            factor = 2 * longest <= kMaxPictureSidePx ? 2 : 1;
  const DrawnPart part = drawn_part(picture);
  const Result<Image> drawn = draw(scenes_of(picture, part, factor));
  if (!drawn) return tl::unexpected(drawn.error());
  const Surface whole = to_surface(*drawn);
  for (const View& view : picture.views) {
    const auto in_image = [&](double px, int max_px) {
      return std::clamp(static_cast<int>(std::lround(factor * px)), 0, max_px);
    };
    const int left = in_image(view.place.left - part.left, drawn->width_px),
              right = in_image(view.place.right() - part.left, drawn->width_px),
              top = in_image(view.place.top - part.top, drawn->height_px),
              bottom = in_image(view.place.bottom() - part.top, drawn->height_px);
    if (left >= right || top >= bottom) continue;
    const double f = factor;
    images.push_back({{part.left + left / f, part.top + top / f, (right - left) / f, (bottom - top) / f},
                      part_of(whole.get(), left, top, right - left, bottom - top)});
  }
  return images;
}

}  // namespace sweepscope
