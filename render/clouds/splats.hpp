#pragma once

class vtkActor;
class vtkPolyDataMapper;

namespace sweepscope {

/// The sizes of points that grow where they are sparse.
struct SplatSizes {
  double px_per_m = 1;  // at a distance of 1 m in perspective, everywhere in a parallel projection
  double min_px = 1, max_px = 1;

  bool operator==(const SplatSizes&) const = default;
};

/// The size that a picture's points grow to at most, by their usual size.
constexpr double kMaxSplatGrowth = 3;

/// Prepares an actor whose points have a spacing (to_polydata): a point becomes as large as its spacing.
void add_splats(vtkActor& actor, vtkPolyDataMapper& mapper);
void set_splat_sizes(vtkActor& actor, const SplatSizes& sizes);

/// While it lives, the actors' own sizes apply in the current context. Other points have no size then.
class SplatsOn {
 public:
  explicit SplatsOn(bool on);
  ~SplatsOn();
  SplatsOn(const SplatsOn&) = delete;
  SplatsOn& operator=(const SplatsOn&) = delete;

 private:
  bool on_;
};

}  // namespace sweepscope
