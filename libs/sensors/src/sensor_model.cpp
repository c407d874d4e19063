// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/sensors/sensor_model.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "model_file.h"
#include "mrpt_terrain/params/fields.h"

namespace mrpt_terrain::sensors {
namespace {

constexpr double kRadians = M_PI / 180.0;

bool equal_ignoring_case(const std::string& a, const std::string& b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return lower(x) == lower(y); });
}

bool is_named(const SensorModel& model, const std::string& name) {
  const auto same = [&](const std::string& other) { return equal_ignoring_case(name, other); };
  return same(model.name) || std::any_of(model.aliases.begin(), model.aliases.end(), same);
}

std::vector<double> angles(const ModelFile& file, const std::string& key, double limit) {
  std::vector<double> result = file.numbers(key, {-limit, limit});
  for (double& angle : result) angle *= kRadians;
  return result;
}

void read_beams(const ModelFile& file, SensorModel& model) {
  model.elevation = angles(file, "elevation_deg", 90.0);
  if (model.elevation.empty() || model.elevation.size() > kMaxSensorRows) {
    file.fail("elevation_deg", "must have 1 to " + std::to_string(kMaxSensorRows) + " numbers");
  }
  if (!file.has("azimuth_offset_deg")) return;
  model.azimuth_offset = angles(file, "azimuth_offset_deg", 180.0);
  if (model.azimuth_offset.size() != model.elevation.size()) {
    file.fail("azimuth_offset_deg",
              "must have a number per ring, " + std::to_string(model.elevation.size()));
  }
}

void read_timing(const ModelFile& file, SensorModel& model) {
  model.rate = file.number_or("rate_hz", {0.01, 1000.0}, 0.0);
  const double columns = file.number_or("columns", {1.0, 100000.0}, 0.0);
  if (columns != std::floor(columns)) file.fail("columns", "must be a whole number");
  model.columns = static_cast<int>(columns);
  model.laser_interval = file.number_or("laser_interval_us", {0.0, 1e6}, 0.0) * 1e-6;
  const double start = file.number_or("start_azimuth_deg", {-360.0, 360.0}, 180.0);
  const double end = file.number_or("end_azimuth_deg", {-360.0, 360.0}, -180.0);
  if (start == end || std::abs(end - start) > 360.0) {
    file.fail("end_azimuth_deg",
              "must be at most one turn from start_azimuth_deg, and not the same");
  }
  model.start_azimuth = start * kRadians;
  model.end_azimuth = end * kRadians;
}

void read_noise(const ModelFile& file, const std::string& path, SensorModel& model) {
  if (!file.has("noise")) return;
  params::assign_all(file.section("noise"), {{"noise", "", params::fields_of(model.noise)}});
  const int rays = model.noise.sub_rays;
  if (rays != 1 && rays != 5) {
    throw std::runtime_error(path + ": [noise] sub_rays = " + std::to_string(rays) +
                             ": must be 1 or 5 (rays per beam)");
  }
}

}  // namespace

bool SensorModel::full_turn() const {
  return std::abs(end_azimuth - start_azimuth) > 2.0 * M_PI - 1e-9;
}

double SensorModel::azimuth_step() const {
  return (end_azimuth - start_azimuth) / (full_turn() ? columns : std::max(columns - 1, 1));
}

double SensorModel::column_interval() const {
  return std::abs(azimuth_step()) / (2.0 * M_PI * rate);
}

double SensorModel::azimuth(std::size_t column, std::size_t ring) const {
  const double offset = azimuth_offset.empty() ? 0.0 : azimuth_offset[ring];
  return start_azimuth + azimuth_step() * static_cast<double>(column) +
         turn_rate() * laser_interval * static_cast<double>(ring) + offset;
}

SensorModel load_sensor_model(const std::string& file) {
  const ModelFile yaml(file);
  yaml.refuse_other_keys({"name", "aliases", "elevation_deg", "max_range", "rate_hz", "columns",
                          "laser_interval_us", "min_range", "start_azimuth_deg", "end_azimuth_deg",
                          "azimuth_offset_deg", "noise"});
  SensorModel model;
  model.name = yaml.text("name");
  model.aliases = yaml.texts("aliases");
  read_beams(yaml, model);
  model.max_range = yaml.number("max_range", {0.1, 10000.0});
  model.min_range = yaml.number_or("min_range", {0.0, model.max_range}, 0.0);
  read_timing(yaml, model);
  read_noise(yaml, file, model);
  return model;
}

SensorModels SensorModels::from_folder(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code error;
  for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    if (it->path().extension() == ".yaml") files.push_back(it->path().string());
  }
  if (error) throw std::runtime_error(folder + ": cannot be read: " + error.message());
  if (files.empty()) throw std::runtime_error(folder + ": holds no .yaml file");
  std::sort(files.begin(), files.end());
  SensorModels models;
  for (const auto& file : files) {
    SensorModel model = load_sensor_model(file);
    try {
      models.add(std::move(model));
    } catch (const std::runtime_error& taken) {
      throw std::runtime_error(file + ": name: " + taken.what());
    }
  }
  return models;
}

void SensorModels::add(SensorModel model) {
  const auto refuse_taken = [this](const std::string& name) {
    if (find(name) != nullptr) throw std::runtime_error("'" + name + "' is taken already");
  };
  refuse_taken(model.name);
  for (const auto& alias : model.aliases) refuse_taken(alias);
  models_.push_back(std::move(model));
}

const SensorModel* SensorModels::find(const std::string& name) const {
  const auto model = std::find_if(models_.begin(), models_.end(),
                                  [&](const SensorModel& m) { return is_named(m, name); });
  return model == models_.end() ? nullptr : &*model;
}

SensorModel resolve_sensor(const std::string& name_or_path, const std::string& folder,
                           const std::string& source) {
  if (std::filesystem::path(name_or_path).extension() == ".yaml") {
    if (std::filesystem::exists(name_or_path)) return load_sensor_model(name_or_path);
    throw std::runtime_error(source + " = '" + name_or_path + "': there is no such file");
  }
  const SensorModels models = SensorModels::from_folder(folder);
  const SensorModel* model = models.find(name_or_path);
  if (model != nullptr) return *model;
  std::string known;
  for (const SensorModel& other : models.all()) known += ", " + other.name;
  throw std::runtime_error(source + " = '" + name_or_path + "': must be a .yaml file or one of " +
                           known.substr(2) + " (" + folder + ")");
}

}  // namespace mrpt_terrain::sensors
