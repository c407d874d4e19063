// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/config/CConfigFileBase.h>

#include <cstdint>
#include <string>
#include <vector>

#include "mrpt_terrain/core/costs.h"
#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/core/fused_grid.h"
#include "mrpt_terrain/core/param_info.h"
#include "mrpt_terrain/io/scan.h"
#include "mrpt_terrain/params/fields.h"

namespace mrpt_terrain {

/// What is described: the last scan by itself, or all scans so far.
enum class Fusion : std::uint8_t {
  kScan,     ///< grid, clusters and classes are those of the last scan, in the robot's frame
  kRolling,  ///< they are those of the fused grid (core/fused_grid.h) about the robot
};
constexpr EnumNames<Fusion, 2> enum_names(Fusion) {
  return {{{Fusion::kScan, "scan"}, {Fusion::kRolling, "rolling"}}};
}

/// `[..._creationOpts]`, beside extent and resolution of the grid.
struct MapCreationParams {
  Fusion fusion = Fusion::kScan;
  bool octree = true;              ///< keep an OctoMap beside the grid
  double octree_resolution = 0.2;  ///< side of a voxel, metres

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.fusion, ParamInfo{"fusion", "", "", 0, 0, "what is described"});
    visit(self.octree, ParamInfo{"octree", "", "", 0, 0, "keeps an OctoMap beside the grid"});
    visit(self.octree_resolution,
          ParamInfo{"octree_resolution", "", "m", 0.01, 10.0, "side of a voxel of the OctoMap"});
  }
};

/// Part of `[..._insertOpts]`: how scans enter the OctoMap. Names and defaults are octomap's.
struct OctreeInsertParams {
  double max_range = 20.0;  ///< metres; rays are cut there; 0: no limit
  bool discretize = false;  ///< one ray per end voxel
  double prob_hit = 0.7;    ///< occupancy that a return speaks for
  double prob_miss = 0.4;   ///< occupancy that a ray passing through speaks for
  double clamping_min = 0.1192;
  double clamping_max = 0.971;
  /// Voxels that hold ground are not freed by rays that graze it; needs fused scans. The OctoMap is
  /// then another one than OctoMap's own insertion makes.
  bool protect_ground = false;

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.max_range, ParamInfo{"octree_max_range", "", "m", 0.0, 10000.0,
                                    "rays into the OctoMap are cut there (0: no limit)"});
    visit(self.discretize,
          ParamInfo{"octree_discretize", "", "", 0, 0, "casts one ray per end voxel of a scan"});
    visit(self.prob_hit,
          ParamInfo{"octree_prob_hit", "", "", 0.5, 1.0, "occupancy that a return speaks for"});
    visit(self.prob_miss, ParamInfo{"octree_prob_miss", "", "", 0.0, 0.5,
                                    "occupancy that a ray passing through speaks for"});
    visit(self.clamping_min, ParamInfo{"octree_clamping_min", "", "", 0.0, 0.5,
                                       "least occupancy that a voxel can reach"});
    visit(self.clamping_max, ParamInfo{"octree_clamping_max", "", "", 0.5, 1.0,
                                       "greatest occupancy that a voxel can reach"});
    visit(self.protect_ground,
          ParamInfo{"octree_protect_ground", "", "", 0, 0,
                    "rays that graze the ground do not free its voxels; needs fusion = rolling"});
  }
};

/// `[..._likelihoodOpts]`: how well a scan fits the map at a pose.
struct MapLikelihoodParams {
  int decimation = 10;        ///< every n-th point counts
  double sigma = 0.1;         ///< metres: of the distance between a point and the map
  double max_distance = 0.3;  ///< metres: farther away, all distances count the same
  /// Points where nothing is known are penalised as the scan's other points are on average; as far
  /// as there are hardly any others, with this share of the greatest penalty.
  double unknown_share = 0.25;

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.decimation,
          ParamInfo{"decimation", "", "", 1, 100000, "every n-th point of a scan counts"});
    visit(self.sigma, ParamInfo{"sigma", "", "m", 0.001, 10.0,
                                "standard deviation of the distance of a point from the map"});
    visit(self.max_distance, ParamInfo{"max_distance", "", "m", 0.01, 100.0,
                                       "points farther from the map all count the same"});
    visit(self.unknown_share,
          ParamInfo{"unknown_share", "", "", 0.0, 1.0,
                    "share of the greatest penalty for points where the map knows nothing, if it "
                    "knows next to nothing of the others, too; else the average of those"});
  }
};

/// What the cells are coloured by in 3D views.
enum class CellColouring : std::uint8_t { kHeight, kClass, kCost };
constexpr EnumNames<CellColouring, 3> enum_names(CellColouring) {
  return {{{CellColouring::kHeight, "height"},
           {CellColouring::kClass, "class"},
           {CellColouring::kCost, "cost"}}};
}

/// `[..._renderOpts]`: what 3D views show.
struct MapRenderParams {
  bool cells = true;
  CellColouring colouring = CellColouring::kHeight;
  bool clusters = true;  ///< boxes and numbers
  bool points = false;   ///< of the last scan, coloured by class
  bool octree = false;   ///< occupied voxels

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.cells, ParamInfo{"cells", "", "", 0, 0, "shows the cells as a surface"});
    visit(self.colouring, ParamInfo{"colouring", "", "", 0, 0, "what colours the cells"});
    visit(self.clusters,
          ParamInfo{"clusters", "", "", 0, 0, "shows clusters as boxes with their numbers"});
    visit(self.points, ParamInfo{"points", "", "", 0, 0, "shows the points of the last scan"});
    visit(self.octree, ParamInfo{"octree", "", "", 0, 0, "shows the OctoMap's occupied voxels"});
  }
};

/// All parameters of a CTerrainMap.
struct MapParams {
  MapCreationParams creation;
  DescriptionParams description;
  io::InputParams input;
  /// Its `cell_size` and `layer_height` are not read: cells are those of the grid, layers have the
  /// height of the OctoMap's voxels. `fusion_of` fills them in.
  FusionParams fusion;
  OctreeInsertParams octree;
  MapLikelihoodParams likelihood;
  MapRenderParams render;
  RobotParams robot;
};

/// `params.fusion` with the sizes that the map gives it.
[[nodiscard]] FusionParams fusion_of(const MapParams& params);

/// The sections of a map's definition, named `<prefix>_creationOpts` and so on. They point into
/// `params`.
[[nodiscard]] std::vector<params::Section> map_sections(const std::string& prefix,
                                                        MapParams& params);

/// Loads the definition of one map from what an MRPT host has read. `_insertionOpts` (as MOLA's
/// classes have it) means `_insertOpts`. Throws params::ParameterError with one line for each
/// section of that prefix or key in it that does not exist, value that cannot be read, or value out
/// of range; `params` is then unchanged. Nothing is said about other sections.
void load_map_params(const mrpt::config::CConfigFileBase& config, const std::string& prefix,
                     MapParams& params);

/// The same of what a map was stored with, perhaps by an older version: keys that have been given
/// up since are passed over.
void load_stored_map_params(const mrpt::config::CConfigFileBase& config, const std::string& prefix,
                            MapParams& params);

/// Refuses values that are each permitted but not together. Throws params::ParameterError.
/// \param source beginning of the messages
void check_together(const MapParams& params, const std::string& source);

}  // namespace mrpt_terrain
