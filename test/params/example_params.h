// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "mrpt_terrain/core/param_info.h"

/// A parameter struct of every field type for the tests of the loader, so that they do not depend
/// on what the stages happen to need.
namespace mrpt_terrain::test_params {

enum class Colour : std::uint8_t { kRed, kDarkGreen };
constexpr EnumNames<Colour, 2> enum_names(Colour) {
  return {{{Colour::kRed, "red"}, {Colour::kDarkGreen, "dark_green"}}};
}

struct Shape {
  double size = 0.5;
  double angle = 0.7853981633974483;  // 45 deg
  int count = 3;
  std::uint64_t seed = 1;
  bool filled = true;
  Colour colour = Colour::kRed;

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.size, ParamInfo{"size", "S", "m", 0.25, 10.0, "edge of the shape"});
    visit(self.angle, ParamInfo{"angle_deg", "alpha", "deg", -90.0, 90.0, "tilt of the shape"});
    visit(self.count, ParamInfo{"count", "", "", 1, 100, "number of shapes"});
    visit(self.seed, ParamInfo{"seed", "", "", 0, 9e15, "seed of the random numbers"});
    visit(self.filled, ParamInfo{"filled", "", "", 0, 0, "whether the shape is filled"});
    visit(self.colour, ParamInfo{"colour", "", "", 0, 0, "colour of the shape"});
  }
};

struct Paper {
  double weight = 80.0;

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.weight, ParamInfo{"weight", "", "g/m^2", 1.0, 1000.0, "weight of the paper"});
  }
};

struct Drawing {
  Shape shape;
  Paper paper;

  template <class Self, class Visitor>
  static void visit_sections(Self& self, Visitor&& visit) {
    visit(self.shape, "shape", "What is drawn");
    visit(self.paper, "paper", "What it is drawn on");
  }
};

/// Two structs of sections in one file.
struct Studio {
  Drawing drawing;
  Paper wall;

  template <class Self, class Visitor>
  static void visit_sections(Self& self, Visitor&& visit) {
    Drawing::visit_sections(self.drawing, visit);
    visit(self.wall, "wall", "What it hangs on");
  }
};

}  // namespace mrpt_terrain::test_params
