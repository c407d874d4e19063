// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/core/ground_plane.h"
#include "mrpt_terrain/io/scan.h"

/// Everything that the configuration file of terrain-rawlog holds.
struct AppParams {
  mrpt_terrain::DescriptionParams description;
  mrpt_terrain::io::InputParams input;
  mrpt_terrain::GroundPlaneParams ground_plane;

  template <class Self, class Visitor>
  static void visit_sections(Self& self, Visitor&& visit) {
    mrpt_terrain::DescriptionParams::visit_sections(self.description, visit);
    visit(self.input, "input", "How observations become points");
    visit(self.ground_plane, "ground_plane",
          "Search for the ground when the sensor's pose is unknown (--find-ground)");
  }
};

/// Refuses values that are each permitted but not together, such as a least range above the
/// greatest. Throws ParameterError with a line per problem.
/// \param source beginning of the messages
void check_together(const AppParams& params, const std::string& source);

/// Defaults, then a file, then single settings; checked together.
/// \param config .ini file; empty: none
/// \param settings "section.key=value"
[[nodiscard]] AppParams load_params(const std::string& config,
                                    const std::vector<std::string>& settings);
