#pragma once

#include "render/gl/context.hpp"
#include "render/images/image.hpp"

namespace sweepscope::gl {

/// An image as a texture of a context, which must outlive it.
class ShownImage {
 public:
  explicit ShownImage(Context& context) : context_(context) {}
  ~ShownImage();
  ShownImage(const ShownImage&) = delete;
  ShownImage& operator=(const ShownImage&) = delete;

  /// In place of the last one.
  void show(const Image& image);
  /// 0 before the first one. Its first row is at 0.
  unsigned handle() const { return texture_; }
  int width_px() const { return width_px_; }
  int height_px() const { return height_px_; }

 private:
  Context& context_;
  unsigned texture_ = 0;
  int width_px_ = 0, height_px_ = 0;
};

}  // namespace sweepscope::gl
