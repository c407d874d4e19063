// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/sensors/sensor_model.h"

#include <mrpt/containers/yaml.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <locale>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace mrpt_terrain::sensors {
namespace {

using mrpt::containers::yaml;
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

/// A permitted range, both ends included.
struct Range {
  double min, max;
};

/// Number of lines that start with a key.
std::size_t count_keys(const std::string& file) {
  std::ifstream stream(file);
  std::size_t count = 0;
  for (std::string line; std::getline(stream, line);) {
    if (!line.empty() && std::isalpha(static_cast<unsigned char>(line[0])) != 0 &&
        line.find(':') != std::string::npos) {
      ++count;
    }
  }
  return count;
}

/// The YAML file of one model; every complaint names file and key.
class ModelFile {
 public:
  explicit ModelFile(std::string file) : file_(std::move(file)) {
    try {
      document_ = yaml::FromFile(file_);
    } catch (const std::exception&) {
      throw std::runtime_error(file_ + ": cannot be read as YAML");
    }
    if (!document_.isMap()) throw std::runtime_error(file_ + ": must be a map of keys to values");
    // MRPT's reader keeps what stands before a syntax error and does not complain.
    if (document_.asMap().size() < count_keys(file_)) {
      throw std::runtime_error(file_ + ": is not valid YAML: only " +
                               std::to_string(document_.asMap().size()) +
                               " of its keys can be read");
    }
  }

  void refuse_other_keys() const {
    constexpr std::array<std::string_view, 7> kKeys{
        "name", "aliases", "elevation_deg", "max_range", "rate_hz", "columns", "laser_interval_us"};
    for (const auto& [key, value] : document_.asMap()) {
      const auto name = std::string(key.internalAsStr());
      if (std::find(kKeys.begin(), kKeys.end(), name) == kKeys.end()) fail(name, "unknown key");
    }
  }

  [[nodiscard]] std::string text(const std::string& key) const {
    return text_of(key, required(key));
  }

  [[nodiscard]] std::vector<std::string> texts(const std::string& key) const {
    std::vector<std::string> result;
    if (!document_.has(key)) return result;
    for (const auto& item : items(key)) result.push_back(text_of(key, item));
    return result;
  }

  [[nodiscard]] double number(const std::string& key, Range range) const {
    return number_of(key, required(key), range);
  }
  [[nodiscard]] double number_or(const std::string& key, Range range, double otherwise) const {
    return document_.has(key) ? number(key, range) : otherwise;
  }

  [[nodiscard]] std::vector<double> numbers(const std::string& key, Range range) const {
    std::vector<double> result;
    static_cast<void>(required(key));
    for (const auto& item : items(key)) result.push_back(number_of(key, item, range));
    return result;
  }

  [[noreturn]] void fail(const std::string& key, const std::string& what) const {
    throw std::runtime_error(file_ + ": " + key + ": " + what);
  }

 private:
  [[nodiscard]] const yaml::node_t& required(const std::string& key) const {
    if (!document_.has(key)) fail(key, "is missing");
    return document_[key].node();
  }

  [[nodiscard]] const yaml::sequence_t& items(const std::string& key) const {
    const auto& node = document_[key].node();
    if (!node.isSequence()) fail(key, "must be a list");
    return node.asSequence();
  }

  [[nodiscard]] std::string text_of(const std::string& key, const yaml::node_t& node) const {
    std::string text = node.isScalar() ? node.as<std::string>() : std::string();
    if (text.empty()) fail(key, "must be a text that is not empty");
    return text;
  }

  [[nodiscard]] double number_of(const std::string& key, const yaml::node_t& node,
                                 Range range) const {
    const std::string text = text_of(key, node);
    std::istringstream stream(text);
    stream.imbue(std::locale::classic());
    double value = 0.0;
    if (!(stream >> value) || !stream.eof()) fail(key, "'" + text + "' is not a number");
    if (!(value >= range.min && value <= range.max)) {
      std::ostringstream message;
      message.imbue(std::locale::classic());
      message << "= " << text << ": must be within [" << range.min << ", " << range.max << "]";
      fail(key, message.str());
    }
    return value;
  }

  std::string file_;
  yaml document_;
};

SensorModel read_model(const std::string& path) {
  const ModelFile file(path);
  file.refuse_other_keys();
  SensorModel model;
  model.name = file.text("name");
  model.aliases = file.texts("aliases");
  model.elevation = file.numbers("elevation_deg", {-90.0, 90.0});
  if (model.elevation.empty() || model.elevation.size() > kMaxSensorRows) {
    file.fail("elevation_deg", "must have 1 to " + std::to_string(kMaxSensorRows) + " numbers");
  }
  for (double& angle : model.elevation) angle *= kRadians;
  model.max_range = file.number("max_range", {0.1, 10000.0});
  model.rate = file.number_or("rate_hz", {0.01, 1000.0}, 0.0);
  const double columns = file.number_or("columns", {1.0, 100000.0}, 0.0);
  if (columns != std::floor(columns)) file.fail("columns", "must be a whole number");
  model.columns = static_cast<int>(columns);
  model.laser_interval = file.number_or("laser_interval_us", {0.0, 1e6}, 0.0) * 1e-6;
  return model;
}

}  // namespace

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
    SensorModel model = read_model(file);
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

}  // namespace mrpt_terrain::sensors
