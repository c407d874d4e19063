// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/sim/scene_file.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>

#include "mrpt_terrain/params/document.h"
#include "mrpt_terrain/params/fields.h"
#include "mrpt_terrain/params/numbers.h"
#include "mrpt_terrain/params/parameter_error.h"

namespace mrpt_terrain::sim {
namespace {

namespace fs = std::filesystem;

constexpr int kGreatestId = 65535;

/// All shapes in the order of the variant, with default values.
template <std::size_t... kIndex>
std::vector<Shape> all_shapes(std::index_sequence<kIndex...> /*of the variant*/) {
  return {Shape(std::in_place_index<kIndex>)...};
}
std::vector<Shape> all_shapes() {
  return all_shapes(std::make_index_sequence<std::variant_size_v<Shape>>());
}

std::string known_types() {
  std::string names;
  for (const Shape& shape : all_shapes()) {
    names += std::string(names.empty() ? "" : ", ") + type_of(shape);
  }
  return names;
}

std::vector<params::Field> fields_of_shape(Shape& shape) {
  return std::visit([](auto& form) { return params::fields_of(form); }, shape);
}

/// Reads one file and gathers all that is wrong with it.
class SceneReader {
 public:
  explicit SceneReader(std::string file) : file_(std::move(file)) {}

  SceneFile read() {
    const YAML::Node root = parse();
    if (!root.IsMap()) fail("must be a map with the keys ground, solids, sensor, vehicle, path");
    refuse_repeated_keys(root);
    SceneFile scene;
    scene.scene.source = file_;
    for (const auto& entry : root) read_top(entry.first.Scalar(), entry.first, entry.second, scene);
    number_solids(scene.scene);
    if (problems_.empty()) return scene;
    std::string message;
    for (const std::string& problem : problems_) {
      message += (message.empty() ? "" : "\n") + problem;
    }
    throw SceneError(message);
  }

 private:
  [[noreturn]] void fail(const std::string& rule) const { throw SceneError(file_ + ": " + rule); }

  [[nodiscard]] std::string at(const YAML::Node& node) const {
    const YAML::Mark mark = node.Mark();
    return mark.is_null() ? file_ : file_ + ":" + std::to_string(mark.line + 1);
  }
  void complain(const YAML::Node& node, const std::string& problem) {
    problems_.push_back(at(node) + ": " + problem);
  }

  [[nodiscard]] YAML::Node parse() const {
    std::error_code error;
    if (!fs::is_regular_file(file_, error)) {
      fail(fs::exists(file_, error) ? "is not a file" : "does not exist");
    }
    try {
      const YAML::Node root = YAML::Load(params::read_text_file(file_));
      if (root.IsNull()) fail("is empty");
      return root;
    } catch (const YAML::Exception& problem) {
      throw SceneError(file_ + ":" + std::to_string(problem.mark.line + 1) + ": " + problem.msg);
    } catch (const params::ParameterError& problem) {
      throw SceneError(problem.what());
    }
  }

  void read_top(const std::string& key, const YAML::Node& key_node, const YAML::Node& value,
                SceneFile& scene) {
    if (key == "name") {
      scene.scene.name = text_of(key, value);
    } else if (key == "ground") {
      read_ground(value, scene.scene.ground);
    } else if (key == "solids") {
      read_solids(value, scene.scene);
    } else if (key == "sensor") {
      scene.sensor = text_of(key, value);
    } else if (key == "vehicle") {
      assign(value, "vehicle", params::fields_of(scene.vehicle), {});
    } else if (key == "path") {
      read_path(value, scene.path);
    } else {
      complain(key_node, key +
                             ": unknown key; known are name, ground, solids, sensor, vehicle, "
                             "path");
    }
  }

  [[nodiscard]] std::string text_of(const std::string& key, const YAML::Node& value) {
    if (value.IsScalar()) return value.Scalar();
    complain(value, key + ": must be a text");
    return {};
  }

  // yaml-cpp keeps both of two equal keys and finds the first one.
  void refuse_repeated_keys(const YAML::Node& map) {
    std::set<std::string> seen;
    for (const auto& entry : map) {
      if (!entry.first.IsScalar()) {
        complain(entry.first, "a key must be a word");
      } else if (!seen.insert(entry.first.Scalar()).second) {
        complain(entry.first, entry.first.Scalar() + ": given twice");
      }
    }
  }

  // Sets fields from the scalars of a map; keys in `elsewhere` are read by somebody else.
  void assign(const YAML::Node& map, const std::string& name, std::vector<params::Field> fields,
              const std::set<std::string>& elsewhere) {
    if (!map.IsMap()) return complain(map, name + ": must be a map of keys and values");
    for (const auto& entry : map) {
      if (!entry.first.IsScalar()) {
        complain(entry.first, "[" + name + "] a key must be a word");
        continue;
      }
      const std::string& key = entry.first.Scalar();
      if (elsewhere.count(key) != 0) continue;
      if (!entry.second.IsScalar()) {
        complain(entry.second, "[" + name + "] " + key + ": must be a single value");
        continue;
      }
      // One key at a time, so that each message has its own line.
      try {
        params::assign_all({at(entry.first), {{name, {{key, entry.second.Scalar()}}}}},
                           {{name, "", fields}});
      } catch (const params::ParameterError& problem) {
        problems_.emplace_back(problem.what());
      }
    }
    refuse_repeated_keys(map);
  }

  void read_ground(const YAML::Node& map, Ground& ground) {
    assign(map, "ground", params::fields_of(ground), {"file"});
    if (!map.IsMap()) return;
    const YAML::Node file = map["file"];
    if (file) {
      const std::string name = text_of("file", file);
      ground.file = (fs::path(file_).parent_path() / name).string();
      if (!fs::is_regular_file(ground.file)) {
        complain(file, "[ground] file = " + name + ": there is no such file beside the scene");
      }
      if (ground.form != GroundForm::kHeightMap) {
        complain(file, "[ground] file = " + name + ": needs form: height_map");
      }
    } else if (ground.form == GroundForm::kHeightMap) {
      complain(map, "[ground] form = height_map: needs file, a text file of heights");
    }
  }

  void read_solids(const YAML::Node& list, Scene& scene) {
    if (list.IsNull()) return;
    if (!list.IsSequence()) return complain(list, "solids: must be a list");
    for (std::size_t k = 0; k < list.size(); ++k) {
      if (const std::optional<Solid> solid = read_solid(list[k], k)) {
        scene.solids.push_back(*solid);
      }
    }
  }

  std::optional<Solid> read_solid(const YAML::Node& map, std::size_t k) {
    const std::string place = "solids[" + std::to_string(k) + "]";
    if (!map.IsMap() || !map["type"] || !map["type"].IsScalar()) {
      complain(map, place + ": must be a map with the key type, one of " + known_types());
      return std::nullopt;
    }
    const std::string type = map["type"].Scalar();
    for (Shape& shape : all_shapes()) {
      if (type != type_of(shape)) continue;
      Solid solid;
      solid.shape = shape;
      solid.source = at(map) + ": " + place + " " + type;
      std::vector<params::Field> fields = params::fields_of(solid.placement);
      for (params::Field& field : fields_of_shape(solid.shape)) {
        fields.push_back(std::move(field));
      }
      assign(map, place + " " + type, fields, {"type"});
      return solid;
    }
    complain(map["type"], place + " type = " + type + ": must be one of " + known_types());
    return std::nullopt;
  }

  void read_path(const YAML::Node& map, DrivePath& path) {
    const std::vector<params::Field> fields{
        {{"speed", "", "m/s", 0.001, 50.0, "of driving"}, &path.speed},
        {{"yaw_deg", "", "deg", -360.0, 360.0, "of a vehicle that stands"}, &path.yaw}};
    assign(map, "path", fields, {"waypoints"});
    if (!map.IsMap()) return;
    const YAML::Node list = map["waypoints"];
    if (!list) return;
    if (!list.IsSequence()) return complain(list, "[path] waypoints: must be a list of [x, y]");
    for (const YAML::Node& point : list) read_waypoint(point, path);
  }

  void read_waypoint(const YAML::Node& point, DrivePath& path) {
    Eigen::Vector2d place = Eigen::Vector2d::Zero();
    bool good = point.IsSequence() && point.size() == 2;
    for (std::size_t axis = 0; good && axis < 2; ++axis) {
      good = point[axis].IsScalar() &&
             params::parse(point[axis].Scalar(), place[static_cast<Eigen::Index>(axis)]) ==
                 params::NumberStatus::kOk;
    }
    if (!good) {
      return complain(point, "[path] waypoints: every one must be two numbers, [x, y], in metres");
    }
    path.waypoints.push_back(place);
  }

  // Gives free numbers to solids without one.
  void number_solids(Scene& scene) {
    std::set<int> taken;
    for (const Solid& solid : scene.solids) {
      const int id = solid.placement.id;
      if (id != 0 && !taken.insert(id).second) {
        problems_.push_back(solid.source + " id = " + std::to_string(id) +
                            ": must be unique in the scene");
      }
    }
    int next = 1;
    for (Solid& solid : scene.solids) {
      if (solid.placement.id != 0) continue;
      while (taken.count(next) != 0) ++next;
      if (next > kGreatestId) fail("has more solids than numbers, " + std::to_string(kGreatestId));
      solid.placement.id = next;
      taken.insert(next);
    }
  }

  std::string file_;
  std::vector<std::string> problems_;
};

}  // namespace

SceneFile load_scene(const std::string& file) { return SceneReader(file).read(); }

}  // namespace mrpt_terrain::sim
