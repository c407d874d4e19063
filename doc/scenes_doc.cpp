// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Writes doc/scenes.md (to the file named on the command line) from the field lists of the shapes,
/// so that the document cannot disagree with the program.
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <utility>

#include "mrpt_terrain/params/documentation.h"
#include "mrpt_terrain/sim/scene.h"
#include "mrpt_terrain/sim/vehicle.h"

namespace {

using namespace mrpt_terrain;

constexpr const char* kIntroduction = R"(# Scenes

Generated from the field lists in the headers by `terrain-scenes-doc`; CONTRIBUTING.md says how to make it
again. A scene is a YAML file for `terrain-sim`; `params/scenes/` has some to start from:

```yaml
name: pothole road
ground: {form: plane, length: 60, width: 20, material: asphalt}
solids:
  - {type: pothole, x: 4, y: 0.2, length: 0.5, width: 0.4, depth: 0.09}
  - {type: ramp, x: 6, y: -2, yaw_deg: 30, length: 1.2, width: 1, angle_deg: 14}
  - {type: box, id: 7, x: 6.5, y: -1.8, height: 0.15, class: obstacle}   # stands on the ramp
sensor: hdl32e                  # a file in params/sensors, or a path ending in .yaml
vehicle: {sensor_z: 0.81}
path: {speed: 0.5, waypoints: [[0, 0], [20, 0]]}
```

The map frame has x east, y north, z up; metres. Every entry of `solids` has a `type`, the keys of
[every solid](#every-solid), and those of its type. Keys that are not given have the default below.
Unknown keys, keys given twice, values out of range, solids that do not fit on the ground and holes
that overlap are refused with file, line, key, value and rule, all at once.

* Solids stand on the highest drivable surface under their origin: the ground, or a ramp or curb that
  comes before them in the list. Their lower parts reach into the ground, so that no gap opens on
  uneven ground.
* Potholes and ditches are cut into the ground, whatever its form; their floor is parallel to it.
* The number (`id`) of a solid is the instance in label files; solids without one get the next free one.
* A height map (`form: height_map`) needs the key `file`: a text file of rows of heights in metres, the
  first row at the smallest y, spread over length and width; its place is relative to the scene.
* `path` has `waypoints`, a list of [x, y], and `speed` in m/s. A path of one waypoint is a vehicle that
  stands there, turned by `yaw_deg`; without `path` it stands at the origin.
* Cylinders and poles are prisms of 64 sides whose corners lie on the circle.

)";

// One phrase per shape, in the order of the variant.
constexpr const char* kMeanings[] = {
    "Wedge with a drivable top that rises along x from the ground; origin: middle of its lower "
    "edge",
    "Cuboid; origin: middle of its bottom",
    "Long cuboid with a drivable top; origin: its middle",
    "Steps that rise along x; origin: middle of the lowest edge",
    "Upright wall along x; origin: its middle",
    "Thin upright cylinder",
    "Upright cylinder: trunk, barrel, bollard",
    "Slab on four legs with free space underneath; origin: its middle",
    "Deck on two walls, a tunnel along x; origin: its middle",
    "Hole in the ground; origin: its middle",
    "Trench along x with sloped walls; origin: its middle",
    "Heap of cuboid stones of random size and attitude; origin: its middle",
    "Returns come from a layer over the ground after a random free path; origin: its middle",
    "Returns come from an ellipsoid that stands on the ground, after a random free path",
    "Somebody who walks to and fro along x; origin: where the walk begins"};
static_assert(std::size(kMeanings) == std::variant_size_v<sim::Shape>);

template <std::size_t... kIndex>
std::vector<params::Section> sections_of_shapes(std::vector<sim::Shape>& shapes,
                                                std::index_sequence<kIndex...> /*shapes*/) {
  shapes = {sim::Shape(std::in_place_index<kIndex>)...};
  std::vector<params::Section> sections;
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    sections.push_back({sim::type_of(shapes[k]), kMeanings[k],
                        std::visit([](auto& form) { return params::fields_of(form); }, shapes[k])});
  }
  return sections;
}

std::string tables() {
  sim::Ground ground;
  sim::Placement placement;
  sim::VehicleParams vehicle;
  std::vector<params::Section> sections{
      {"ground", "The ground: a rectangle about (x, y)", params::fields_of(ground)},
      {"every solid", "Place, number and look of any shape", params::fields_of(placement)}};
  std::vector<sim::Shape> shapes;
  for (params::Section& section :
       sections_of_shapes(shapes, std::make_index_sequence<std::variant_size_v<sim::Shape>>())) {
    sections.push_back(std::move(section));
  }
  sections.push_back(
      {"vehicle", "Wheels, and where the sensor is mounted", params::fields_of(vehicle)});
  return params::markdown_text(sections);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: terrain-scenes-doc FILE\n";
    return EXIT_FAILURE;
  }
  std::ofstream file(argv[1], std::ios::binary);
  file << kIntroduction << tables();
  file.close();
  if (!file) {
    std::cerr << argv[1] << ": cannot be written\n";
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
