#include "core/simulation/scenes/people.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/simulation/math/portable_math.hpp"

namespace sweepscope::simulation {
namespace {

constexpr std::uint64_t kPeoplePurpose = 11;
constexpr int kTries = 2000;    // for each
constexpr double kReach_m = 6;  // from the rig to a circle's middle
constexpr double kToSurface_m = 0.3, kToRig_m = 0.5;
constexpr double kDeepestFloor_m = 4;  // below the rig

Person random_person(Random& random, const std::function<Vector3d(double t_s)>& rig_at, double duration_s) {
  const Vector3d rig_m = rig_at(duration_s * random.uniform());
  const double x = kReach_m * (2 * random.uniform() - 1), y = kReach_m * (2 * random.uniform() - 1);
  Person person;
  person.middle_m = rig_m.head<2>() + Vector2d(x, y);
  person.circle_m = 0.4 + 2.6 * random.uniform() * random.uniform();
  person.phase_rad = 2 * kPi * random.uniform();
  person.clockwise = random.uniform() < 0.5;
  person.floor_m = rig_m.z();  // until the floor is known
  return person;
}

/// The lowest surface under the circle, seen from the rig's height: what stands on the floor is to be met,
/// not walked upon. None where there is no floor.
std::optional<double> floor_under(const Person& person, const RayCaster& scene, double rig_height_m) {
  const double lap_s = 2 * kPi * person.circle_m / Person::kSpeed_mps;
  double drop_m = 0;
  for (int i = 0; i < 8; ++i) {
    const Vector2d at = person.at(lap_s * i / 8);
    const auto hit = scene.cast({at.x(), at.y(), rig_height_m}, -Vector3d::UnitZ(), kDeepestFloor_m);
    if (!hit) return std::nullopt;
    drop_m = std::max(drop_m, hit->range_m);
  }
  return rig_height_m - drop_m;
}

/// Whether nothing of the scene is in the way of the circle.
bool has_room(const Person& person, const RayCaster& scene) {
  const double lap_s = 2 * kPi * person.circle_m / Person::kSpeed_mps;
  const int steps = static_cast<int>(std::ceil(lap_s / 0.1));
  for (int i = 0; i < steps; ++i) {
    const Vector2d at = person.at(lap_s * i / steps);
    for (const double height_m : {0.4, 0.9, 1.4})
      if (scene.distance_m({at.x(), at.y(), person.floor_m + height_m}, kToSurface_m)) return false;
  }
  return true;
}

bool meets_rig(const Person& person, const std::function<Vector3d(double t_s)>& rig_at, double duration_s) {
  constexpr double kStep_s = 0.05;
  for (double t_s = 0; t_s <= duration_s; t_s += kStep_s)
    if ((rig_at(t_s).head<2>() - person.at(t_s)).norm() < kToRig_m + Person::kRadius_m) return true;
  return false;
}

}  // namespace

Vector2d Person::at(double t_s) const {
  const double turned_rad = kSpeed_mps / circle_m * t_s;
  const SinCos angle = sin_cos(phase_rad + (clockwise ? -turned_rad : turned_rad));
  return middle_m + circle_m * Vector2d(angle.cos, angle.sin);
}

std::optional<Hit> Person::cast(const Vector3d& origin, const Vector3d& direction, double t_s) const {
  const Vector2d from = origin.head<2>() - at(t_s), along = direction.head<2>();
  const double head_m = floor_m + kHeight_m;
  const auto hit = [](double range_m, const Vector3d& normal, const Vector3d& beam) {
    return Hit{range_m, std::abs(normal.dot(beam)), 0.5, normal};
  };
  if (direction.z() < 0 && origin.z() > head_m) {
    const double range_m = (head_m - origin.z()) / direction.z();
    if ((from + range_m * along).squaredNorm() <= kRadius_m * kRadius_m)
      return hit(range_m, Vector3d::UnitZ(), direction);
  }
  const double a = along.squaredNorm(), b = from.dot(along), c = from.squaredNorm() - kRadius_m * kRadius_m;
  const double under_root = b * b - a * c;
  if (!(a > 0) || under_root <= 0 || b >= 0 || c <= 0) return std::nullopt;
  const double range_m = (-b - std::sqrt(under_root)) / a;
  const double z_m = origin.z() + range_m * direction.z();
  if (z_m < floor_m || z_m > head_m) return std::nullopt;
  const Vector2d out = (from + range_m * along) / kRadius_m;
  return hit(range_m, {out.x(), out.y(), 0}, direction);
}

Result<std::vector<Person>> place_people(int count, std::uint64_t seed, const RayCaster& scene,
                                         const std::function<Vector3d(double t_s)>& rig_at,
                                         double duration_s) {
  std::vector<Person> people;
  for (int number = 0; number < count; ++number) {
    Random random(seed, kPeoplePurpose, static_cast<std::uint64_t>(number));
    std::optional<Person> found;
    for (int i = 0; i < kTries && !found; ++i) {
      Person person = random_person(random, rig_at, duration_s);
      const auto floor_m = floor_under(person, scene, person.floor_m);
      if (!floor_m) continue;
      person.floor_m = *floor_m;
      if (has_room(person, scene) && !meets_rig(person, rig_at, duration_s)) found = person;
    }
    if (!found)
      return failure(ExitCode::kWrongUsage, fmt::format("the scene has no room for person {} of {}: every "
                                                        "circle that was tried meets a surface or the rig",
                                                        number + 1, count));
    people.push_back(*found);
  }
  return people;
}

}  // namespace sweepscope::simulation
