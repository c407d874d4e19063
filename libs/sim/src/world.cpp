// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/sim/world.h"

#include <cmath>
#include <set>

#include "holes.h"
#include "solid_bodies.h"
#include "terrain.h"

namespace mrpt_terrain::sim {
namespace {

constexpr int kRimCorners = 48;

std::string number(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

// "scene.yaml:12: solids[3] pothole".
std::string place_of(const Scene& scene, std::size_t k) {
  const Solid& solid = scene.solids[k];
  if (!solid.source.empty()) return solid.source;
  const std::string file = scene.source.empty() ? "scene" : scene.source;
  return file + ": solids[" + std::to_string(k) + "] " + type_of(solid.shape);
}

void check_ids(const Scene& scene) {
  std::set<int> taken;
  for (std::size_t k = 0; k < scene.solids.size(); ++k) {
    const int id = scene.solids[k].placement.id;
    if (id != 0 && !taken.insert(id).second) {
      throw SceneError(place_of(scene, k) + " id = " + std::to_string(id) +
                       ": must be unique in the scene");
    }
  }
}

void check_footprint(const Scene& scene, std::size_t k, const GroundSurface& ground) {
  for (const Eigen::Vector2d& corner : footprint_of(scene.solids[k])) {
    if (ground.contains(corner.x(), corner.y())) continue;
    throw SceneError(place_of(scene, k) + ": reaches to (" + number(corner.x()) + ", " +
                     number(corner.y()) + "): must lie on the ground, x " +
                     number(ground.min_corner().x()) + " to " + number(ground.max_corner().x()) +
                     ", y " + number(ground.min_corner().y()) + " to " +
                     number(ground.max_corner().y()));
  }
}

/// Numbers of potholes and ditches under one name.
struct HoleForm {
  RimForm form;
  double length, width, depth, wall_angle;
};
const HoleForm* hole_form_of(const Shape& shape, HoleForm& form) {
  if (const auto* pothole = std::get_if<Pothole>(&shape)) {
    form = {pothole->form, pothole->length, pothole->width, pothole->depth, pothole->wall_angle};
    return &form;
  }
  if (const auto* ditch = std::get_if<Ditch>(&shape)) {
    form = {RimForm::kRectangle, ditch->length, ditch->width, ditch->depth, ditch->wall_angle};
    return &form;
  }
  return nullptr;
}

Polygon rim_of(const HoleForm& form, const Eigen::Vector2d& centre, double yaw) {
  return form.form == RimForm::kRectangle
             ? turned_rectangle(centre, yaw, form.length, form.width)
             : turned_ellipse(centre, yaw, form.length, form.width, kRimCorners);
}

// How far the walls reach inwards, metres.
double run_of(const HoleForm& form) { return form.depth / std::tan(form.wall_angle); }

Hole hole_of(const Scene& scene, std::size_t k, const HoleForm& form) {
  const Placement& place = scene.solids[k].placement;
  Hole hole;
  hole.solid = static_cast<std::int32_t>(k) + 1;
  hole.depth = form.depth;
  hole.wall_angle = form.wall_angle;
  hole.rim = rim_of(form, {place.x, place.y}, place.yaw);
  hole.floor = hole.rim;
  const double run = run_of(form);
  if (run < 1e-6) return hole;
  const std::optional<Polygon> floor = inset(hole.rim, run);
  if (!floor) {
    throw SceneError(place_of(scene, k) + " depth = " + number(form.depth) +
                     ": walls of that angle take " + number(run) +
                     " m on every side and must leave a floor");
  }
  hole.floor = *floor;
  return hole;
}

std::vector<Hole> holes_of(const Scene& scene) {
  std::vector<Hole> holes;
  for (std::size_t k = 0; k < scene.solids.size(); ++k) {
    HoleForm form{};
    if (hole_form_of(scene.solids[k].shape, form) == nullptr) continue;
    Hole hole = hole_of(scene, k, form);
    for (const Hole& other : holes) {
      if (!overlap(hole.rim, other.rim)) continue;
      throw SceneError(place_of(scene, k) + ": overlaps solids[" + std::to_string(other.solid - 1) +
                       "]: holes must not overlap");
    }
    holes.push_back(std::move(hole));
  }
  return holes;
}

WorldSolid facts_of(const Solid& solid) {
  WorldSolid facts;
  facts.id = solid.placement.id;
  facts.type = type_of(solid.shape);
  facts.material = solid.placement.material;
  facts.terrain_class = solid.placement.terrain_class == TerrainClass::kNone
                            ? usual_class(solid.shape)
                            : solid.placement.terrain_class;
  return facts;
}

void measure_hole(const HoleForm& form, const Placement& place, const GroundSurface& ground,
                  WorldSolid& facts) {
  facts.height = -form.depth;
  facts.length = form.length;
  facts.width = form.width;
  facts.T_map_solid.translation() =
      Eigen::Vector3d(place.x, place.y, ground.height(place.x, place.y));
  facts.T_map_solid.linear() =
      Eigen::AngleAxisd(place.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

}  // namespace

World build_world(const Scene& scene) {
  check_ids(scene);
  const std::string source = scene.source.empty() ? "scene" : scene.source;
  const GroundSurface ground(scene.ground, source + ": [ground]");
  for (std::size_t k = 0; k < scene.solids.size(); ++k) check_footprint(scene, k, ground);
  const std::vector<Hole> holes = holes_of(scene);

  World world;
  world.min_corner = ground.min_corner();
  world.max_corner = ground.max_corner();
  WorldSolid ground_facts;
  ground_facts.material = scene.ground.material;
  ground_facts.slope = scene.ground.slope;
  ground_facts.length = scene.ground.length;
  ground_facts.width = scene.ground.width;
  world.solids.push_back(ground_facts);
  for (const Solid& solid : scene.solids) world.solids.push_back(facts_of(solid));

  add_ground(ground, holes, world.mesh);
  Terrain terrain(ground, holes);
  for (std::size_t k = 0; k < scene.solids.size(); ++k) {
    const auto index = static_cast<std::int32_t>(k) + 1;
    HoleForm form{};
    if (hole_form_of(scene.solids[k].shape, form) != nullptr) {
      measure_hole(form, scene.solids[k].placement, ground, world.solids[k + 1]);
    } else {
      add_body(scene.solids[k], index, terrain, world);
    }
  }
  return world;
}

bool leaves_floor(const Shape& shape) {
  // Rounding at other places must not decide.
  constexpr double kMargin = 1.001;
  HoleForm form{};
  if (hole_form_of(shape, form) == nullptr) return true;
  return inset(rim_of(form, Eigen::Vector2d::Zero(), 0.0), kMargin * run_of(form)).has_value();
}

}  // namespace mrpt_terrain::sim
