// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <deque>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "family_fields.h"
#include "mrpt_terrain/params/document.h"
#include "mrpt_terrain/params/yaml.h"
#include "mrpt_terrain/sim/families.h"

namespace mrpt_terrain::sim {
namespace {

template <std::size_t... kIndex>
std::vector<FamilyThings> things_of_all_types(std::index_sequence<kIndex...>) {
  const auto things_of = [](const Shape& shape) {
    return FamilyThings{ThingRule{}, {shape, shape}};
  };
  return {things_of(Shape(std::in_place_index<kIndex>))...};
}

/// Sections of a family file: the fields of the structs themselves, each as a lowest and a highest
/// one, so that files know every field and permitted range that scenes know.
class FamilySections {
 public:
  explicit FamilySections(Family& family) {
    add_span("ground", params::fields_of(family.ground.low), params::fields_of(family.ground.high));
    add_span("vehicle", params::fields_of(family.vehicle.low),
             params::fields_of(family.vehicle.high));
    add_span("path", params::fields_of(family.path.low), params::fields_of(family.path.high));
    sections_.push_back({"sensors", "", params::fields_of(family.sensors)});
    for (FamilyThings& things : family.things) {
      add_span(type_of(things.shape.low), fields_of_shape(things.shape.low),
               fields_of_shape(things.shape.high));
      for (params::Field& field : params::fields_of(things.rule)) {
        sections_.back().fields.push_back(std::move(field));
      }
    }
  }
  FamilySections(const FamilySections&) = delete;
  FamilySections& operator=(const FamilySections&) = delete;

  [[nodiscard]] const std::vector<params::Section>& sections() const { return sections_; }

 private:
  void add_span(const std::string& name, const std::vector<params::Field>& low,
                const std::vector<params::Field>& high) {
    params::Section section{name, "", {}};
    for (std::size_t k = 0; k < low.size(); ++k) {
      if (is_seed(low[k])) continue;
      section.fields.push_back(renamed(low[k], "_min"));
      section.fields.push_back(renamed(high[k], "_max"));
    }
    sections_.push_back(std::move(section));
  }

  // Keys of angles go on ending in _deg.
  params::Field renamed(params::Field field, const char* end) {
    constexpr std::string_view kDegrees = "_deg";
    const std::string_view key = field.info.key;
    const bool is_angle =
        key.size() > kDegrees.size() && key.substr(key.size() - kDegrees.size()) == kDegrees;
    std::string text(is_angle ? key.substr(0, key.size() - kDegrees.size()) : key);
    text += end;
    if (is_angle) text += kDegrees;
    keys_.push_back(std::move(text));
    field.info.key = keys_.back().c_str();
    return field;
  }

  std::deque<std::string> keys_;  // its elements stay where they are
  std::vector<params::Section> sections_;
};

/// Value of a number; equal for all words.
double number_of(const params::Field& field) {
  if (const auto* real = std::get_if<double*>(&field.value)) return **real;
  if (const auto* whole = std::get_if<int*>(&field.value)) return **whole;
  return 0.0;
}

std::string with_high_end(const std::string& key) {
  std::string text = key;
  return text.replace(text.rfind("_min"), 4, "_max");
}

[[noreturn]] void fail(const Family& family, const std::string& section, const std::string& rule) {
  throw SceneError(family.source + ": [" + section + "] " + rule);
}

void check_order(const Family& family, const params::Section& section) {
  const std::vector<params::Field>& fields = section.fields;
  for (const params::Field& low : fields) {
    if (std::string_view(low.info.key).find("_min") == std::string_view::npos) continue;
    const std::string high_key = with_high_end(low.info.key);
    const auto high = std::find_if(fields.begin(), fields.end(), [&](const params::Field& field) {
      return high_key == field.info.key;
    });
    if (high == fields.end() || number_of(low) <= number_of(*high)) continue;
    fail(family, section.name,
         std::string(low.info.key) + " = " + params::text_of(low) + ": must not exceed " +
             high_key + " = " + params::text_of(*high));
  }
}

void check_things(const Family& family) {
  for (const FamilyThings& things : family.things) {
    if (things.rule.on_path_max == 0 || may_be_on_path(things.shape.low)) continue;
    fail(family, type_of(things.shape.low),
         "on_path_max = " + std::to_string(things.rule.on_path_max) +
             ": must be 0: a vehicle cannot drive over or through one");
  }
}

void check_room(const Family& family) {
  const FamilyPath& path = family.path.high;
  const double needed = path.legs * path.leg + 2.0 * kPathMargin;
  const double room = std::min(family.ground.low.length, family.ground.low.width);
  if (needed <= room) return;
  fail(family, "path",
       "legs_max * leg_max = " + std::to_string(path.legs * path.leg) +
           ": must fit on the smallest ground, " + std::to_string(room) + " m, with " +
           std::to_string(kPathMargin) + " m free at either end");
}

}  // namespace

Family load_family(const std::string& file) {
  Family family;
  family.name = std::filesystem::path(file).stem().string();
  family.source = file;
  family.things = things_of_all_types(std::make_index_sequence<std::variant_size_v<Shape>>());
  const FamilySections sections(family);
  params::assign_all(params::read_yaml(file), sections.sections());
  for (const params::Section& section : sections.sections()) check_order(family, section);
  if (family.sensors.names().empty()) fail(family, "sensors", "one at least must be true");
  check_things(family);
  check_room(family);
  return family;
}

std::vector<std::string> family_names(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  if (error) throw SceneError(folder + ": cannot be read: " + error.message());
  std::sort(names.begin(), names.end());
  return names;
}

Family resolve_family(const std::string& name_or_path, const std::string& folder,
                      const std::string& source) {
  if (std::filesystem::path(name_or_path).extension() == ".yaml") return load_family(name_or_path);
  const std::vector<std::string> names = family_names(folder);
  if (std::find(names.begin(), names.end(), name_or_path) != names.end()) {
    return load_family((std::filesystem::path(folder) / (name_or_path + ".yaml")).string());
  }
  std::string known;
  for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
  throw SceneError(source + " = '" + name_or_path + "': must be a file ending in .yaml or one of " +
                   known);
}

}  // namespace mrpt_terrain::sim
