// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "mrpt_terrain/core/beam_slope.h"
#include "mrpt_terrain/core/classes.h"
#include "mrpt_terrain/core/clusters.h"
#include "mrpt_terrain/core/decks.h"
#include "mrpt_terrain/core/elevation_grid.h"
#include "mrpt_terrain/core/face_slope.h"
#include "mrpt_terrain/core/field_cells.h"
#include "mrpt_terrain/core/field_clusters.h"
#include "mrpt_terrain/core/ground.h"
#include "mrpt_terrain/core/ground_gaps.h"
#include "mrpt_terrain/core/ground_labels.h"
#include "mrpt_terrain/core/ground_surface.h"
#include "mrpt_terrain/core/height_index.h"
#include "mrpt_terrain/core/holes.h"
#include "mrpt_terrain/core/label_stage.h"
#include "mrpt_terrain/core/labels.h"
#include "mrpt_terrain/core/oriented_box.h"
#include "mrpt_terrain/core/overhangs.h"
#include "mrpt_terrain/core/raised_ground.h"
#include "mrpt_terrain/core/roughness.h"
#include "mrpt_terrain/core/scan_view.h"
#include "mrpt_terrain/core/slope.h"

namespace mrpt_terrain {

/// How a scan is described.
enum class DescriptionMode : std::uint8_t {
  kPaper = 0,  ///< the published method to the letter: heights about z = 0
  kField,      ///< heights about a local ground reference, for real ground
};
constexpr EnumNames<DescriptionMode, 2> enum_names(DescriptionMode) {
  return {{{DescriptionMode::kPaper, "paper"}, {DescriptionMode::kField, "field"}}};
}

/// Which of the two descriptions is wanted.
struct ModeParams {
  DescriptionMode mode = DescriptionMode::kPaper;

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.mode, ParamInfo{"mode", "", "", 0, 0,
                               "paper: the published method to the letter, heights about z = 0; "
                               "field: heights about a local ground reference, for real ground"});
  }
};

/// All parameters of the description of one scan, a struct per stage. The defaults are the
/// paper's values where it gives them (params/paper.ini).
struct DescriptionParams {
  ModeParams description;
  GridParams grid;
  GroundSurfaceParams ground_surface;
  GroundLabelParams ground_labels;
  HoleParams holes;
  GapParams gaps;
  DeckParams decks;
  RaisedGroundParams raised_ground;
  OverhangParams overhangs;
  FieldClusterParams field_clusters;
  GroundParams ground;
  ClusterParams clusters;
  RoughnessParams roughness;
  SlopeParams slope;
  BeamSlopeParams beam_slope;
  ClassParams classes;

  template <class Self, class Visitor>
  static void visit_sections(Self& self, Visitor&& visit) {
    visit(self.description, "description", "Paper mode or field mode");
    visit(self.grid, "grid", "Extent and resolution of the elevation grid");
    visit(self.ground_surface, "ground_surface", "Field mode: local ground reference");
    visit(self.ground_labels, "ground_labels", "Field mode: points of the ground and above it");
    visit(self.holes, "holes", "Field mode: potholes and ditches");
    visit(self.gaps, "gaps", "Field mode: ditches and drops that rings miss");
    visit(self.decks, "decks", "Field mode: raised surfaces to drive on");
    visit(self.raised_ground, "raised_ground", "Field mode: ground that is part of a thing");
    visit(self.overhangs, "overhangs", "Field mode: free under what hangs");
    visit(self.field_clusters, "field_clusters", "Field mode: clusters that are things");
    visit(self.ground, "ground", "Ground segmentation, eqs. (1) and (2)");
    visit(self.clusters, "clusters", "Grids clustering");
    visit(self.roughness, "roughness", "Roughness, eq. (4) and Algorithm 1");
    visit(self.slope, "slope", "Slope angle, eqs. (5) and (6), Algorithm 2");
    visit(self.beam_slope, "beam_slope", "Slope angle with noise along the beams, beam_slope.h");
    visit(self.classes, "classes", "Terrain classes, Table 1");
  }
};

/// One thing in the terrain: a cluster of cells with its features and class. Metres, radians.
struct ClusterDescription {
  TerrainClass terrain_class = TerrainClass::kOther;
  HeightIndex height;
  Roughness roughness;
  Slope slope;
  std::int32_t cells = 0;
  std::int32_t points = 0;
  float h_min = 0.0F;    ///< lowest point, metres
  float h_max = 0.0F;    ///< highest point, metres
  Position2 centroid;    ///< mean of its points
  Position2 min_corner;  ///< of the cells' bounding rectangle, edges of cells included
  Position2 max_corner;
  // In field mode only:
  OrientedBox box;            ///< about its points
  std::int32_t raised = 0;    ///< of its points: ground that stands out of the ground around
  double scatter = 0.0;       ///< RMS distance of its points from their best plane, metres
  double lowest_step = 0.0;   ///< of the steps at its edges, metres; doc/field-mode.md
  double highest_step = 0.0;  ///< the same; 0 both where no ground was seen beside it
  double confidence = 0.0;    ///< [0, 1]: that it is a thing, doc/field-mode.md
  /// Number that it keeps from scan to scan; 0: unknown. `describe` knows no other scans and leaves
  /// it 0: it is for those who have poses and a `ThingTracker`.
  std::uint64_t identity = 0;
};

/// The stages of a description, in the order in which they run.
enum class Stage : std::uint8_t {
  kGrid,
  kGround,
  kClusters,
  kHeightAndRoughness,
  kSlope,
  kClasses,
  kLabels
};
inline constexpr std::size_t kStageCount = 7;
constexpr EnumNames<Stage, kStageCount> enum_names(Stage) {
  return {{{Stage::kGrid, "grid"},
           {Stage::kGround, "ground"},
           {Stage::kClusters, "clusters"},
           {Stage::kHeightAndRoughness, "height_and_roughness"},
           {Stage::kSlope, "slope"},
           {Stage::kClasses, "classes"},
           {Stage::kLabels, "labels"}}};
}

/// What is told after each stage; `core` has no clock, so whoever times the stages does it here.
class StageListener {
 public:
  virtual ~StageListener() = default;
  virtual void stage_done(Stage stage) = 0;
};

/// Description of one scan: everything that the stages found out.
struct Description {
  ElevationGrid grid;
  GroundSegmentation ground;
  FieldCells field;  ///< field mode: the cells against the ground reference; empty in paper mode
  std::vector<HoleDescription> holes;  ///< field mode: holes in the ground, with or without cluster
  /// Field mode: a row per hole: its cells, `CellId` numbers, ascending, observed or not. Nothing
  /// may be driven on there.
  IndexRows hole_cells;
  Clusters clusters;
  std::vector<ClusterDescription> things;  ///< one per cluster, same numbers
  CellLabels cells;                        ///< one per slot of the grid
  PointLabels labels;                      ///< one per input point
  ProjectionCounts projection;
};

/// Field mode: a point that is part of a cluster.
struct ClusterPoint {
  std::int32_t point;  ///< in the scan
  std::int32_t cluster;
};

/// Field mode: what is summed over the points of a cluster. Metres.
struct ClusterSums {
  MomentSums points;
  double height = 0.0;                                ///< above the ground reference
  float low = std::numeric_limits<float>::max();      ///< above the ground reference
  float high = std::numeric_limits<float>::lowest();  ///< above the ground reference
  float z_low = std::numeric_limits<float>::max();
  float z_high = std::numeric_limits<float>::lowest();
  std::int32_t raised = 0;  ///< points of raised ground
};

/// Scratch memory of all stages. Reuse it together with the `Description`: scans of similar size
/// are then described without allocating.
struct DescriptionWorkspace {
  ElevationGridWorkspace grid;
  GroundWorkspace ground;
  FieldWorkspace field;
  HoleWorkspace holes;
  GapWorkspace gaps;
  DeckWorkspace decks;
  RaisedGroundWorkspace raised_ground;
  FieldClusterWorkspace field_clusters;
  ClusterWorkspace clusters;
  SlopeWorkspace slope;
  BeamSlopeWorkspace beam_slope;
  FaceSlopeWorkspace face_slope;
  OrientedBoxWorkspace box;
  std::vector<float> steps;  ///< of one thing, metres
  std::vector<std::uint8_t> slot_wanted;
  LabelWorkspace labels;
  PointSlots point_slots;
  PointSlots cluster_slots;  ///< field mode, like `cluster_points` and `cluster_sums`
  std::vector<ClusterPoint> cluster_points;  ///< in the order of the scan
  std::vector<ClusterSums> cluster_sums;     ///< per cluster
  std::vector<Moments> cluster_moments;
  std::vector<std::int32_t> points_wanted;
  std::vector<std::int32_t> slope_wanted;  ///< fused grids only, like `scan_sums`
  std::vector<MomentSums> scan_sums;       ///< per slot: of the current scan
  std::vector<TerrainClass> class_of;
  IndexRows points_of;
};

/// Describes one scan by the method of Meng, Cao et al. 2018: elevation grid, ground segmentation,
/// clustering, features, classes, labels. In field mode (`params.description.mode`), ground
/// segmentation, clustering and heights are those of doc/field-mode.md, relative to a local ground
/// reference.
///
/// The same points and parameters give the same bytes on every run. No points, or none in the map,
/// give an empty description and counts that say why.
/// \param scan points and origins of their beams in the robot frame (x forward, y left, z up,
/// z = 0 on the ground), metres; the origins are needed by `slope.method = beam` only
/// \param[in,out] description overwritten
/// \param listener told after each stage; may be null
void describe(const ScanView& scan, const DescriptionParams& params,
              DescriptionWorkspace& workspace, Description& description,
              StageListener* listener = nullptr);

}  // namespace mrpt_terrain
