// SPDX-License-Identifier: BSD-3-Clause
#include "solid_bodies.h"

#include <algorithm>
#include <cmath>

#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain::sim {
namespace {

constexpr int kRoundFacets = 64;
constexpr int kLimbFacets = 12;

Eigen::Isometry3d upright_pose(double x, double y, double z, double yaw) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(x, y, z);
  pose.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return pose;
}

Eigen::Isometry3d shifted(const Eigen::Isometry3d& pose, double x, double y, double z) {
  return pose * Eigen::Translation3d(x, y, z);
}

/// One body being put into the world.
class BodyBuilder {
 public:
  BodyBuilder(const Solid& solid, std::int32_t index, Terrain& terrain, World& world)
      : place_(solid.placement),
        index_(index),
        terrain_(terrain),
        world_(world),
        facts_(world.solids[static_cast<std::size_t>(index)]),
        mesh_(world.mesh, index),
        base_(terrain.height(place_.x, place_.y)),
        bottom_(terrain.lowest(footprint_of(solid)) - base_),
        pose_(upright_pose(place_.x, place_.y, base_, place_.yaw)) {
    facts_.T_map_solid = pose_;
  }

  void operator()(const Ramp& ramp) {
    const double height = ramp.length * std::tan(ramp.angle);
    Profile profile{{0.0, 0.0}, {ramp.length, height}};
    double end = ramp.length;
    if (ramp.platform > 0.0) profile.emplace_back(end += ramp.platform, height);
    if (ramp.way_down) profile.emplace_back(end += ramp.length, 0.0);
    add_drivable(profile, ramp.width);
    measure(height, end, ramp.width, ramp.angle);
  }
  void operator()(const Curb& curb) {
    add_drivable({{-curb.length / 2, curb.height}, {curb.length / 2, curb.height}}, curb.width);
    measure(curb.height, curb.length, curb.width);
  }
  void operator()(const Stairs& stairs) {
    Profile profile{{0.0, 0.0}};
    for (int step = 0; step < stairs.steps; ++step) {
      profile.emplace_back(step * stairs.tread, (step + 1) * stairs.riser);
      profile.emplace_back((step + 1) * stairs.tread, (step + 1) * stairs.riser);
    }
    mesh_.add_profile(pose_, profile, stairs.width, bottom_, SurfaceKind::kObject);
    measure(stairs.steps * stairs.riser, stairs.steps * stairs.tread, stairs.width);
  }
  void operator()(const Wall& wall) {
    add_block(wall.length, wall.thickness, wall.height);
    measure(wall.height, wall.length, wall.thickness);
  }
  void operator()(const Box& box) {
    measure(box.height + box.lift, box.length, box.width);
    if (box.tilt == 0.0 && box.lift == 0.0) return add_block(box.length, box.width, box.height);
    const double raised = box.length / 2 * std::abs(std::sin(box.tilt));
    Eigen::Isometry3d pose = shifted(pose_, 0.0, 0.0, box.lift + raised);
    pose.rotate(Eigen::AngleAxisd(box.tilt, Eigen::Vector3d::UnitY()));
    mesh_.add_box(pose, {box.length, box.width, box.height});
    facts_.T_map_solid = pose;
    facts_.height = box.lift + 2 * raised + box.height * std::cos(box.tilt);
    facts_.slope = std::abs(box.tilt);
  }
  void operator()(const Cylinder& cylinder) { add_round(cylinder.radius, cylinder.height); }
  void operator()(const Pole& pole) { add_round(pole.radius, pole.height); }

  void operator()(const Table& table) {
    mesh_.add_box(shifted(pose_, 0.0, 0.0, table.clearance),
                  {table.length, table.width, table.thickness});
    const double x = (table.length - table.leg) / 2;
    const double y = (table.width - table.leg) / 2;
    for (const auto& [sx, sy] : {std::pair{-x, -y}, {x, -y}, {x, y}, {-x, y}}) {
      mesh_.add_box(shifted(pose_, sx, sy, bottom_),
                    {table.leg, table.leg, table.clearance - bottom_});
    }
    measure(table.clearance + table.thickness, table.length, table.width);
  }
  void operator()(const Bridge& bridge) {
    const double width = bridge.width + 2 * bridge.wall;
    mesh_.add_box(shifted(pose_, 0.0, 0.0, bridge.clearance),
                  {bridge.length, width, bridge.thickness});
    for (const double side : {-1.0, 1.0}) {
      mesh_.add_box(shifted(pose_, 0.0, side * (bridge.width + bridge.wall) / 2, bottom_),
                    {bridge.length, bridge.wall, bridge.clearance - bottom_});
    }
    measure(bridge.clearance + bridge.thickness, bridge.length, width);
  }
  void operator()(const Rubble& rubble) {
    RandomGenerator random(rubble.seed);
    for (int k = 0; k < rubble.stones; ++k) add_stone(rubble, random);
    measure(rubble.height, 2 * rubble.radius, 2 * rubble.radius);
  }
  void operator()(const Grass& grass) {
    Medium medium;
    medium.form = Medium::Form::kLayer;
    medium.half_extent = {grass.length / 2, grass.width / 2, 0.0};
    medium.height = grass.height;
    add_medium(medium, grass.density, 0.0);
    measure(grass.height, grass.length, grass.width);
  }
  void operator()(const Bush& bush) {
    Medium medium;
    medium.form = Medium::Form::kEllipsoid;
    medium.half_extent = {bush.radius, bush.radius, bush.height / 2};
    add_medium(medium, bush.density, bush.height / 2);
    measure(bush.height, 2 * bush.radius, 2 * bush.radius);
  }
  void operator()(const Person& person) {
    Mover mover;
    mover.solid = index_;
    mover.speed = person.speed;
    mover.from = pose_.translation();
    mover.to = pose_ * Eigen::Vector3d(person.distance, 0.0, 0.0);
    mover.to.z() = terrain_.height(mover.to.x(), mover.to.y());
    add_figure(person.height, mover.mesh);
    world_.movers.push_back(std::move(mover));
    measure(person.height, 0.2 * person.height, 0.27 * person.height);
  }
  void operator()(const Pothole&) {}  // cut out of the ground
  void operator()(const Ditch&) {}

 private:
  void measure(double height, double length, double width, double slope = 0.0) {
    facts_.height = height;
    facts_.length = length;
    facts_.width = width;
    facts_.slope = slope;
  }
  void add_drivable(const Profile& profile, double width) {
    mesh_.add_profile(pose_, profile, width, bottom_, SurfaceKind::kDrivable);
    terrain_.add({pose_.inverse(), profile, width});
  }
  void add_block(double length, double width, double height) {
    mesh_.add_box(shifted(pose_, 0.0, 0.0, bottom_), {length, width, height - bottom_});
  }
  void add_round(double radius, double height) {
    mesh_.add_prism(shifted(pose_, 0.0, 0.0, bottom_), radius, radius, height - bottom_,
                    kRoundFacets);
    measure(height, 2 * radius, 2 * radius);
  }
  void add_medium(Medium& medium, double density, double centre_height) {
    medium.solid = index_;
    medium.density = density;
    medium.T_map_medium = shifted(pose_, 0.0, 0.0, centre_height);
    world_.media.push_back(medium);
  }

  // A cuboid of random sides and attitude; the heap is a paraboloid, full towards its foot.
  void add_stone(const Rubble& rubble, RandomGenerator& random) {
    const double distance = rubble.radius * std::sqrt(random.uniform());
    const double angle = 2 * M_PI * random.uniform();
    const double x = place_.x + distance * std::cos(angle);
    const double y = place_.y + distance * std::sin(angle);
    const double share = distance / rubble.radius;
    const double up = rubble.height * (1.0 - share * share) * random.uniform();
    const Eigen::Vector3d size =
        rubble.stone *
        Eigen::Vector3d(0.5 + random.uniform(), 0.5 + random.uniform(), 0.5 + random.uniform());
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = Eigen::Vector3d(x, y, terrain_.height(x, y) + up);
    for (const Eigen::Vector3d& axis :
         {Eigen::Vector3d::UnitZ().eval(), Eigen::Vector3d::UnitY().eval(),
          Eigen::Vector3d::UnitX().eval()}) {
      pose.rotate(Eigen::AngleAxisd(2 * M_PI * random.uniform(), axis));
    }
    mesh_.add_box(shifted(pose, 0.0, 0.0, -size.z() / 2), size);
  }

  // Legs, trunk with arms, head, in the proportions of an adult.
  void add_figure(double height, Mesh& mesh) const {
    MeshBuilder body(mesh, index_);
    const auto add = [&](double x, double y, double from, double to, double rx, double ry) {
      body.add_prism(upright_pose(x * height, y * height, from * height, 0.0), rx * height,
                     ry * height, (to - from) * height, kLimbFacets);
    };
    add(0.06, -0.05, 0.0, 0.48, 0.045, 0.045);
    add(-0.06, 0.05, 0.0, 0.48, 0.045, 0.045);
    add(0.0, 0.0, 0.47, 0.83, 0.07, 0.11);
    add(-0.04, -0.13, 0.42, 0.81, 0.025, 0.025);
    add(0.04, 0.13, 0.42, 0.81, 0.025, 0.025);
    add(0.0, 0.0, 0.82, 0.87, 0.03, 0.03);
    add(0.0, 0.0, 0.87, 1.0, 0.055, 0.045);
  }

  const Placement& place_;
  std::int32_t index_;
  Terrain& terrain_;
  World& world_;
  WorldSolid& facts_;
  MeshBuilder mesh_;
  double base_;    ///< height of the terrain under the origin
  double bottom_;  ///< of the body, relative to `base_`
  Eigen::Isometry3d pose_;
};

/// Extent of a shape along its own axes, and how far its middle lies ahead of its origin.
struct Extent {
  double length = 0.0, width = 0.0, ahead = 0.0;
};
struct ExtentOf {
  Extent operator()(const Ramp& s) const {
    const double length = s.length * (s.way_down ? 2.0 : 1.0) + s.platform;
    return {length, s.width, length / 2};
  }
  Extent operator()(const Stairs& s) const {
    return {s.steps * s.tread, s.width, s.steps * s.tread / 2};
  }
  Extent operator()(const Box& s) const {
    const double tilted = s.length * std::cos(s.tilt) + s.height * std::abs(std::sin(s.tilt));
    return {s.tilt == 0.0 ? s.length : tilted, s.width};
  }
  Extent operator()(const Curb& s) const { return {s.length, s.width}; }
  Extent operator()(const Wall& s) const { return {s.length, s.thickness}; }
  Extent operator()(const Pole& s) const { return {2 * s.radius, 2 * s.radius}; }
  Extent operator()(const Cylinder& s) const { return {2 * s.radius, 2 * s.radius}; }
  Extent operator()(const Table& s) const { return {s.length, s.width}; }
  Extent operator()(const Bridge& s) const { return {s.length, s.width + 2 * s.wall}; }
  Extent operator()(const Pothole& s) const { return {s.length, s.width}; }
  Extent operator()(const Ditch& s) const { return {s.length, s.width}; }
  Extent operator()(const Rubble& s) const { return {2 * s.radius, 2 * s.radius}; }
  Extent operator()(const Grass& s) const { return {s.length, s.width}; }
  Extent operator()(const Bush& s) const { return {2 * s.radius, 2 * s.radius}; }
  Extent operator()(const Person& s) const {
    return {s.distance + 0.2 * s.height, 0.27 * s.height, s.distance / 2};
  }
};

}  // namespace

Polygon footprint_of(const Solid& solid) {
  const Extent extent = std::visit(ExtentOf{}, solid.shape);
  const Placement& place = solid.placement;
  const Eigen::Vector2d middle(place.x + extent.ahead * std::cos(place.yaw),
                               place.y + extent.ahead * std::sin(place.yaw));
  return turned_rectangle(middle, place.yaw, extent.length, extent.width);
}

void add_body(const Solid& solid, std::int32_t index, Terrain& terrain, World& world) {
  std::visit(BodyBuilder(solid, index, terrain, world), solid.shape);
}

}  // namespace mrpt_terrain::sim
