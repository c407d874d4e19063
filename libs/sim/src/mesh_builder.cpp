// SPDX-License-Identifier: BSD-3-Clause
#include "mesh_builder.h"

#include <cmath>

namespace mrpt_terrain::sim {

void MeshBuilder::add_triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                               const Eigen::Vector3d& c, SurfaceKind kind) {
  const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
  mesh_.vertices.insert(mesh_.vertices.end(), {a, b, c});
  mesh_.triangles.push_back({first, first + 1, first + 2});
  mesh_.solid.push_back(solid_);
  mesh_.kind.push_back(kind);
}

void MeshBuilder::add_quad(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                           const Eigen::Vector3d& c, const Eigen::Vector3d& d, SurfaceKind kind) {
  add_triangle(a, b, c, kind);
  add_triangle(a, c, d, kind);
}

void MeshBuilder::add_box(const Eigen::Isometry3d& T_map_box, const Eigen::Vector3d& size,
                          SurfaceKind top) {
  add_profile(T_map_box, {{-size.x() / 2, size.z()}, {size.x() / 2, size.z()}}, size.y(), 0.0, top);
}

void MeshBuilder::add_prism(const Eigen::Isometry3d& T_map_prism, double radius_x, double radius_y,
                            double height, int facets) {
  const auto corner = [&](int k, double z) -> Eigen::Vector3d {
    const double angle = 2.0 * M_PI * (k % facets) / facets;
    return T_map_prism * Eigen::Vector3d(radius_x * std::cos(angle), radius_y * std::sin(angle), z);
  };
  const Eigen::Vector3d foot = T_map_prism.translation();
  const Eigen::Vector3d head = T_map_prism * Eigen::Vector3d(0.0, 0.0, height);
  for (int k = 0; k < facets; ++k) {
    add_quad(corner(k, 0.0), corner(k + 1, 0.0), corner(k + 1, height), corner(k, height),
             SurfaceKind::kObject);
    add_triangle(head, corner(k, height), corner(k + 1, height), SurfaceKind::kObject);
    add_triangle(foot, corner(k + 1, 0.0), corner(k, 0.0), SurfaceKind::kObject);
  }
}

void MeshBuilder::add_profile(const Eigen::Isometry3d& T_map_profile, const Profile& profile,
                              double width, double bottom, SurfaceKind top) {
  const auto point = [&](double x, double side, double z) -> Eigen::Vector3d {
    return T_map_profile * Eigen::Vector3d(x, side * width / 2, z);
  };
  const auto end_face = [&](const Eigen::Vector2d& end, double side) {
    add_quad(point(end.x(), side, bottom), point(end.x(), -side, bottom),
             point(end.x(), -side, end.y()), point(end.x(), side, end.y()), SurfaceKind::kObject);
  };
  end_face(profile.front(), 1.0);
  end_face(profile.back(), -1.0);
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    const Eigen::Vector2d& p = profile[i];
    const Eigen::Vector2d& q = profile[i + 1];
    const bool riser = q.x() <= p.x();
    add_quad(point(p.x(), -1, p.y()), point(q.x(), -1, q.y()), point(q.x(), 1, q.y()),
             point(p.x(), 1, p.y()), riser ? SurfaceKind::kObject : top);
    if (riser) continue;
    add_quad(point(p.x(), 1, bottom), point(q.x(), 1, bottom), point(q.x(), -1, bottom),
             point(p.x(), -1, bottom), SurfaceKind::kObject);
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector2d& a = side < 0 ? p : q;
      const Eigen::Vector2d& b = side < 0 ? q : p;
      add_quad(point(a.x(), side, bottom), point(b.x(), side, bottom), point(b.x(), side, b.y()),
               point(a.x(), side, a.y()), SurfaceKind::kObject);
    }
  }
}

}  // namespace mrpt_terrain::sim
