// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "meshes.h"
#include "mrpt_terrain/core/random.h"
#include "mrpt_terrain/sim/ray_caster.h"

/// \file
/// What rays meet, without a tree and in double precision: convex solids as half-spaces in closed
/// form, and meshes triangle by triangle.
namespace mrpt_terrain::worlds {

inline constexpr double kNoHit = std::numeric_limits<double>::infinity();

struct Ray {
  Eigen::Vector3d origin, direction;
};

inline void add_ray(sim::Rays& rays, const Ray& ray) {
  rays.origin_x.push_back(ray.origin.x());
  rays.origin_y.push_back(ray.origin.y());
  rays.origin_z.push_back(ray.origin.z());
  rays.direction_x.push_back(ray.direction.x());
  rays.direction_y.push_back(ray.direction.y());
  rays.direction_z.push_back(ray.direction.z());
}

/// Uniform over a box.
[[nodiscard]] inline Eigen::Vector3d random_point(RandomGenerator& random,
                                                  const Eigen::Vector3d& low,
                                                  const Eigen::Vector3d& high) {
  const Eigen::Vector3d share(random.uniform(), random.uniform(), random.uniform());
  return low + share.cwiseProduct(high - low);
}

/// Uniform over the unit sphere.
[[nodiscard]] inline Eigen::Vector3d random_direction(RandomGenerator& random) {
  const double z = 2.0 * random.uniform() - 1.0, angle = 2.0 * M_PI * random.uniform();
  const double level = std::sqrt(std::max(0.0, 1.0 - z * z));
  return {level * std::cos(angle), level * std::sin(angle), z};
}

/// All p with normal . p <= bound for each face; normals are unit vectors.
struct ConvexSolid {
  struct Face {
    Eigen::Vector3d normal;
    double bound;
  };
  std::vector<Face> faces;
};

struct SolidHit {
  double range = kNoHit;
  int solid = -1;
  int face = -1;
};

/// First solid that a ray enters; solids it starts in are left out. With `grown` all faces are
/// moved outwards by so many metres.
[[nodiscard]] inline SolidHit cast_solids(const std::vector<ConvexSolid>& solids, const Ray& ray,
                                          double grown = 0.0) {
  SolidHit hit;
  for (std::size_t s = 0; s < solids.size(); ++s) {
    double enter = 0.0, leave = kNoHit;
    int enter_face = -1;
    for (std::size_t f = 0; f < solids[s].faces.size(); ++f) {
      const auto& face = solids[s].faces[f];
      const double room = face.bound + grown - face.normal.dot(ray.origin);
      const double rate = face.normal.dot(ray.direction);
      if (rate > 0.0) leave = std::min(leave, room / rate);
      if (rate == 0.0 && room < 0.0) leave = -1.0;
      if (rate < 0.0 && room / rate > enter) {
        enter = room / rate;
        enter_face = static_cast<int>(f);
      }
    }
    if (enter_face >= 0 && enter <= leave && enter < hit.range) {
      hit = {enter, static_cast<int>(s), enter_face};
    }
  }
  return hit;
}

/// Box, or wedge: a box whose top rises along x from an edge on its floor.
/// Origin at the middle of its floor.
struct Block {
  Eigen::Isometry3d pose;
  double length, width, height;
  bool wedge;

  [[nodiscard]] ConvexSolid solid() const {
    const double x = 0.5 * length, y = 0.5 * width;
    std::vector<std::pair<Eigen::Vector3d, double>> own{
        {{1, 0, 0}, x}, {{0, 1, 0}, y}, {{0, -1, 0}, y}, {{0, 0, -1}, 0.0}};
    if (wedge) {
      const Eigen::Vector3d normal = Eigen::Vector3d(-height, 0.0, length).normalized();
      own.emplace_back(normal, normal.dot(Eigen::Vector3d(-x, 0, 0)));
    } else {
      own.emplace_back(Eigen::Vector3d(-1, 0, 0), x);
      own.emplace_back(Eigen::Vector3d(0, 0, 1), height);
    }
    ConvexSolid result;
    for (const auto& [normal, bound] : own) {
      const Eigen::Vector3d turned = pose.linear() * normal;
      result.faces.push_back({turned, bound + turned.dot(pose.translation())});
    }
    return result;
  }

  void add_to(sim::Mesh& mesh, std::int32_t index) const {
    const double x = 0.5 * length, y = 0.5 * width;
    const double front = wedge ? 0.0 : height;
    const auto at = [&](double px, double py, double pz) -> Eigen::Vector3d {
      return pose * Eigen::Vector3d(px, py, pz);
    };
    const auto quad = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                          const Eigen::Vector3d& c, const Eigen::Vector3d& d) {
      add_triangle(mesh, a, b, c, index, sim::SurfaceKind::kObject);
      add_triangle(mesh, a, c, d, index, sim::SurfaceKind::kObject);
    };
    quad(at(-x, -y, front), at(x, -y, height), at(x, y, height), at(-x, y, front));
    quad(at(-x, -y, 0), at(-x, y, 0), at(x, y, 0), at(x, -y, 0));
    quad(at(x, -y, 0), at(x, y, 0), at(x, y, height), at(x, -y, height));
    if (wedge) {
      add_triangle(mesh, at(-x, -y, 0), at(x, -y, 0), at(x, -y, height), index,
                   sim::SurfaceKind::kObject);
      add_triangle(mesh, at(-x, y, 0), at(x, y, height), at(x, y, 0), index,
                   sim::SurfaceKind::kObject);
      return;
    }
    quad(at(-x, -y, 0), at(x, -y, 0), at(x, -y, height), at(-x, -y, height));
    quad(at(-x, y, 0), at(-x, y, height), at(x, y, height), at(x, y, 0));
    quad(at(-x, -y, 0), at(-x, -y, height), at(-x, y, height), at(-x, y, 0));
  }
};

struct TriangleHit {
  double range = kNoHit;
  std::size_t triangle = 0;
  /// Whether no triangle's edge passes the ray so closely that single precision may take it for
  /// the other side.
  bool clear = true;
};

/// All triangles, one after the other (Moeller and Trumbore 1997).
[[nodiscard]] inline TriangleHit cast_triangles(const sim::Mesh& mesh, const Ray& ray) {
  constexpr double kClear = 1e-4;
  TriangleHit hit;
  for (std::size_t t = 0; t < mesh.size(); ++t) {
    const auto& corner = mesh.triangles[t];
    const Eigen::Vector3d a = mesh.vertices[corner[0]];
    const Eigen::Vector3d u = mesh.vertices[corner[1]] - a, v = mesh.vertices[corner[2]] - a;
    const Eigen::Vector3d p = ray.direction.cross(v);
    const double determinant = u.dot(p);
    if (determinant == 0.0) continue;
    const Eigen::Vector3d s = ray.origin - a;
    const double first = s.dot(p) / determinant;
    const double second = ray.direction.dot(s.cross(u)) / determinant;
    const double range = v.dot(s.cross(u)) / determinant;
    const double inside = std::min({first, second, 1.0 - first - second});
    if (std::abs(inside) < kClear) hit.clear = false;
    if (inside >= 0.0 && range > 0.0 && range < hit.range) {
      hit.range = range;
      hit.triangle = t;
    }
  }
  return hit;
}

}  // namespace mrpt_terrain::worlds
