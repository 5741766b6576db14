#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "render/gl/context.hpp"
#include "render/images/image.hpp"
#include "render/pictures/picture.hpp"

namespace sweepscope {

/// Points with their colours, in the order in which they are drawn.
struct LivePoints {
  std::vector<std::array<float, 3>> xyz_m;
  std::vector<std::array<std::uint8_t, 3>> rgb;
  std::vector<float> spacing_m;  // of each point, for splats (spacing_of); empty: all are of one size

  std::size_t size() const { return xyz_m.size(); }
};
using LivePointsPtr = std::shared_ptr<const LivePoints>;

/// A cloud that is drawn interactively, into textures of a context that is shared with windows. While
/// something moves it draws only the coarse points; at rest it adds all points in slices, so that no call
/// takes long. The same state gives the same pixels for any slices, and a texture holds a whole picture at
/// every moment: slices are collected out of sight.
class LiveView {
 public:
  enum class Points { kCoarse, kAll };

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
  /// How points are lit; without lighting they keep their colours.
  void set_lighting(const std::optional<Lighting>& lighting);
  /// Points that have a spacing grow where they are sparse.
  void set_splats(bool on);
  /// The textures have alpha 0 where no point is, for what is drawn below them.
  void set_transparent(bool on);
  /// Coarse points only.
  void set_moving(bool moving);

  /// Draws what is not drawn yet: the coarse points at once, then all points for about `budget_s`; at least a
  /// slice of them where the coarse points are drawn already.
  void draw(double budget_s);
  /// Whether everything is drawn that is to be drawn now: while something moves, the coarse points.
  bool done() const;
  /// Whether the picture of all points is there, for what is shown now.
  bool has_all_points() const;

  /// An OpenGL texture with the picture of these points; its first row is the lowest. The coarse points'
  /// where there is no picture of all points yet; 0 before the first drawing.
  unsigned texture(Points points) const;
  /// That picture, read back.
  Image picture(Points points) const;
  int width_px() const;
  int height_px() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace sweepscope
