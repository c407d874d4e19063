// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "mrpt_terrain/core/elevation_grid.h"
#include "mrpt_terrain/core/feature_status.h"
#include "mrpt_terrain/core/local_planes.h"
#include "mrpt_terrain/core/param_info.h"
#include "mrpt_terrain/core/unseen_reason.h"

/// \file
/// What it costs a robot to drive over a cell: the largest of some parts, such as slope, step and
/// roughness, each a measured number over the robot's limit for it. Four more parts need what field
/// mode knows (field_costs.h). doc/costs.md has the formulas with their reasons.
namespace mrpt_terrain {

/// A robot as its file in params/robots/ describes it. The defaults are a small outdoor robot.
///
/// Grids without a description of field mode have costs from `footprint_width` (size of the
/// windows) and the four `max_` limits alone.
struct RobotParams {
  double footprint_length = 0.5;          ///< metres
  double footprint_width = 0.4;           ///< metres
  double height = 0.4;                    ///< from the ground to the highest part, metres
  double ground_clearance = 0.08;         ///< under the body, metres
  double wheel_radius = 0.1;              ///< metres
  double max_climb = 0.3490658503988659;  ///< 20 deg, radians
  double max_tilt = 0.26179938779914946;  ///< 15 deg, radians
  double max_step = 0.08;                 ///< metres
  double max_roughness = 0.05;            ///< metres
  double overhead_reserve = 0.1;          ///< metres over `height` that have to be free
  double least_confidence = 0.03;         ///< [0, 1]: things and holes less certain do not stop it
  double cost_out_of_view = 0.3;          ///< [0, 1): of ground where no beam points,
  double cost_occluded = 0.6;             ///< behind or under something,
  double cost_no_return = 0.5;            ///< or where nothing came back

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.footprint_length,
          ParamInfo{"footprint_length", "", "m", 0.05, 20.0, "extent along the robot's x"});
    visit(self.footprint_width,
          ParamInfo{"footprint_width", "", "m", 0.05, 20.0,
                    "extent along the robot's y; slopes are told from windows as wide"});
    visit(self.height,
          ParamInfo{"height", "", "m", 0.01, 20.0, "from the ground to the highest part"});
    visit(self.ground_clearance,
          ParamInfo{"ground_clearance", "", "m", 0.0, 5.0, "free height under the body"});
    visit(self.wheel_radius, ParamInfo{"wheel_radius", "", "m", 0.005, 5.0, "radius of a wheel"});
    visit(self.max_climb, ParamInfo{"max_climb_deg", "", "deg", 1.0, 80.0,
                                    "slope along the heading from which a cell is lethal"});
    visit(self.max_tilt, ParamInfo{"max_tilt_deg", "", "deg", 1.0, 80.0,
                                   "slope across the heading from which a cell is lethal"});
    visit(self.max_step, ParamInfo{"max_step", "", "m", 0.001, 5.0,
                                   "height of a step, up or down, from which a cell is lethal"});
    visit(self.max_roughness,
          ParamInfo{"max_roughness", "", "m", 0.001, 5.0,
                    "standard deviation of heights about the plane from which a cell is lethal"});
    visit(self.overhead_reserve,
          ParamInfo{"overhead_reserve", "", "m", 0.0, 5.0,
                    "field mode: cells are free under what hangs this much above the robot"});
    visit(self.least_confidence,
          ParamInfo{"least_confidence", "", "", 0.0, 1.0,
                    "field mode: things and holes with less confidence are not lethal"});
    visit(self.cost_out_of_view, ParamInfo{"cost_out_of_view", "", "", 0.0, 0.99,
                                           "field mode: cost of ground that no beam points at"});
    visit(self.cost_occluded, ParamInfo{"cost_occluded", "", "", 0.0, 0.99,
                                        "field mode: cost of ground behind or under something"});
    visit(self.cost_no_return,
          ParamInfo{"cost_no_return", "", "", 0.0, 0.99,
                    "field mode: cost of ground in view from which nothing came back"});
  }

  /// The section of a robot file.
  template <class Self, class Visitor>
  static void visit_sections(Self& self, Visitor&& visit) {
    visit(self, "robot", "Size and limits of the robot");
  }
};

/// Whether a cost is known.
enum class CostStatus : std::uint8_t {
  kOk = 0,   ///< can be driven on; the cost is below 1
  kLethal,   ///< must not be driven on; the cost is 1
  kUnknown,  ///< no points in the cell, or too few around it for a slope
  kOutside,  ///< beyond the edges of the grid
};
constexpr EnumNames<CostStatus, 4> enum_names(CostStatus) {
  return {{{CostStatus::kOk, "ok"},
           {CostStatus::kLethal, "lethal"},
           {CostStatus::kUnknown, "unknown"},
           {CostStatus::kOutside, "outside"}}};
}

/// The parts of a cost, each a layer over the grid. The first three are known of every grid, the
/// others of descriptions of field mode.
enum class CostPart : std::uint8_t {
  kSlope = 0,  ///< angle over the limit of climb or tilt
  kStep,       ///< height of a step of the ground over the limit
  kRoughness,  ///< scatter of the ground over the limit
  kObstacle,   ///< height of what stands in the cell over the smaller of step and clearance
  kPothole,    ///< how far a wheel falls over the limit of steps
  kUnknown,    ///< cost of ground that was not seen, by the reason why
  kDoubt,      ///< height of a step that noise may hide over the limit
};
inline constexpr std::size_t kCostPartCount = 7;
constexpr EnumNames<CostPart, kCostPartCount> enum_names(CostPart) {
  return {{{CostPart::kSlope, "slope"},
           {CostPart::kStep, "step"},
           {CostPart::kRoughness, "roughness"},
           {CostPart::kObstacle, "obstacle"},
           {CostPart::kPothole, "pothole"},
           {CostPart::kUnknown, "unknown"},
           {CostPart::kDoubt, "doubt"}}};
}

/// A hole as a wheel meets it.
struct HoleExtent {
  float depth = 0.0F;       ///< metres below the rim, as far as it was seen
  float length = 0.0F;      ///< along its longer side, metres
  float width = 0.0F;       ///< along its shorter side, metres
  float yaw = 0.0F;         ///< of the longer side, from x towards y, radians
  float confidence = 0.0F;  ///< [0, 1]

  /// Way through its middle in a heading (radians), metres: across an ellipse as long and wide.
  [[nodiscard]] double extent_along(double heading) const;
};

/// By how much a wheel falls into a hole, metres: all its depth, or until it touches the two edges
/// where they are closer than its diameter.
/// \param extent way across the hole, metres
[[nodiscard]] double wheel_drop(double depth, double extent, double wheel_radius);

/// What the ground is like in each observed cell; arrays over the slots of a grid. Independent of
/// the robot's limits but for what `compute_cell_costs` says.
struct CellCosts {
  std::vector<float> gradient_x;      ///< rise per metre along x, at most kSteepestGradient long
  std::vector<float> gradient_y;      ///< the same along y
  std::vector<float> step;            ///< height of the highest step at the cell, metres, >= 0
  std::vector<float> roughness;       ///< standard deviation about the plane, metres, >= 0
  std::vector<FeatureStatus> status;  ///< of gradient and roughness: they mean something when kOk.
                                      ///< The step is known always, as far as points tell.
  // Of descriptions of field mode only (field_costs.h); empty otherwise.
  std::vector<float> obstacle;       ///< height of what stands in the robot's way, metres, >= 0
  std::vector<float> likely;         ///< [0, 1]: that it does; 1 where nothing stands
  std::vector<std::int32_t> hole;    ///< number in `holes`, or -1
  std::vector<float> doubt;          ///< two standard errors of the ground's height, metres, >= 0
  std::vector<UnseenReason> ground;  ///< kSeen, or why the ground in the cell was not
  std::vector<HoleExtent> holes;
  /// Unobserved cells of ditches and drops, ascending numbers (`CellId`): lethal.
  std::vector<std::int32_t> missing;
  /// Per `CellId`: why nothing is known of its ground (`explain_unseen_cells`). Empty: not told.
  std::vector<UnseenReason> unseen;

  [[nodiscard]] std::size_t size() const { return status.size(); }
  /// Whether a part is known of these costs.
  [[nodiscard]] bool has(CostPart part) const {
    return part <= CostPart::kRoughness || obstacle.size() == status.size();
  }
};

/// What the points of a cell are.
enum class CellMix : std::uint8_t {
  kNone = 0,  ///< ground
  kGround,    ///< ground and what stands on it or lies below
  kLow,       ///< ground that lies low, and what stands on it
  kDeck,      ///< a deck and what lies beside
  kHole       ///< the floor of a hole
};

/// What the points of a mixed cell are: ground, and what stands in it. Heights are metres, frame of
/// the grid.
struct MixedCell {
  float low = std::numeric_limits<float>::max();      ///< lowest drivable point
  float high = std::numeric_limits<float>::lowest();  ///< highest drivable point
  float top = std::numeric_limits<float>::lowest();   ///< highest of what stands, or of a deck
  float foot = 0.0F;                                  ///< sum over the ground it stands on
  std::int32_t foot_points = 0;
  std::int32_t standing = 0;  ///< points in the robot's way
};

/// Points that a wheel can rest on, in the cells of a description of field mode.
struct DrivableCells {
  std::vector<MomentSums> sums;       ///< per slot
  std::vector<float> extent;          ///< per slot: highest less lowest of them, metres
  std::vector<CellMix> mixed;         ///< per slot
  std::vector<std::uint8_t> skipped;  ///< per slot: no window is wanted about it
  std::vector<MixedCell> cells;       ///< per slot; left as they are where cells are not mixed
  std::vector<std::int32_t> hole_of;  ///< per cluster: number of its hole, or -1
};

/// How well the plane of a window is known. Windows without a plane have no cells.
struct WindowQuality {
  float variance = 0.0F;  ///< across the plane, m^2
  float cells = -1.0F;
};

/// The plane that a cell takes; flat and infinitely rough where it has none.
struct CellSurface {
  double x = 0.0, y = 0.0, z = 0.0;  ///< as in `LocalPlane`
  float gradient_x = 0.0F;
  float gradient_y = 0.0F;
  float roughness = std::numeric_limits<float>::infinity();
  float known = 0.0F;  ///< 1 or 0: whether there is one

  [[nodiscard]] double height_at(double px, double py) const {
    return z + gradient_x * (px - x) + gradient_y * (py - y);
  }
};

/// Scratch memory of `compute_cell_costs`.
struct CostWorkspace {
  std::vector<LocalPlane> planes;        ///< per slot: of the window about it
  std::vector<WindowQuality> qualities;  ///< the same, after an entry for unobserved cells
  std::vector<CellSurface> surfaces;     ///< likewise
  /// Per slot: how many slots from it on are of cells that follow each other in a row, up to 8.
  std::vector<std::uint8_t> in_row;
  DrivableCells drivable;  ///< field mode only
};

/// Cells to each side of a window: half the robot's width, from 1 to kMaxReach cells. A window is
/// about as wide as the robot, so that its plane is the one the robot stands on.
[[nodiscard]] int window_reach(const RobotParams& robot, double cell_size);

/// Measures slope, step and roughness of every observed cell.
///
/// * Surface of a cell: of the planes of nine windows that contain it, its own and those about the
///   cells `window_reach` away in eight directions, the one with the least variance per observed
///   cell. Windows with fewer observed cells than its own do not count. Beside a curb, this is a
///   window that ends at the curb.
/// * Step of a cell: in each of four directions, the surfaces of the cells before and behind, both
///   carried on to the cell, and its own mean height (less twice its standard error) differ; the
///   greatest difference counts. It is 0 on any plane, and h at a curb, pit or post of height h.
///   Where a neighbour has no surface, that of the cell stands in; where that is missing too, mean
///   heights count as far as they differ by more than `max_climb` explains.
/// * Or, if that is greater, h_max - h_min of the cell beyond what its gradient (up to `max_climb`)
///   and noise (six times the least roughness around) explain: thin things of few points.
/// * Gradient and roughness are those of the surface; where the surfaces before and behind the cell
///   are apart by more than four times their roughness, of the smoothest of the three.
///
/// The robot's width, `max_climb` and the cell size are all that the result depends on besides the
/// points. The same input gives the same bytes; results that keep their memory do not allocate.
/// \param grid heights and sums of observed cells, metres
/// \param[in,out] costs overwritten; one entry per slot of `grid`
void compute_cell_costs(const ElevationGrid& grid, const RobotParams& robot,
                        CostWorkspace& workspace, CellCosts& costs);

/// Measured numbers over the robot's limits, >= 0; 1 and more is too much.
struct CostParts {
  double slope = 0.0;
  double step = 0.0;
  double roughness = 0.0;
  // In field mode only:
  double obstacle = 0.0;
  double pothole = 0.0;
  double unknown = 0.0;  ///< below 1
  double doubt = 0.0;    ///< below 1

  [[nodiscard]] double of(CostPart part) const;
  [[nodiscard]] double largest() const;
};

/// Cost of driving on a cell.
struct Cost {
  CostStatus status = CostStatus::kUnknown;
  /// [0, 1]; 1 only if lethal. Of unknown cells, it is what is known of them, in field mode the
  /// cost of not knowing included; 0 says nothing then.
  double cost = 0.0;
  CostParts parts;  ///< slope and roughness are 0 where they are not known
};

/// Cost in a heading: slope is the greater of the angle along the heading over `max_climb` and the
/// angle across it over `max_tilt`. Unknown for kUnobserved, and where the slope is not known,
/// unless the step alone is lethal.
/// \param slot a slot of the grid that the costs are of, or kUnobserved
/// \param heading radians from the grid's x axis, counter-clockwise
[[nodiscard]] Cost cost_of(const CellCosts& costs, Slot slot, const RobotParams& robot,
                           double heading);

/// Cost in the worst heading: the whole slope, over the smaller of the two limits.
[[nodiscard]] Cost cost_of(const CellCosts& costs, Slot slot, const RobotParams& robot);

/// Cost of ground that was not seen: kUnknown, with what the robot's file says of the reason.
[[nodiscard]] Cost cost_of_unseen(UnseenReason reason, const RobotParams& robot);

/// The same at a position in the frame of the grid, metres; kOutside beyond the edges and for NaN.
[[nodiscard]] Cost cost_at(const ElevationGrid& grid, const CellCosts& costs, Position2 position,
                           const RobotParams& robot, double heading);
[[nodiscard]] Cost cost_at(const ElevationGrid& grid, const CellCosts& costs, Position2 position,
                           const RobotParams& robot);

/// Cost of standing at a position: the worst of all cells that the robot's footprint touches, a
/// rectangle of `footprint_length` along the heading and `footprint_width` across about the
/// position. Lethal if any cell is; else outside if any is beyond the grid; else unknown if any is.
/// Cost and parts are the largest of all cells. kOutside for NaN.
/// \param heading radians from the grid's x axis, counter-clockwise
[[nodiscard]] Cost footprint_cost_at(const ElevationGrid& grid, const CellCosts& costs,
                                     Position2 position, const RobotParams& robot, double heading);

}  // namespace mrpt_terrain
