// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "mrpt_terrain/sim/mesh.h"

namespace mrpt_terrain::sim {

/// Corners of a profile: x along its way, y up. Two corners at one x make a riser.
using Profile = std::vector<Eigen::Vector2d>;

/// Adds closed bodies of one solid to a mesh, seen from outside counter-clockwise.
class MeshBuilder {
 public:
  /// \param solid index into `World::solids` of everything that is added
  MeshBuilder(Mesh& mesh, std::int32_t solid) : mesh_(mesh), solid_(solid) {}

  void add_triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                    SurfaceKind kind);
  void add_quad(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                const Eigen::Vector3d& d, SurfaceKind kind);

  /// Cuboid of a size about the middle of its bottom.
  void add_box(const Eigen::Isometry3d& T_map_box, const Eigen::Vector3d& size,
               SurfaceKind top = SurfaceKind::kObject);
  /// Upright prism of `facets` sides; the corners lie on the ellipse of the two radii.
  void add_prism(const Eigen::Isometry3d& T_map_prism, double radius_x, double radius_y,
                 double height, int facets);
  /// Profile drawn out along y to both sides of the x axis, down to `bottom`; its top has the given
  /// kind, risers and sides are objects.
  void add_profile(const Eigen::Isometry3d& T_map_profile, const Profile& profile, double width,
                   double bottom, SurfaceKind top);

 private:
  Mesh& mesh_;
  std::int32_t solid_;
};

}  // namespace mrpt_terrain::sim
