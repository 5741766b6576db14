#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "render/gl/context.hpp"
#include "render/images/image.hpp"
#include "render/pictures/picture.hpp"

namespace sweepscope {

/// Points with their colours, in the order in which they are drawn.
struct LivePoints {
  std::vector<std::array<float, 3>> xyz_m;
  std::vector<std::array<std::uint8_t, 3>> rgb;

  std::size_t size() const { return xyz_m.size(); }
};
using LivePointsPtr = std::shared_ptr<const LivePoints>;

/// A cloud that is drawn interactively, into a texture of a context that is shared with windows. While
/// something moves it draws only the coarse points; at rest it adds all points in slices, so that no call
/// takes long. The same state gives the same pixels for any slices.
class LiveView {
 public:
  /// The context must outlive it.
  explicit LiveView(gl::Context& context);
  ~LiveView();
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  void resize(int width_px, int height_px);
  /// Either may be null. No effect if they are already shown.
  void show(LivePointsPtr coarse, LivePointsPtr full);
  void set_camera(const Camera& camera);
  void set_point_size(double size_px);
  void set_background(Colour colour);
  /// Coarse points only.
  void set_moving(bool moving);

  /// Draws what is not drawn yet, for at most about `budget_s`.
  void draw(double budget_s);
  /// Whether everything is drawn.
  bool done() const;

  /// An OpenGL texture with the picture; its first row is the lowest.
  unsigned texture() const;
  int width_px() const;
  int height_px() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace sweepscope
