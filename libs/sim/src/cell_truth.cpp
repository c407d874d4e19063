// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "mrpt_terrain/sim/truth.h"
#include "support_rules.h"

namespace mrpt_terrain::sim {
namespace {

constexpr std::size_t kSamples = static_cast<std::size_t>(kSamplesPerSide * kSamplesPerSide);
constexpr float kNotObserved = std::numeric_limits<float>::quiet_NaN();

using Terrain = std::vector<std::optional<TerrainPoint>>;

/// What a vehicle meets at one place.
struct Surface {
  bool exists = false;
  double height = 0.0;       ///< metres, map frame
  double over_ground = 0.0;  ///< metres
  SurfaceKind kind = SurfaceKind::kDrivable;
  std::int32_t solid = kGroundSolid;
};

/// Height of the form of a medium over a place with terrain; nothing outside of it.
std::optional<double> top_of(const Medium& medium, const Eigen::Vector3d& place) {
  const Eigen::Vector3d own = medium.T_map_medium.inverse() * place;
  const double u = own.x() / medium.half_extent.x(), v = own.y() / medium.half_extent.y();
  if (medium.form == Medium::Form::kLayer) {
    if (std::abs(u) > 1.0 || std::abs(v) > 1.0) return std::nullopt;
    return place.z() + medium.height;
  }
  const double level = u * u + v * v;
  if (level > 1.0) return std::nullopt;
  return medium.T_map_medium.translation().z() + medium.half_extent.z() * std::sqrt(1.0 - level);
}

/// Looks at the places of one row of cells, `kSamples` per cell.
class RowScanner {
 public:
  RowScanner(const RayCaster& caster, double overhang) : caster_(caster), overhang_(overhang) {}

  /// Surfaces at the places, in their order.
  const std::vector<Surface>& scan(const std::vector<double>& x, const std::vector<double>& y) {
    caster_.tops_under(x, y, tops_);
    surfaces_.assign(x.size(), Surface{});
    find_raised(x, y);
    for (std::size_t k = 0; k < x.size(); ++k) {
      if (tops_[k]) put(*tops_[k], 0.0, surfaces_[k]);
    }
    caster_.terrain_under(raised_x_, raised_y_, terrain_);
    put_objects();
    for (const Medium& medium : caster_.world().media) put_medium(medium);
    return surfaces_;
  }

 private:
  static void put(const TerrainPoint& point, double over_ground, Surface& surface) {
    surface = {true, point.height, over_ground, point.kind, point.solid};
  }

  /// Places whose terrain matters: under objects, and everywhere if there is vegetation.
  void find_raised(const std::vector<double>& x, const std::vector<double>& y) {
    const bool all = !caster_.world().media.empty();
    raised_.clear();
    raised_x_.clear();
    raised_y_.clear();
    for (std::size_t k = 0; k < x.size(); ++k) {
      if (!tops_[k] || (!all && tops_[k]->kind != SurfaceKind::kObject)) continue;
      raised_.push_back(k);
      raised_x_.push_back(x[k]);
      raised_y_.push_back(y[k]);
    }
  }

  void put_objects() {
    covered_.clear();
    for (auto* list : {&covered_x_, &covered_y_, &covered_z_}) list->clear();
    for (std::size_t r = 0; r < raised_.size(); ++r) {
      if (!terrain_[r] || surfaces_[raised_[r]].kind != SurfaceKind::kObject) continue;
      covered_.push_back(r);
      covered_x_.push_back(raised_x_[r]);
      covered_y_.push_back(raised_y_[r]);
      covered_z_.push_back(terrain_[r]->height);
    }
    caster_.free_heights_over(covered_x_, covered_y_, covered_z_, free_);
    for (std::size_t c = 0; c < covered_.size(); ++c) {
      const TerrainPoint& ground = *terrain_[covered_[c]];
      Surface& surface = surfaces_[raised_[covered_[c]]];
      surface.over_ground = surface.height - ground.height;
      if (free_[c] >= overhang_) put(ground, 0.0, surface);
    }
  }

  void put_medium(const Medium& medium) {
    for (std::size_t r = 0; r < raised_.size(); ++r) {
      if (!terrain_[r]) continue;
      const double ground = terrain_[r]->height;
      const auto top = top_of(medium, {raised_x_[r], raised_y_[r], ground});
      Surface& surface = surfaces_[raised_[r]];
      if (!top || *top <= surface.height) continue;
      surface = {true, *top, *top - ground, SurfaceKind::kObject, medium.solid};
    }
  }

  const RayCaster& caster_;
  double overhang_;
  Terrain tops_, terrain_;
  std::vector<Surface> surfaces_;
  std::vector<std::size_t> raised_;   ///< places whose terrain is in `terrain_`
  std::vector<std::size_t> covered_;  ///< positions in `raised_` of places under objects
  std::vector<double> raised_x_, raised_y_, covered_x_, covered_y_, covered_z_, free_;
};

void put_heights(const Surface* surfaces, double grid_z, std::size_t cell, CellTruth& truth) {
  double least = 0.0, most = 0.0, sum = 0.0;
  int count = 0;
  for (std::size_t k = 0; k < kSamples; ++k) {
    if (!surfaces[k].exists) continue;
    const double height = surfaces[k].height - grid_z;
    least = count == 0 ? height : std::min(least, height);
    most = count == 0 ? height : std::max(most, height);
    sum += height;
    ++count;
  }
  truth.min[cell] = count == 0 ? kNotObserved : static_cast<float>(least);
  truth.max[cell] = count == 0 ? kNotObserved : static_cast<float>(most);
  truth.mean[cell] = count == 0 ? kNotObserved : static_cast<float>(sum / count);
}

/// Support and class of a cell from its places.
void put_labels(const Surface* surfaces, const World& world, const SupportRules& rules,
                std::size_t cell, CellTruth& truth) {
  std::array<Support, kSamples> support;
  std::array<std::size_t, 4> supports{};
  std::size_t places = 0;
  for (std::size_t k = 0; k < kSamples; ++k) {
    if (!surfaces[k].exists) continue;
    support[k] = rules.support(surfaces[k].solid, surfaces[k].kind, surfaces[k].over_ground);
    ++supports[static_cast<std::size_t>(support[k])];
    ++places;
  }
  Support label = Support::kUnknown;
  if (supports[static_cast<std::size_t>(Support::kAbove)] > 0) {
    label = Support::kAbove;
  } else if (places > 0 && 2 * supports[static_cast<std::size_t>(Support::kGround)] >= places) {
    label = Support::kGround;
  }
  std::array<std::size_t, 5> classes{};
  for (std::size_t k = 0; k < kSamples; ++k) {
    if (!surfaces[k].exists) continue;
    const bool flank = surfaces[k].kind == SurfaceKind::kFlank && label != Support::kAbove;
    if (support[k] != label && !flank) continue;
    const auto solid = static_cast<std::size_t>(surfaces[k].solid);
    ++classes[static_cast<std::size_t>(world.solids[solid].terrain_class)];
  }
  truth.support[cell] = label;
  truth.terrain_class[cell] =
      static_cast<TerrainClass>(std::max_element(classes.begin(), classes.end()) - classes.begin());
}

void put_ground(const std::optional<TerrainPoint>& ground, const Eigen::Matrix3d& grid_axes,
                double grid_z, std::size_t cell, CellTruth& truth) {
  if (!ground) return;
  const Eigen::Vector3d normal = grid_axes.transpose() * ground->normal;
  const double level = normal.head<2>().norm();
  truth.ground_height[cell] = static_cast<float>(ground->height - grid_z);
  truth.slope[cell] = static_cast<float>(std::atan2(level, normal.z()));
  // The terrain rises against the horizontal part of its normal.
  truth.slope_direction[cell] =
      level == 0.0 ? 0.0F : static_cast<float>(std::atan2(-normal.y(), -normal.x()));
}

CellTruth empty_truth(const GridGeometry& geometry) {
  const auto n =
      static_cast<std::size_t>(geometry.cells_l()) * static_cast<std::size_t>(geometry.cells_w());
  CellTruth truth;
  truth.geometry = geometry;
  for (auto* heights : {&truth.min, &truth.mean, &truth.max, &truth.ground_height, &truth.slope,
                        &truth.slope_direction}) {
    heights->assign(n, kNotObserved);
  }
  truth.support.assign(n, Support::kUnknown);
  truth.terrain_class.assign(n, TerrainClass::kNone);
  return truth;
}

/// Horizontal pose of a grid.
struct GridPlane {
  Eigen::Matrix3d axes;  ///< turned about the vertical only
  Eigen::Vector3d origin;

  explicit GridPlane(const Eigen::Isometry3d& T_map_grid)
      : axes(Eigen::AngleAxisd(std::atan2(T_map_grid(1, 0), T_map_grid(0, 0)),
                               Eigen::Vector3d::UnitZ())
                 .toRotationMatrix()),
        origin(T_map_grid.translation()) {}
  [[nodiscard]] Eigen::Vector2d place(double x, double y) const {
    return origin.head<2>() + axes.topLeftCorner<2, 2>() * Eigen::Vector2d(x, y);
  }
};

/// Places in the map frame: `per_side` x `per_side` in each cell of row l.
void places_of_row(const GridGeometry& geometry, const GridPlane& grid, int l, int per_side,
                   std::vector<double>& x, std::vector<double>& y) {
  x.clear();
  y.clear();
  const auto offset = [&](int k) { return ((k + 0.5) / per_side - 0.5) * geometry.cell_size(); };
  for (int w = 0; w < geometry.cells_w(); ++w) {
    const Position2 centre = geometry.centre_of({l, w});
    for (int i = 0; i < per_side; ++i) {
      for (int j = 0; j < per_side; ++j) {
        const Eigen::Vector2d place = grid.place(centre.x + offset(i), centre.y + offset(j));
        x.push_back(place.x());
        y.push_back(place.y());
      }
    }
  }
}

}  // namespace

CellTruth truth_of_cells(const RayCaster& caster, const Eigen::Isometry3d& T_map_grid,
                         const GridGeometry& geometry, double overhang) {
  const GridPlane grid(T_map_grid);
  const double grid_z = grid.origin.z();
  const SupportRules rules(caster.world());
  CellTruth truth = empty_truth(geometry);
  RowScanner scanner(caster, overhang);
  std::vector<double> x, y;
  Terrain ground;
  std::size_t cell = 0;
  for (int l = 0; l < geometry.cells_l(); ++l) {
    places_of_row(geometry, grid, l, 1, x, y);
    caster.terrain_under(x, y, ground);
    places_of_row(geometry, grid, l, kSamplesPerSide, x, y);
    const Surface* surfaces = scanner.scan(x, y).data();
    for (const auto& under_centre : ground) {
      put_ground(under_centre, grid.axes, grid_z, cell, truth);
      put_heights(surfaces, grid_z, cell, truth);
      put_labels(surfaces, caster.world(), rules, cell, truth);
      surfaces += kSamples;
      ++cell;
    }
  }
  return truth;
}

}  // namespace mrpt_terrain::sim
