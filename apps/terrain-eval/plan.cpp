// SPDX-License-Identifier: BSD-3-Clause
#include "plan.h"

#include <stdexcept>
#include <string>

#include "eval_params.h"
#include "mrpt_terrain/params/data_files.h"
#include "mrpt_terrain/params/ini.h"

using namespace mrpt_terrain;

namespace {

constexpr double kDegree = M_PI / 180.0;

sim::SeedRange parse_seeds(const std::string& text) {
  const std::size_t colon = text.find(':');
  const auto is_number = [](const std::string& part) {
    return !part.empty() && part.size() < 10 &&
           part.find_first_not_of("0123456789") == std::string::npos;
  };
  const std::string first = text.substr(0, colon);
  const std::string end = colon == std::string::npos ? "" : text.substr(colon + 1);
  if (!is_number(first) || !is_number(end) || std::stoull(first) >= std::stoull(end)) {
    throw std::invalid_argument("--seeds = " + text +
                                ": must be A:B with A < B, seeds from A up to, not including, B");
  }
  return {std::stoull(first), std::stoull(end)};
}

void check_seeds(const sim::SeedRange& seeds, const WorldsOptions& options) {
  const bool development = seeds.end <= sim::kDevelopmentSeeds.end;
  const bool judging =
      seeds.first >= sim::kJudgingSeeds.first && seeds.end <= sim::kJudgingSeeds.end;
  if (development || (judging && options.judging)) return;
  throw std::invalid_argument(
      "--seeds = " + options.seeds +
      (judging ? ": are for judging: nothing may be developed or tuned on their results. Who "
                 "judges says so with --judging"
               : ": must lie within 0:1000 (development) or 1000:1100 (judging)"));
}

std::vector<sim::Family> load_families(const std::vector<std::string>& wanted) {
  const std::string folder = (params::find_data_folder() / "params" / "families").string();
  std::vector<sim::Family> families;
  for (const std::string& name : wanted) {
    if (name != "all") {
      families.push_back(sim::resolve_family(name, folder, "--families"));
      continue;
    }
    for (const std::string& each : sim::family_names(folder)) {
      families.push_back(sim::resolve_family(each, folder, "--families"));
    }
  }
  return families;
}

eval::ScanOptions scan_options(const WorldsOptions& options, const AppParams& params) {
  eval::ScanOptions result;
  result.sensor_folder = (params::find_data_folder() / "params" / "sensors").string();
  result.sensor = options.sensor;
  result.sensor_z = options.sensor_z;
  result.speed = options.speed;
  result.noise_seed = options.noise_seed;
  result.skewed = options.skewed || !params.input.deskew;
  result.level = options.level || !options.costs.empty();
  result.pitch = options.common.pitch_deg * kDegree;
  result.raise = options.common.raise;
  result.radius = options.common.radius;
  result.min_range = params.input.min_range;
  result.max_range = params.input.max_range;
  return result;
}

}  // namespace

Plan make_plan(const WorldsOptions& options) {
  const AppParams params = load_params(options.common);
  Plan plan;
  plan.seeds = parse_seeds(options.seeds);
  check_seeds(plan.seeds, options);
  plan.families = load_families(options.families);
  plan.scans = scan_options(options, params);
  plan.description = params.description;
  if (!options.costs.empty()) params::load_ini(options.costs, plan.rules.costs.robot);
  return plan;
}
