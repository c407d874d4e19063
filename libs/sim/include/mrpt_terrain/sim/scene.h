// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "mrpt_terrain/core/labels.h"
#include "mrpt_terrain/core/param_info.h"

/// \file
/// What a simulated scene consists of. Every shape is a struct of numbers that describes itself
/// (core/param_info.h), so that loader, range check and doc/scenes.md share one list. Map frame:
/// x east, y north, z up; metres, radians, seconds.
namespace mrpt_terrain::sim {

/// A scene is wrong. The message names file, key, value and rule.
class SceneError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What a surface is made of: decides how much light returns.
enum class Material : std::uint8_t {
  kAsphalt,
  kConcrete,
  kSoil,
  kGravel,
  kGrass,
  kFoliage,
  kWood,
  kBrick,
  kMetal,
  kPlastic,
  kCloth
};
constexpr EnumNames<Material, 11> enum_names(Material) {
  return {{{Material::kAsphalt, "asphalt"},
           {Material::kConcrete, "concrete"},
           {Material::kSoil, "soil"},
           {Material::kGravel, "gravel"},
           {Material::kGrass, "grass"},
           {Material::kFoliage, "foliage"},
           {Material::kWood, "wood"},
           {Material::kBrick, "brick"},
           {Material::kMetal, "metal"},
           {Material::kPlastic, "plastic"},
           {Material::kCloth, "cloth"}}};
}

enum class GroundForm : std::uint8_t { kPlane, kHeightMap, kFractal };
constexpr EnumNames<GroundForm, 3> enum_names(GroundForm) {
  return {{{GroundForm::kPlane, "plane"},
           {GroundForm::kHeightMap, "height_map"},
           {GroundForm::kFractal, "fractal"}}};
}

/// The ground: a rectangle about (x, y) whose heights are a plane through z = 0 there, the numbers
/// of a file, or a sum of octaves of smooth noise on top of the plane.
struct Ground {
  GroundForm form = GroundForm::kPlane;
  double x = 0.0, y = 0.0;
  double length = 40.0;          ///< along x
  double width = 40.0;           ///< along y
  double slope = 0.0;            ///< of the plane, radians
  double slope_direction = 0.0;  ///< where the plane rises, from x towards y, radians
  double spacing = 0.1;          ///< of the mesh of height maps and fractals
  double amplitude = 0.5;        ///< of the lowest octave of a fractal, metres
  double wavelength = 10.0;      ///< of the lowest octave, metres
  double persistence = 0.45;     ///< amplitude of an octave relative to the one below
  int octaves = 5;
  double max_slope = 0.4363323129985824;  ///< a fractal is flattened as a whole to stay below this
  double flat_radius = 0.0;               ///< fractals fade in outside this radius about (x, y)
  std::uint64_t seed = 1;
  Material material = Material::kAsphalt;
  /// Of a height map: text file of rows of heights in metres, blanks between, the first row at the
  /// smallest y; spread over length and width. Relative to the folder of the scene.
  std::string file;

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.form, ParamInfo{"form", "", "", 0, 0, "where the heights come from"});
    visit(self.x, ParamInfo{"x", "", "m", -1e5, 1e5, "centre"});
    visit(self.y, ParamInfo{"y", "", "m", -1e5, 1e5, "centre"});
    visit(self.length, ParamInfo{"length", "", "m", 1.0, 2000.0, "extent along x"});
    visit(self.width, ParamInfo{"width", "", "m", 1.0, 2000.0, "extent along y"});
    visit(self.slope, ParamInfo{"slope_deg", "", "deg", 0.0, 60.0, "inclination of the plane"});
    visit(self.slope_direction, ParamInfo{"slope_direction_deg", "", "deg", -360.0, 360.0,
                                          "where the plane rises, from x towards y"});
    visit(self.spacing, ParamInfo{"spacing", "", "m", 0.01, 10.0, "of the mesh of uneven ground"});
    visit(self.amplitude,
          ParamInfo{"amplitude", "", "m", 0.0, 100.0, "of the lowest octave of a fractal"});
    visit(self.wavelength,
          ParamInfo{"wavelength", "", "m", 0.1, 1000.0, "of the lowest octave of a fractal"});
    visit(self.persistence, ParamInfo{"persistence", "", "", 0.0, 1.0,
                                      "amplitude of an octave relative to the one below"});
    visit(self.octaves, ParamInfo{"octaves", "", "", 1, 12, "of a fractal"});
    visit(self.max_slope, ParamInfo{"max_slope_deg", "", "deg", 0.1, 60.0,
                                    "a fractal is flattened as a whole to stay below this"});
    visit(self.flat_radius, ParamInfo{"flat_radius", "", "m", 0.0, 1000.0,
                                      "a fractal fades in outside this radius about its centre"});
    visit(self.seed, ParamInfo{"seed", "", "", 0, 9e15, "of a fractal"});
    visit(self.material, ParamInfo{"material", "", "", 0, 0, "what it is made of"});
  }
};

/// Wedge whose drivable top rises along its x axis from the ground at x = 0, with an optional flat
/// platform and way down behind it.
struct Ramp {
  static constexpr const char* kType = "ramp";
  double length = 1.2;  ///< of the rise, measured horizontally
  double width = 1.0;
  double angle = 0.17453292519943295;  ///< radians: 10 degrees
  double platform = 0.0;
  bool way_down = false;  ///< falls behind the platform as it rose
  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.length, ParamInfo{"length", "", "m", 0.05, 200.0, "horizontal length of the rise"});
    visit(self.width, ParamInfo{"width", "", "m", 0.05, 200.0, "across the rise"});
    visit(self.angle, ParamInfo{"angle_deg", "", "deg", 0.1, 80.0, "inclination"});
    visit(self.platform, ParamInfo{"platform", "", "m", 0.0, 200.0, "flat part behind the rise"});
    visit(self.way_down,
          ParamInfo{"way_down", "", "", 0, 0, "falls behind the platform as it rose"});
  }
};

/// Box that stands on the ground, or in the air with `lift`.
struct Box {
  static constexpr const char* kType = "box";
  double length = 0.4, width = 0.4, height = 0.3;
  double lift = 0.0;
  double tilt = 0.0;  ///< about its y axis, radians
  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.length, ParamInfo{"length", "", "m", 0.005, 200.0, "along its x axis"});
    visit(self.width, ParamInfo{"width", "", "m", 0.005, 200.0, "along its y axis"});
    visit(self.height, ParamInfo{"height", "", "m", 0.005, 100.0, "of its top above its bottom"});
    visit(self.lift, ParamInfo{"lift", "", "m", 0.0, 100.0, "of its bottom above the ground"});
    visit(self.tilt, ParamInfo{"tilt_deg", "", "deg", -90.0, 90.0, "about its y axis"});
  }
};

/// Long box with a drivable top.
struct Curb {
  static constexpr const char* kType = "curb";
  double length = 10.0, width = 0.3, height = 0.12;
  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.length, ParamInfo{"length", "", "m", 0.05, 500.0, "along its x axis"});
    visit(self.width, ParamInfo{"width", "", "m", 0.02, 100.0, "along its y axis"});
    visit(self.height, ParamInfo{"height", "", "m", 0.01, 0.5, "of its top above the ground"});
  }
};

/// Steps that rise along the x axis from x = 0, closed at the back.
struct Stairs {
  static constexpr const char* kType = "stairs";
  int steps = 5;
  double tread = 0.3, riser = 0.17, width = 1.5;
  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.steps, ParamInfo{"steps", "", "", 1, 200, "number of steps"});
    visit(self.tread, ParamInfo{"tread", "", "m", 0.05, 5.0, "depth of a step"});
    visit(self.riser, ParamInfo{"riser", "", "m", 0.01, 1.0, "height of a step"});
    visit(self.width, ParamInfo{"width", "", "m", 0.05, 100.0, "of the steps"});
  }
};

/// Upright wall along its x axis.
struct Wall {
  static constexpr const char* kType = "wall";
  double length = 5.0, thickness = 0.2, height = 2.0;
  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.length, ParamInfo{"length", "", "m", 0.05, 500.0, "along its x axis"});
    visit(self.thickness, ParamInfo{"thickness", "", "m", 0.01, 10.0, "along its y axis"});
    visit(self.height, ParamInfo{"height", "", "m", 0.02, 100.0, "of its top above the ground"});
  }
};

/// Upright cylinder: pole, trunk, barrel.
struct Cylinder {
  static constexpr const char* kType = "cylinder";
  double radius = 0.3, height = 1.0;
  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.radius, ParamInfo{"radius", "", "m", 0.005, 50.0, "of its round"});
    visit(self.height, ParamInfo{"height", "", "m", 0.01, 100.0, "of its top above the ground"});
  }
};
/// Thin upright cylinder.
struct Pole {
  static constexpr const char* kType = "pole";
  double radius = 0.05, height = 3.0;
  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.radius, ParamInfo{"radius", "", "m", 0.005, 1.0, "of its round"});
    visit(self.height, ParamInfo{"height", "", "m", 0.01, 100.0, "of its top above the ground"});
  }
};

/// Slab on four legs with free space underneath.
struct Table {
  static constexpr const char* kType = "table";
  double length = 1.2, width = 0.8, clearance = 0.7, thickness = 0.04, leg = 0.06;
  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.length, ParamInfo{"length", "", "m", 0.1, 100.0, "along its x axis"});
    visit(self.width, ParamInfo{"width", "", "m", 0.1, 100.0, "along its y axis"});
    visit(self.clearance, ParamInfo{"clearance", "", "m", 0.05, 50.0, "free height underneath"});
    visit(self.thickness, ParamInfo{"thickness", "", "m", 0.005, 5.0, "of the slab"});
    visit(self.leg, ParamInfo{"leg", "", "m", 0.01, 5.0, "side of the square legs"});
  }
};
/// Deck along its x axis on two walls that stand at its sides: a tunnel underneath.
struct Bridge {
  static constexpr const char* kType = "bridge";
  double length = 6.0, width = 3.0, clearance = 2.2, thickness = 0.3, wall = 0.3;
  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.length,
          ParamInfo{"length", "", "m", 0.1, 500.0, "of the passage, along its x axis"});
    visit(self.width, ParamInfo{"width", "", "m", 0.3, 100.0, "of the passage between the walls"});
    visit(self.clearance, ParamInfo{"clearance", "", "m", 0.1, 50.0, "free height underneath"});
    visit(self.thickness, ParamInfo{"thickness", "", "m", 0.01, 10.0, "of the deck"});
    visit(self.wall, ParamInfo{"wall", "", "m", 0.01, 10.0, "thickness of the side walls"});
  }
};

enum class RimForm : std::uint8_t { kRectangle, kEllipse };
constexpr EnumNames<RimForm, 2> enum_names(RimForm) {
  return {{{RimForm::kRectangle, "rectangle"}, {RimForm::kEllipse, "ellipse"}}};
}
/// Hole in the ground, its floor parallel to the ground around it.
struct Pothole {
  static constexpr const char* kType = "pothole";
  RimForm form = RimForm::kRectangle;
  double length = 0.5, width = 0.5, depth = 0.09;
  double wall_angle = 1.5707963267948966;  ///< of the walls from horizontal, radians
  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.form, ParamInfo{"form", "", "", 0, 0, "of the rim"});
    visit(self.length, ParamInfo{"length", "", "m", 0.05, 100.0, "of the rim along its x axis"});
    visit(self.width, ParamInfo{"width", "", "m", 0.05, 100.0, "of the rim along its y axis"});
    visit(self.depth, ParamInfo{"depth", "", "m", 0.01, 10.0, "of the floor below the ground"});
    visit(self.wall_angle,
          ParamInfo{"wall_angle_deg", "", "deg", 5.0, 90.0, "of the walls from horizontal"});
  }
};
/// Trench along its x axis with sloped walls.
struct Ditch {
  static constexpr const char* kType = "ditch";
  double length = 10.0, width = 1.0, depth = 0.5;
  double wall_angle = 1.0471975511965976;
  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.length, ParamInfo{"length", "", "m", 0.2, 500.0, "along its x axis"});
    visit(self.width, ParamInfo{"width", "", "m", 0.1, 50.0, "between its upper edges"});
    visit(self.depth, ParamInfo{"depth", "", "m", 0.01, 10.0, "of the floor below the ground"});
    visit(self.wall_angle,
          ParamInfo{"wall_angle_deg", "", "deg", 5.0, 90.0, "of the walls from horizontal"});
  }
};

/// Heap of angular stones.
struct Rubble {
  static constexpr const char* kType = "rubble";
  double radius = 0.6, height = 0.3;
  double stone = 0.12;  ///< mean size
  int stones = 80;
  std::uint64_t seed = 1;
  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.radius, ParamInfo{"radius", "", "m", 0.05, 100.0, "of the heap"});
    visit(self.height,
          ParamInfo{"height", "", "m", 0.01, 20.0, "up to which centres of stones lie"});
    visit(self.stone, ParamInfo{"stone", "", "m", 0.01, 5.0, "mean size of the stones"});
    visit(self.stones, ParamInfo{"stones", "", "", 1, 20000, "their number"});
    visit(self.seed, ParamInfo{"seed", "", "", 0, 9e15, "of their places and forms"});
  }
};

/// Grass: returns come from a layer over the ground.
struct Grass {
  static constexpr const char* kType = "grass";
  double length = 5.0, width = 5.0, height = 0.15;
  double density = 4.0;  ///< mean returns per metre of path
  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.length, ParamInfo{"length", "", "m", 0.1, 1000.0, "along its x axis"});
    visit(self.width, ParamInfo{"width", "", "m", 0.1, 1000.0, "along its y axis"});
    visit(self.height, ParamInfo{"height", "", "m", 0.01, 3.0, "of the layer"});
    visit(self.density,
          ParamInfo{"density", "", "1/m", 0.01, 1000.0, "mean returns per metre of path"});
  }
};
/// Bush: returns come from an ellipsoid that stands on the ground.
struct Bush {
  static constexpr const char* kType = "bush";
  double radius = 0.6, height = 1.0;
  double density = 6.0;
  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.radius, ParamInfo{"radius", "", "m", 0.05, 50.0, "horizontal half axis"});
    visit(self.height, ParamInfo{"height", "", "m", 0.05, 50.0, "of its top above the ground"});
    visit(self.density,
          ParamInfo{"density", "", "1/m", 0.01, 1000.0, "mean returns per metre of path"});
  }
};

/// Somebody who walks to and fro along the x axis.
struct Person {
  static constexpr const char* kType = "person";
  double height = 1.75;
  double speed = 1.3;     ///< metres per second
  double distance = 4.0;  ///< until the turn
  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.height, ParamInfo{"height", "", "m", 0.5, 2.5, "of the person"});
    visit(self.speed, ParamInfo{"speed", "", "m/s", 0.0, 10.0, "of walking"});
    visit(self.distance, ParamInfo{"distance", "", "m", 0.0, 200.0, "until the turn"});
  }
};

using Shape = std::variant<Ramp, Box, Curb, Stairs, Wall, Pole, Cylinder, Table, Bridge, Pothole,
                           Ditch, Rubble, Grass, Bush, Person>;

/// What every solid has, whatever its shape.
struct Placement {
  int id = 0;               ///< 1 to 65535, unique in the scene; 0: numbered by the loader
  double x = 0.0, y = 0.0;  ///< of the shape's origin: its centre; of ramps and stairs the middle
                            ///< of the lower edge; of persons where the walk begins
  double yaw = 0.0;         ///< of the shape's x axis from the map's, radians
  TerrainClass terrain_class = TerrainClass::kNone;  ///< kNone: what the shape usually is
  Material material = Material::kConcrete;
  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.id, ParamInfo{"id", "", "", 0, 65535, "number in labels, unique; 0: the next free"});
    visit(self.x, ParamInfo{"x", "", "m", -1e5, 1e5, "place of the shape's origin"});
    visit(self.y, ParamInfo{"y", "", "m", -1e5, 1e5, "place of the shape's origin"});
    visit(self.yaw, ParamInfo{"yaw_deg", "", "deg", -360.0, 360.0, "turn about the vertical"});
    visit(self.terrain_class,
          ParamInfo{"class", "", "", 0, 0, "terrain class; none: what the shape usually is"});
    visit(self.material, ParamInfo{"material", "", "", 0, 0, "what it is made of"});
  }
};

struct Solid {
  Placement placement;
  Shape shape;
  std::string source;  ///< "scene.yaml:12: solids[3]", beginning of messages; may be empty
};

struct Scene {
  std::string name;
  Ground ground;
  std::vector<Solid> solids;
  std::string source;  ///< file, beginning of messages
};

/// Name of a shape's type in files.
[[nodiscard]] const char* type_of(const Shape& shape);
/// The class of a shape whose placement says none: ramps are slopes, potholes and ditches potholes,
/// grass is other, everything else an obstacle.
[[nodiscard]] TerrainClass usual_class(const Shape& shape);

}  // namespace mrpt_terrain::sim
