// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mrpt_terrain/core/param_info.h"
#include "mrpt_terrain/sim/scene.h"
#include "mrpt_terrain/sim/scene_file.h"
#include "mrpt_terrain/sim/vehicle.h"

/// \file
/// World families: ranges of numbers from which a seed draws a scene, a sensor, its mounting and a
/// path. doc/simulation.md describes the files in params/families and who may look at which seeds.
namespace mrpt_terrain::sim {

/// Seeds from `first` up to, not including, `end`.
struct SeedRange {
  std::uint64_t first, end;
  [[nodiscard]] constexpr bool contains(std::uint64_t seed) const {
    return seed >= first && seed < end;
  }
};
/// Worlds on which methods and parameters may be developed and tuned.
inline constexpr SeedRange kDevelopmentSeeds{0, 1000};
/// Worlds on which they are judged; nothing may be tuned on them.
inline constexpr SeedRange kJudgingSeeds{1000, 1100};

/// Half of the width along the path that things beside it keep free, metres.
inline constexpr double kHalfCorridor = 0.9;
/// Things on the path, grass and bridges apart, keep this far from its first waypoint, metres.
inline constexpr double kFreeStart = 1.5;
/// From the path, all of it, to the edge of the ground at least, metres.
inline constexpr double kPathMargin = 3.0;

/// Lowest and highest value of every field of a struct. Numbers are drawn evenly from between; of
/// words and of true and false, one of the two. Numbers `seed` are drawn from all.
template <class Params>
struct Span {
  Params low, high;
};

/// Straight legs between waypoints.
struct FamilyPath {
  int legs = 3;
  double leg = 5.0;   ///< metres
  double bend = 0.0;  ///< of the heading between two legs, radians, left > 0
  double speed = 0.5;

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.legs, ParamInfo{"legs", "", "", 1, 20, "number of straight legs"});
    visit(self.leg, ParamInfo{"leg", "", "m", 1.0, 100.0, "length of a leg"});
    visit(self.bend, ParamInfo{"bend_deg", "", "deg", -90.0, 90.0, "turn between two legs"});
    visit(self.speed, ParamInfo{"speed", "", "m/s", 0.05, 10.0, "of the vehicle"});
  }
};

/// Which of the sensors in params/sensors may be drawn, each as often as the others.
struct FamilySensors {
  bool vlp16 = false, hdl32e = false, hdl64e = false, os1_64 = false;

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.vlp16, ParamInfo{"vlp16", "", "", 0, 0, "16 beams"});
    visit(self.hdl32e, ParamInfo{"hdl32e", "", "", 0, 0, "32 beams"});
    visit(self.hdl64e, ParamInfo{"hdl64e", "", "", 0, 0, "64 beams"});
    visit(self.os1_64, ParamInfo{"os1-64", "", "", 0, 0, "64 beams"});
  }
  /// Names of those that are true.
  [[nodiscard]] std::vector<std::string> names() const;
};

/// How many things of a type there are and where.
struct ThingRule {
  int count_min = 0, count_max = 0;      ///< beside the path
  int on_path_min = 0, on_path_max = 0;  ///< with their origin on the path
  double aside_min = 1.0, aside_max = 8.0;
  double turn_min = -3.141592653589793, turn_max = 3.141592653589793;
  double on_path_turn = 0.0;
  Material material = Material::kConcrete;

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.count_min, ParamInfo{"count_min", "", "", 0, 1000, "fewest beside the path"});
    visit(self.count_max, ParamInfo{"count_max", "", "", 0, 1000, "most beside the path"});
    visit(self.on_path_min, ParamInfo{"on_path_min", "", "", 0, 1000, "fewest on the path"});
    visit(self.on_path_max, ParamInfo{"on_path_max", "", "", 0, 1000, "most on the path"});
    visit(self.aside_min,
          ParamInfo{"aside_min", "", "m", 0.0, 1000.0, "of the origin from its leg, sideways"});
    visit(self.aside_max,
          ParamInfo{"aside_max", "", "m", 0.0, 1000.0, "of the origin from its leg, sideways"});
    visit(self.turn_min, ParamInfo{"turn_min_deg", "", "deg", -180.0, 180.0,
                                   "x axis beside the path, from the heading of the leg"});
    visit(self.turn_max, ParamInfo{"turn_max_deg", "", "deg", -180.0, 180.0,
                                   "x axis beside the path, from the heading of the leg"});
    visit(self.on_path_turn, ParamInfo{"on_path_turn_deg", "", "deg", -180.0, 180.0,
                                       "x axis on the path, from the heading of the leg"});
    visit(self.material, ParamInfo{"material", "", "", 0, 0, "what they are made of"});
  }
};

/// The things of one type.
struct FamilyThings {
  ThingRule rule;
  Span<Shape> shape;  ///< both of the same type
};

struct Family {
  std::string name;  ///< of the file, without folder and ending
  std::string source;
  Span<Ground> ground;
  Span<VehicleParams> vehicle;
  Span<FamilyPath> path;
  FamilySensors sensors;
  std::vector<FamilyThings> things;  ///< one per type, in the order of `Shape`
};

/// Reads a family file. Throws params::ParameterError with a line per unknown section or key, key
/// given twice and value out of range, and SceneError where a lowest value exceeds its highest, no
/// sensor is permitted, a type cannot be driven over but is put on the path, or the longest path
/// does not fit on the smallest ground.
[[nodiscard]] Family load_family(const std::string& file);

/// The family of that name in a folder, or that of a file if the name ends in ".yaml". Throws
/// SceneError "SOURCE = 'NAME': ..." with the names that there are.
[[nodiscard]] Family resolve_family(const std::string& name_or_path, const std::string& folder,
                                    const std::string& source = "family");

/// Names of all families in a folder, sorted.
[[nodiscard]] std::vector<std::string> family_names(const std::string& folder);

/// One world of a family.
struct FamilyWorld {
  SceneFile file;            ///< scene, sensor, vehicle and path, as if read from a scene file
  std::size_t left_out = 0;  ///< things that were drawn but found no free place
};

/// Draws a world: the same family and seed give the same numbers. No two things overlap, except
/// that grass grows around everything but other grass. Things beside the path stay out of a
/// corridor of `kHalfCorridor` about it. A thing that finds no free place in 40 tries is left out.
[[nodiscard]] FamilyWorld make_world(const Family& family, std::uint64_t seed);

}  // namespace mrpt_terrain::sim
