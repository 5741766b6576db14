#include "core/simulation/meshes/ray_caster.hpp"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <vector>

namespace sweepscope::simulation {
namespace {

constexpr unsigned kNone = std::numeric_limits<unsigned>::max();

/// A triangle made ready to be met: one corner, two sides, and their cross product.
struct Facet {
  Vector3d corner, side_u, side_v, normal;
  double albedo = 0.5;
};

/// What the callback needs beside Embree's single-precision ray; `embree` comes first so that its address is
/// ours.
struct Query {
  RTCIntersectContext embree;
  const std::vector<Facet>* facets = nullptr;
  Vector3d origin, direction;
  double range_m = 0;
  unsigned facet = kNone;
};

void bounds_of(const RTCBoundsFunctionArguments* arguments) {
  constexpr double kMargin_m = 2e-3;  // far above single precision's error over a scene's extent
  const Facet& facet =
      (*static_cast<const std::vector<Facet>*>(arguments->geometryUserPtr))[arguments->primID];
  const Vector3d b = facet.corner + facet.side_u, c = facet.corner + facet.side_v;
  const Vector3d low = facet.corner.cwiseMin(b).cwiseMin(c).array() - kMargin_m;
  const Vector3d high = facet.corner.cwiseMax(b).cwiseMax(c).array() + kMargin_m;
  RTCBounds& bounds = *arguments->bounds_o;
  bounds.lower_x = static_cast<float>(low.x());
  bounds.lower_y = static_cast<float>(low.y());
  bounds.lower_z = static_cast<float>(low.z());
  bounds.upper_x = static_cast<float>(high.x());
  bounds.upper_y = static_cast<float>(high.y());
  bounds.upper_z = static_cast<float>(high.z());
}

/// Moeller and Trumbore's test. The rim is widened by 1e-9 of a side, so that no beam slips between
/// neighbours.
std::optional<double> range_to(const Facet& facet, const Vector3d& origin, const Vector3d& direction) {
  constexpr double kRim = 1e-9;
  const double determinant = -facet.normal.dot(direction);
  if (determinant == 0) return std::nullopt;
  const Vector3d from_corner = origin - facet.corner;
  const Vector3d q = from_corner.cross(direction);
  const double u = facet.side_v.dot(q) / determinant;
  const double v = -facet.side_u.dot(q) / determinant;
  if (!(u >= -kRim && v >= -kRim && u + v <= 1 + kRim)) return std::nullopt;
  return facet.normal.dot(from_corner) / determinant;
}

void meet(const RTCIntersectFunctionNArguments* arguments) {
  if (arguments->valid[0] == 0) return;
  Query& query = *reinterpret_cast<Query*>(arguments->context);
  const std::optional<double> range_m =
      range_to((*query.facets)[arguments->primID], query.origin, query.direction);
  if (!range_m || *range_m <= 0) return;
  if (*range_m > query.range_m || (*range_m == query.range_m && arguments->primID > query.facet)) return;
  query.range_m = *range_m;
  query.facet = arguments->primID;
  // A little beyond, so that triangles at nearly the same range are offered as well.
  constexpr double kMargin_m = 2e-3;
  RTCRayHit& ray = *reinterpret_cast<RTCRayHit*>(arguments->rayhit);
  ray.ray.tfar = static_cast<float>(*range_m + kMargin_m);
  ray.hit.geomID = arguments->geomID;
  ray.hit.primID = arguments->primID;
}

/// The point of a triangle that is nearest to p, by the regions of its plane (Ericson, Real-Time Collision
/// Detection, 5.1.5).
Vector3d nearest_point(const Facet& facet, const Vector3d& p) {
  const Vector3d &ab = facet.side_u, &ac = facet.side_v;
  const Vector3d from_a = p - facet.corner;
  const double d1 = ab.dot(from_a), d2 = ac.dot(from_a);
  if (d1 <= 0 && d2 <= 0) return facet.corner;
  const Vector3d from_b = from_a - ab;
  const double d3 = ab.dot(from_b), d4 = ac.dot(from_b);
  if (d3 >= 0 && d4 <= d3) return facet.corner + ab;
  const double beside_ab = d1 * d4 - d3 * d2;
  if (beside_ab <= 0 && d1 >= 0 && d3 <= 0) return facet.corner + d1 / (d1 - d3) * ab;
  const Vector3d from_c = from_a - ac;
  const double d5 = ab.dot(from_c), d6 = ac.dot(from_c);
  if (d6 >= 0 && d5 <= d6) return facet.corner + ac;
  const double beside_ac = d5 * d2 - d1 * d6;
  if (beside_ac <= 0 && d2 >= 0 && d6 <= 0) return facet.corner + d2 / (d2 - d6) * ac;
  const double beside_bc = d3 * d6 - d5 * d4;
  if (beside_bc <= 0 && d4 >= d3 && d5 >= d6)
    return facet.corner + ab + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (ac - ab);
  const double sum = beside_bc + beside_ac + beside_ab;
  return facet.corner + beside_ac / sum * ab + beside_ab / sum * ac;
}

struct NearestQuery {
  const std::vector<Facet>* facets;
  Vector3d point_m;
  double distance_m;
};

bool come_near(RTCPointQueryFunctionArguments* arguments) {
  NearestQuery& query = *static_cast<NearestQuery*>(arguments->userPtr);
  const Vector3d nearest = nearest_point((*query.facets)[arguments->primID], query.point_m);
  const double distance_m = (nearest - query.point_m).norm();
  if (distance_m >= query.distance_m) return false;
  query.distance_m = distance_m;
  constexpr double kMargin_m = 2e-3;
  arguments->query->radius = static_cast<float>(distance_m + kMargin_m);
  return true;
}

struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};

}  // namespace

struct RayCaster::Implementation {
  std::vector<Facet> facets;
  std::unique_ptr<RTCDeviceTy, Release> device;
  std::unique_ptr<RTCSceneTy, Release> scene;
};

RayCaster::RayCaster(const Mesh& mesh) : implementation_(std::make_unique<Implementation>()) {
  Implementation& self = *implementation_;
  for (const Triangle& t : mesh.triangles) {
    const Vector3d u = t.b - t.a, v = t.c - t.a;
    self.facets.push_back({t.a, u, v, u.cross(v), t.albedo});
  }
  self.device.reset(rtcNewDevice("threads=1"));
  if (self.device == nullptr) throw std::runtime_error("Embree cannot be started on this machine");
  self.scene.reset(rtcNewScene(self.device.get()));
  rtcSetSceneFlags(self.scene.get(), RTC_SCENE_FLAG_ROBUST);
  const RTCGeometry geometry = rtcNewGeometry(self.device.get(), RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(self.facets.size()));
  rtcSetGeometryUserData(geometry, &self.facets);
  rtcSetGeometryBoundsFunction(geometry, bounds_of, nullptr);
  rtcSetGeometryIntersectFunction(geometry, meet);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(self.scene.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(self.scene.get());
}

RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;

std::optional<Hit> RayCaster::cast(const Vector3d& origin, const Vector3d& direction,
                                   double max_range_m) const {
  Query query;
  rtcInitIntersectContext(&query.embree);
  query.facets = &implementation_->facets;
  query.origin = origin;
  query.direction = direction;
  query.range_m = max_range_m;
  RTCRayHit ray{};
  ray.ray.org_x = static_cast<float>(origin.x());
  ray.ray.org_y = static_cast<float>(origin.y());
  ray.ray.org_z = static_cast<float>(origin.z());
  ray.ray.dir_x = static_cast<float>(direction.x());
  ray.ray.dir_y = static_cast<float>(direction.y());
  ray.ray.dir_z = static_cast<float>(direction.z());
  ray.ray.tfar = static_cast<float>(max_range_m) * 1.001F;
  ray.ray.mask = kNone;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(implementation_->scene.get(), &query.embree, &ray);
  if (query.facet == kNone) return std::nullopt;
  const Facet& facet = implementation_->facets[query.facet];
  const double area = facet.normal.norm();
  return Hit{query.range_m, std::abs(facet.normal.dot(direction)) / area, facet.albedo, facet.normal / area};
}

std::optional<double> RayCaster::distance_m(const Vector3d& point_m, double within_m) const {
  NearestQuery nearest{&implementation_->facets, point_m, within_m};
  RTCPointQuery query{};
  query.x = static_cast<float>(point_m.x());
  query.y = static_cast<float>(point_m.y());
  query.z = static_cast<float>(point_m.z());
  query.radius = static_cast<float>(within_m * 1.001 + 1e-3);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(implementation_->scene.get(), &query, &context, come_near, &nearest);
  if (nearest.distance_m >= within_m) return std::nullopt;
  return nearest.distance_m;
}

Eigen::AlignedBox3d RayCaster::bounds_m() const {
  Eigen::AlignedBox3d box;
  for (const Facet& facet : implementation_->facets)
    box.extend(facet.corner).extend(facet.corner + facet.side_u).extend(facet.corner + facet.side_v);
  return box;
}

}  // namespace sweepscope::simulation
