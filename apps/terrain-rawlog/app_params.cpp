// SPDX-License-Identifier: BSD-3-Clause
#include "app_params.h"

#include <mrpt/core/bits_math.h>

#include <sstream>
#include <vector>

#include "mrpt_terrain/params/ini.h"
#include "mrpt_terrain/params/parameter_error.h"
#include "mrpt_terrain/params/set.h"

namespace {

constexpr double kMaxCells = 1e8;

std::string number(double value) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << value;
  return text.str();
}

std::string setting(const std::string& section, const std::string& key, double value) {
  return "[" + section + "] " + key + " = " + number(value);
}

std::string too_many(const std::string& section, double cell_size, double cells) {
  return setting(section, "cell_size", cell_size) + ": makes " + number(cells) +
         " cells, must be at most " + number(kMaxCells);
}

}  // namespace

void check_together(const AppParams& params, const std::string& source) {
  std::vector<std::string> problems;
  const mrpt_terrain::ClassParams& classes = params.description.classes;
  if (classes.slope_min > classes.slope_max) {
    problems.push_back(
        setting("classes", "slope_min_deg", mrpt::RAD2DEG(classes.slope_min)) +
        ": must be at most slope_max_deg = " + number(mrpt::RAD2DEG(classes.slope_max)));
  }
  if (params.input.min_range >= params.input.max_range) {
    problems.push_back(setting("input", "min_range", params.input.min_range) +
                       ": must be less than max_range = " + number(params.input.max_range));
  }
  const auto& grid = params.description.grid;
  const double cells = (grid.length / grid.cell_size) * (grid.width / grid.cell_size);
  if (cells > kMaxCells) problems.push_back(too_many("grid", grid.cell_size, cells));
  const double side = 2 * params.ground_plane.range / params.ground_plane.cell_size;
  if (side * side > kMaxCells) {
    problems.push_back(too_many("ground_plane", params.ground_plane.cell_size, side * side));
  }
  if (problems.empty()) return;
  std::string text;
  for (const std::string& problem : problems) {
    text += (text.empty() ? "" : "\n") + source + ": " + problem;
  }
  throw mrpt_terrain::params::ParameterError(text);
}

AppParams load_params(const std::string& config, const std::vector<std::string>& settings) {
  AppParams result;
  if (!config.empty()) mrpt_terrain::params::load_ini(config, result);
  for (const std::string& setting : settings) {
    mrpt_terrain::params::set(result, setting, "--set");
  }
  check_together(result, config.empty() ? "--set" : config);
  return result;
}
