// SPDX-License-Identifier: BSD-3-Clause
#include "eval_params.h"

#include "mrpt_terrain/params/ini.h"
#include "mrpt_terrain/params/set.h"

AppParams load_params(const CommonOptions& options) {
  using namespace mrpt_terrain;
  AppParams result;
  if (!options.config.empty()) params::load_ini(options.config, result);
  for (const std::string& setting : options.settings) params::set(result, setting, "--set");
  check_together(result, options.config.empty() ? "--set" : options.config);
  return result;
}
