// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/field_costs.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "measure_ground.h"
#include "slots_around.h"
#include "things.h"

namespace mrpt_terrain {
namespace {

// Things that are lower are measured from their foot, too, metres.
constexpr float kLow = 0.5F;

/// What the functions below share.
struct Input {
  const Description& description;
  const DescribedPoints& scan;
  float clear;  // height from which on things hang over the robot, metres
};

// What the points of a cell are.
CellMix mix_of(const Description& description, const CellCosts& costs, std::size_t slot) {
  if (costs.hole[slot] >= 0) return CellMix::kHole;
  if (description.field.deck[slot] >= 0) return CellMix::kDeck;
  if (description.ground.rule[slot] == GroundRule::kLow) return CellMix::kLow;
  const bool ground =
      description.ground.rule[slot] == GroundRule::kGround && description.field.below[slot] == 0;
  return ground ? CellMix::kNone : CellMix::kGround;
}

HoleExtent extent_of(const HoleDescription& hole, const ClusterDescription* thing) {
  HoleExtent extent;
  extent.depth = static_cast<float>(hole.depth);
  extent.length = static_cast<float>(std::max(hole.length, hole.width));
  extent.width = static_cast<float>(std::min(hole.length, hole.width));
  extent.confidence = static_cast<float>(hole.confidence);
  if (thing == nullptr) {
    extent.width = extent.length;  // whichever way it lies
  } else {
    extent.yaw = static_cast<float>(thing->box.yaw);
  }
  return extent;
}

HoleExtent extent_of(const ClusterDescription& thing) {
  HoleExtent extent;
  extent.depth = static_cast<float>(std::max(0.0, -thing.height.h_f));
  extent.length = static_cast<float>(thing.box.length);
  extent.width = static_cast<float>(thing.box.width);
  extent.yaw = static_cast<float>(thing.box.yaw);
  extent.confidence = static_cast<float>(thing.confidence);
  return extent;
}

// Two holes in one cluster: what is worse of either.
void take_worse(const HoleExtent& other, HoleExtent& hole) {
  hole.depth = std::max(hole.depth, other.depth);
  hole.length = std::max(hole.length, other.length);
  hole.width = std::max(hole.width, other.width);
  hole.confidence = std::max(hole.confidence, other.confidence);
}

// Cells of holes that are in no cluster: those up to two cells away that lie low.
void mark_loose_hole(const Description& description, std::size_t slot, std::int32_t number,
                     CellCosts& costs) {
  for_slots_around(description.grid, slot, 2, [&](std::size_t near) {
    const bool low = description.ground.rule[near] == GroundRule::kLow;
    if (low && description.clusters.cluster_of[near] == kNoCluster) costs.hole[near] = number;
  });
}

void find_extents(const Description& description, std::vector<std::int32_t>& hole_of,
                  CellCosts& costs) {
  const std::size_t observed = description.grid.observed();
  costs.holes.clear();
  hole_of.assign(description.clusters.size(), -1);
  for (const HoleDescription& hole : description.holes) {
    if (hole.slot < 0 || static_cast<std::size_t>(hole.slot) >= observed) continue;
    const auto slot = static_cast<std::size_t>(hole.slot);
    const std::int32_t cluster = description.clusters.cluster_of[slot];
    const auto number = static_cast<std::int32_t>(costs.holes.size());
    if (cluster == kNoCluster) {
      costs.holes.push_back(extent_of(hole, nullptr));
      mark_loose_hole(description, slot, number, costs);
      continue;
    }
    const auto c = static_cast<std::size_t>(cluster);
    const HoleExtent extent = extent_of(hole, &description.things[c]);
    if (hole_of[c] >= 0) {
      take_worse(extent, costs.holes[static_cast<std::size_t>(hole_of[c])]);
      continue;
    }
    hole_of[c] = number;
    costs.holes.push_back(extent);
  }
  for (std::size_t c = 0; c < description.clusters.size(); ++c) {
    if (hole_of[c] >= 0 || description.things[c].terrain_class != TerrainClass::kPothole) continue;
    hole_of[c] = static_cast<std::int32_t>(costs.holes.size());
    costs.holes.push_back(extent_of(description.things[c]));
  }
}

void find_hole_cells(const Description& description, std::vector<std::int32_t>& hole_of,
                     CellCosts& costs) {
  costs.hole.assign(description.grid.observed(), -1);
  find_extents(description, hole_of, costs);
  if (costs.holes.empty()) return;
  for (std::size_t c = 0; c < hole_of.size(); ++c) {
    if (hole_of[c] < 0) continue;
    for (const std::int32_t slot : description.clusters.slots.row(c)) {
      const auto s = static_cast<std::size_t>(slot);
      if (description.ground.rule[s] == GroundRule::kLow) costs.hole[s] = hole_of[c];
    }
  }
}

// Whether a wheel must not go where the floor of a hole was not seen. The depth of a ditch is a
// lower bound; where the ground ends, there is none.
bool is_lethal(const HoleDescription& hole, const RobotParams& robot) {
  if (hole.confidence < robot.least_confidence || hole.kind == HoleKind::kFloor) return false;
  if (hole.kind == HoleKind::kDrop) return true;
  const double across = std::min(hole.length, hole.width);
  return wheel_drop(hole.depth, across, robot.wheel_radius) >= robot.max_step;
}

void find_missing_ground(const Description& description, const RobotParams& robot,
                         CellCosts& costs) {
  costs.missing.clear();
  for (std::size_t k = 0; k < description.holes.size(); ++k) {
    if (!is_lethal(description.holes[k], robot)) continue;
    for (const std::int32_t cell : description.hole_cells.row(k)) {
      const Slot slot = description.grid.slot_of[static_cast<std::size_t>(cell)];
      if (slot == kUnobserved) costs.missing.push_back(cell);
    }
  }
  std::sort(costs.missing.begin(), costs.missing.end());
  costs.missing.erase(std::unique(costs.missing.begin(), costs.missing.end()), costs.missing.end());
}

// The points of cells that have no others, and an empty set for the rest.
void copy_pure_cells(const Description& description, const CellCosts& costs, DrivableCells& cells) {
  const ElevationGrid& grid = description.grid;
  const std::size_t size = grid.observed();
  cells.sums = grid.sums;
  cells.extent.resize(size);
  cells.mixed.resize(size);
  cells.cells.resize(size);
  for (std::size_t slot = 0; slot < size; ++slot) {
    cells.mixed[slot] = mix_of(description, costs, slot);
    cells.extent[slot] = grid.h_diff(slot);
    if (cells.mixed[slot] == CellMix::kNone) continue;
    cells.sums[slot] = MomentSums{};
    cells.cells[slot] = MixedCell{};
  }
}

void add_drivable(double x, double y, float z, MomentSums& sums, MixedCell& cell) {
  sums.add(x, y, static_cast<double>(z));
  cell.low = std::min(cell.low, z);
  cell.high = std::max(cell.high, z);
}

// A point at a height above what it stands on, metres.
void add_standing(const Input& in, float height, float z, MixedCell& cell, float& obstacle) {
  if (!(height > 0.0F) || height >= in.clear) return;
  obstacle = std::max(obstacle, height);
  cell.top = std::max(cell.top, z);
  ++cell.standing;
}

// A point of ground from which what stands in the cell rises.
void add_foot(float z, MixedCell& cell) {
  cell.foot += z;
  ++cell.foot_points;
}

void add_point_of_deck(const Input& in, std::size_t i, std::size_t slot, DrivableCells& cells,
                       CellCosts& costs) {
  const PointsView& points = in.scan.points;
  const Support support = in.description.labels.support[i];
  const float x = points.x[i], y = points.y[i], z = points.z[i];
  const DeckPlane& plane = in.description.field.deck_plane[slot];
  const float over = z - plane.at(x, y);
  MixedCell& cell = cells.cells[slot];
  if (support == Support::kAbove) {
    add_standing(in, over, z, cell, costs.obstacle[slot]);
  } else if (support == Support::kGround && over >= -plane.side) {
    add_drivable(static_cast<double>(x), static_cast<double>(y), z, cells.sums[slot], cell);
    cell.top = std::max(cell.top, z);
  } else if (support == Support::kGround) {
    add_foot(z, cell);
  }
}

void add_point_of_ground(const Input& in, std::size_t i, std::size_t slot, DrivableCells& cells,
                         CellCosts& costs) {
  const PointsView& points = in.scan.points;
  const Support support = in.description.labels.support[i];
  if (support == Support::kAbove) {
    const float z = points.z[i];
    const float ground = in.description.field.ground[slot];
    const float height = in.scan.height != nullptr ? in.scan.height[i] : z - ground;
    add_standing(in, height, z, cells.cells[slot], costs.obstacle[slot]);
  } else if (support == Support::kGround ||
             (support == Support::kBelow && cells.mixed[slot] == CellMix::kLow)) {
    const auto x = static_cast<double>(points.x[i]), y = static_cast<double>(points.y[i]);
    add_drivable(x, y, points.z[i], cells.sums[slot], cells.cells[slot]);
    add_foot(points.z[i], cells.cells[slot]);
  }
}

void add_points(const Input& in, DrivableCells& cells, CellCosts& costs) {
  assert(in.scan.slots->size() == in.scan.points.size);
  const std::int32_t* slots = in.scan.slots->data();
  const CellMix* mixed = cells.mixed.data();
  for (std::size_t i = 0; i < in.scan.points.size; ++i) {
    if (slots[i] < 0) continue;
    const auto slot = static_cast<std::size_t>(slots[i]);
    if (mixed[slot] == CellMix::kNone || mixed[slot] == CellMix::kHole) continue;
    if (mixed[slot] == CellMix::kDeck) {
      add_point_of_deck(in, i, slot, cells, costs);
    } else {
      add_point_of_ground(in, i, slot, cells, costs);
    }
  }
}

// Without points: what the cells themselves say.
void add_from_cells(const Input& in, DrivableCells& cells, CellCosts& costs) {
  const FieldCells& field = in.description.field;
  const GridGeometry& geometry = in.description.grid.geometry;
  for (std::size_t slot = 0; slot < cells.mixed.size(); ++slot) {
    const CellMix mix = cells.mixed[slot];
    if (mix == CellMix::kNone || mix == CellMix::kHole) continue;
    const Position2 centre = geometry.centre_of(geometry.index_of(in.description.grid.cell[slot]));
    const bool deck = mix == CellMix::kDeck;
    const auto x = static_cast<float>(centre.x), y = static_cast<float>(centre.y);
    const float z = deck ? field.deck_plane[slot].at(x, y) : field.floor[slot];
    if (deck || field.on[slot] + field.below[slot] > 0) {
      add_drivable(centre.x, centre.y, z, cells.sums[slot], cells.cells[slot]);
    }
    if (deck || field.above[slot] == 0 || field.low[slot] >= in.clear) continue;
    costs.obstacle[slot] = std::min(field.high[slot], in.clear);
    cells.cells[slot].standing = field.above[slot];
  }
}

// What hangs above ground that was not seen may stand on it. It does if something stands beside.
void let_stand(const Input& in, std::size_t slot, const DrivableCells& cells, CellCosts& costs) {
  const FieldCells& field = in.description.field;
  if (field.deck[slot] >= 0 || field.above[slot] == 0) return;
  if (cells.cells[slot].standing > 0) return;
  bool stands = false;
  const std::int32_t id = value_of(in.description.grid.cell[slot]);
  const std::int32_t stride = in.description.grid.geometry.stride();
  for (const std::int32_t row : {id - stride, id, id + stride}) {
    for (std::int32_t at = row - 1; at <= row + 1; ++at) {
      const Slot near = in.description.grid.slot_of[static_cast<std::size_t>(at)];
      if (near == kUnobserved) continue;
      const auto n = static_cast<std::size_t>(near);
      if (field.on[n] > 0) return;  // the ground is seen
      stands = stands || (cells.mixed[n] != CellMix::kNone && cells.cells[n].standing > 0);
    }
  }
  if (stands) costs.obstacle[slot] = field.low[slot];
}

float likelihood_of(const Description& description, std::size_t slot, std::int32_t standing) {
  const std::int32_t cluster = description.clusters.cluster_of[slot];
  const double known = cluster == kNoCluster
                           ? 0.0
                           : description.things[static_cast<std::size_t>(cluster)].confidence;
  return static_cast<float>(known > 0.0 ? known : confidence_of(std::max(standing, 1), 0.0));
}

void finish_cells(const Input& in, DrivableCells& cells, CellCosts& costs) {
  const std::size_t size = cells.mixed.size();
  costs.likely.assign(size, 1.0F);
  costs.ground.assign(size, UnseenReason::kSeen);
  cells.skipped.assign(size, 0);
  for (std::size_t slot = 0; slot < size; ++slot) {
    if (cells.mixed[slot] == CellMix::kNone) continue;
    let_stand(in, slot, cells, costs);
    if (costs.obstacle[slot] > 0.0F)
      costs.likely[slot] = likelihood_of(in.description, slot, cells.cells[slot].standing);
    if (cells.sums[slot].n == 0.0 && costs.hole[slot] < 0) {
      costs.ground[slot] = UnseenReason::kOccluded;
      // Whatever the ground is like below what stands.
      cells.skipped[slot] = costs.obstacle[slot] > 0.0F ? 1 : 0;
    }
    cells.extent[slot] = std::max(0.0F, cells.cells[slot].high - cells.cells[slot].low);
  }
}

// How much the ground around rises from one corner of a cell to the opposite one, metres: by the
// mean height of the ground about it and the nearest cells along the axes. A curb raises that
// little.
float rise_across(const Description& description, std::size_t slot) {
  const ElevationGrid& grid = description.grid;
  const std::vector<float>& rim = description.field.rim;
  const std::int32_t id = value_of(grid.cell[slot]);
  float sum = 0.0F;
  for (const std::int32_t axis : {1, grid.geometry.stride()}) {
    float steepest = 0.0F;
    for (const std::int32_t side : {-axis, axis}) {
      // The frame about the grid has no slots.
      const Slot next = grid.slot_of[static_cast<std::size_t>(id + side)];
      if (next == kUnobserved) continue;
      steepest = std::max(steepest, std::abs(rim[static_cast<std::size_t>(next)] - rim[slot]));
    }
    sum += steepest;
  }
  return sum;
}

// The reference climbs where things are long and low, such as curbs. Where a cell holds points at
// the top and at the foot, they tell the height themselves.
void measure_from_feet(const Input& in, const DrivableCells& cells, CellCosts& costs) {
  for (std::size_t slot = 0; slot < cells.mixed.size(); ++slot) {
    if (cells.mixed[slot] == CellMix::kNone || costs.obstacle[slot] > kLow) continue;
    const MixedCell& cell = cells.cells[slot];
    if (cell.foot_points == 0) continue;
    const float rise = cell.top - cell.foot / static_cast<float>(cell.foot_points);
    if (rise <= costs.obstacle[slot]) continue;
    costs.obstacle[slot] = std::max(costs.obstacle[slot], rise - rise_across(in.description, slot));
  }
}

void measure_doubt(const DrivableCells& cells, CellCosts& costs) {
  costs.doubt.resize(cells.sums.size());
  for (std::size_t slot = 0; slot < costs.doubt.size(); ++slot) {
    const auto points = static_cast<float>(cells.sums[slot].n);
    const bool known = costs.status[slot] == FeatureStatus::kOk && points > 0.0F;
    costs.doubt[slot] = known ? 2.0F * costs.roughness[slot] / std::sqrt(points) : 0.0F;
  }
}

}  // namespace

void compute_cell_costs(const Description& description, const DescribedPoints& scan,
                        const RobotParams& robot, CostWorkspace& workspace, CellCosts& costs) {
  const std::size_t size = description.grid.observed();
  clear_field_parts(costs);
  if (description.field.size() != size || size == 0) {
    compute_cell_costs(description.grid, robot, workspace, costs);
    return;
  }
  const Input in{description, scan, static_cast<float>(robot.height + robot.overhead_reserve)};
  DrivableCells& cells = workspace.drivable;
  find_hole_cells(description, cells.hole_of, costs);
  find_missing_ground(description, robot, costs);
  copy_pure_cells(description, costs, cells);
  costs.obstacle.assign(size, 0.0F);
  if (scan.slots != nullptr && scan.points.size > 0) {
    add_points(in, cells, costs);
  } else {
    add_from_cells(in, cells, costs);
  }
  finish_cells(in, cells, costs);
  measure_ground({description.grid, {cells.sums, &cells.skipped}, &cells.extent}, robot, workspace,
                 costs);
  measure_from_feet(in, cells, costs);
  measure_doubt(cells, costs);
}

DescribedPoints described_points(const PointsView& points, const DescriptionWorkspace& workspace) {
  const bool in_field = workspace.field.points.height.size() == points.size;
  return {points, &workspace.point_slots,
          in_field ? workspace.field.points.height.data() : nullptr};
}

}  // namespace mrpt_terrain
