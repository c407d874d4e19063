// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>

#include "mrpt_terrain/params/document.h"
#include "mrpt_terrain/params/fields.h"

namespace mrpt_terrain::params {

/// Reads "section.key=value". Throws ParameterError if the text does not have that form.
[[nodiscard]] Document read_assignment(const std::string& assignment, const std::string& source);

/// Sets one parameter of a struct with `visit_sections`: `set(params, "ground.t_diff=0.15")`.
/// Throws ParameterError as a file would, and the struct is then unchanged.
/// \param source beginning of the messages
template <class Params>
void set(Params& params, const std::string& assignment,
         const std::string& source = "command line") {
  Params changed = params;
  assign_all(read_assignment(assignment, source), sections_of(changed));
  params = std::move(changed);
}

}  // namespace mrpt_terrain::params
