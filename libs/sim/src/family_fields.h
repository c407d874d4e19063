// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "mrpt_terrain/params/fields.h"
#include "mrpt_terrain/sim/families.h"

namespace mrpt_terrain::sim {

/// Fields of a shape of whatever type.
[[nodiscard]] inline std::vector<params::Field> fields_of_shape(Shape& shape) {
  return std::visit([](auto& s) { return params::fields_of(s); }, shape);
}

/// Whether a field is drawn from all numbers and therefore has no range in the files.
[[nodiscard]] bool is_seed(const params::Field& field);

/// Whether things of this type may lie where the vehicle drives.
[[nodiscard]] bool may_be_on_path(const Shape& shape);

}  // namespace mrpt_terrain::sim
