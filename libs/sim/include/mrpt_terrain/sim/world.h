// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "mrpt_terrain/core/labels.h"
#include "mrpt_terrain/sim/mesh.h"
#include "mrpt_terrain/sim/scene.h"

namespace mrpt_terrain::sim {

/// Index of the ground in `World::solids`.
inline constexpr std::int32_t kGroundSolid = 0;
/// Solid of a ray that met nothing.
inline constexpr std::int32_t kNoSolid = -1;

/// One thing of the world with its exact measures.
struct WorldSolid {
  int id = 0;                   ///< as in the scene; 0 is the ground
  std::string type = "ground";  ///< name of the shape: "box", "pothole", ...
  TerrainClass terrain_class = TerrainClass::kNone;
  Material material = Material::kSoil;
  /// Metres above the ground it stands on (its highest point); negative: depth of a pothole.
  double height = 0.0;
  double length = 0.0;  ///< extent along its own x axis, metres
  double width = 0.0;   ///< extent along its own y axis, metres
  double slope = 0.0;   ///< inclination of its drivable surface from horizontal, radians
  Eigen::Isometry3d T_map_solid = Eigen::Isometry3d::Identity();  ///< at time 0
};

/// Volume of vegetation: a ray that passes through it returns after a random free path.
struct Medium {
  std::int32_t solid = 0;  ///< index into `World::solids`
  enum class Form : std::uint8_t {
    kLayer,      ///< from the drivable ground up to `height` above it, over a turned rectangle
    kEllipsoid,  ///< within half axes `half_extent` about the centre
  };
  Form form = Form::kLayer;
  Eigen::Isometry3d T_map_medium = Eigen::Isometry3d::Identity();
  Eigen::Vector3d half_extent = Eigen::Vector3d::Zero();  ///< metres; z unused for layers
  double height = 0.0;                                    ///< of a layer, metres
  double density = 0.0;                                   ///< mean returns per metre of path
};

/// A thing that moves: its mesh in its own frame and how that frame goes. It walks at constant
/// speed to and fro between `from` and `to` (feet on the drivable ground); at time 0 it is at
/// `from`.
struct Mover {
  std::int32_t solid = 0;  ///< index into `World::solids`; also of all triangles of `mesh`
  Mesh mesh;               ///< own frame: x in walking direction, z = 0 at the feet
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  double speed = 0.0;                                          ///< metres per second
  [[nodiscard]] Eigen::Isometry3d pose_at(double time) const;  ///< T_map_mover
};

/// A scene turned into geometry. Map frame, z up, metres.
struct World {
  Mesh mesh;                       ///< all that stands still
  std::vector<WorldSolid> solids;  ///< 0 is the ground, then in the order of the scene
  std::vector<Medium> media;
  std::vector<Mover> movers;
  Eigen::Vector2d min_corner = Eigen::Vector2d::Zero();  ///< extent of the ground
  Eigen::Vector2d max_corner = Eigen::Vector2d::Zero();
};

/// Builds the geometry of a scene: the ground as a mesh, potholes and ditches cut out of it, solids
/// put on it. Throws SceneError where solids do not fit (a pothole wider than its ground, a solid
/// beyond the edge).
[[nodiscard]] World build_world(const Scene& scene);

}  // namespace mrpt_terrain::sim
