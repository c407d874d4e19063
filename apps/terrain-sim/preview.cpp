// SPDX-License-Identifier: BSD-3-Clause
#include "preview.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "mrpt_terrain/view/site_plan.h"
#include "mrpt_terrain/view/text.h"
#include "surroundings.h"

using namespace mrpt_terrain;

namespace {

constexpr double kFootRadius = 0.3;  // metres, of things that walk

/// The ground is no thing of the plan.
std::int32_t thing_of(std::int32_t solid) { return solid <= sim::kGroundSolid ? -1 : solid - 1; }

std::vector<view::PlanThing> things_of(const sim::World& world) {
  std::vector<view::PlanThing> things;
  for (std::size_t k = 1; k < world.solids.size(); ++k) {
    const sim::WorldSolid& solid = world.solids[k];
    const auto& place = solid.T_map_solid.translation();
    things.push_back(
        {solid.id, solid.type, solid.terrain_class, solid.height, {place.x(), place.y()}});
  }
  return things;
}

/// Centre of a pixel.
Eigen::Vector2d place_of(const view::SitePlan& plan, int column, int row) {
  const view::PlanExtent& extent = plan.extent;
  const double scale = plan.heights.width / (extent.x_max - extent.x_min);
  return {extent.x_min + (column + 0.5) / scale, extent.y_max - (row + 0.5) / scale};
}

void sample_surfaces(const sim::RayCaster& caster, view::SitePlan& plan) {
  std::vector<double> x, y;
  std::vector<std::optional<sim::TerrainPoint>> tops;
  for (int row = 0; row < plan.heights.height; ++row) {
    x.clear();
    y.clear();
    for (int column = 0; column < plan.heights.width; ++column) {
      const Eigen::Vector2d place = place_of(plan, column, row);
      x.push_back(place.x());
      y.push_back(place.y());
    }
    caster.tops_under(x, y, tops);
    for (int column = 0; column < plan.heights.width; ++column) {
      const auto& top = tops[static_cast<std::size_t>(column)];
      plan.heights.at(column, row) =
          top ? static_cast<float>(top->height) : std::numeric_limits<float>::quiet_NaN();
      plan.thing.at(column, row) = top ? thing_of(top->solid) : -1;
    }
  }
}

bool covers(const sim::Medium& medium, const Eigen::Vector2d& place) {
  const Eigen::Isometry3d& T = medium.T_map_medium;
  const Eigen::Vector3d inside =
      T.inverse() * Eigen::Vector3d(place.x(), place.y(), T.translation().z());
  const double u = inside.x() / medium.half_extent.x();
  const double v = inside.y() / medium.half_extent.y();
  return medium.form == sim::Medium::Form::kEllipsoid ? u * u + v * v <= 1.0
                                                      : std::max(std::abs(u), std::abs(v)) <= 1.0;
}

bool covers(const sim::Mover& mover, const Eigen::Vector2d& place) {
  return (mover.from.head<2>() - place).norm() <= kFootRadius;
}

/// Vegetation and walkers have no surface that stands still: their footprints are tinted where
/// nothing else lies.
template <class Thing>
void tint_footprints(const std::vector<Thing>& things, view::SitePlan& plan) {
  for (int row = 0; row < plan.thing.height && !things.empty(); ++row) {
    for (int column = 0; column < plan.thing.width; ++column) {
      std::int32_t& pixel = plan.thing.at(column, row);
      const Eigen::Vector2d place = place_of(plan, column, row);
      for (const Thing& thing : things) {
        if (pixel < 0 && covers(thing, place)) pixel = thing_of(thing.solid);
      }
    }
  }
}

}  // namespace

void write_preview(const std::string& file, const Simulation& simulation) {
  const sim::World& world = simulation.world;
  view::SitePlan plan;
  plan.title = simulation.file.scene.name;
  for (const Eigen::Vector2d& place : path_of(simulation.motion)) {
    plan.path.push_back({place.x(), place.y()});
  }
  const Surroundings around = surroundings_of(simulation);
  plan.extent = {around.low.x(), around.high.x(), around.low.y(), around.high.y()};
  plan.subtitle = view::fixed(plan.extent.x_max - plan.extent.x_min, 0) + " m x " +
                  view::fixed(plan.extent.y_max - plan.extent.y_min, 0) + " m, " +
                  std::to_string(world.solids.size() - 1) + " things;  " +
                  simulation.sensor.model.name + " " +
                  view::fixed(simulation.params.vehicle.sensor_z, 2) + " m above the ground, " +
                  std::to_string(simulation.starts.size()) + " sweeps";
  const view::PanelSize size = view::plan_panel_size(plan.extent);
  plan.heights = view::Raster<float>(size.width, size.height);
  plan.thing = view::Raster<std::int32_t>(size.width, size.height);
  sample_surfaces(*simulation.caster, plan);
  tint_footprints(world.media, plan);
  tint_footprints(world.movers, plan);
  plan.things = things_of(world);
  const Eigen::Vector3d ahead = simulation.motion.at(simulation.motion.start()).linear().col(0);
  plan.yaw = std::atan2(ahead.y(), ahead.x());
  view::write_site_plan(file, plan);
}
