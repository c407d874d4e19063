// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace mrpt_terrain::params {

/// A parameter file or a parameter struct is wrong. The message has one line per problem, each with
/// file, section, key, value, what is permitted, and what the parameter means:
///
///     params/x.ini: [slope] inlier_distance = -3: must be within [0.0001, 1] m (point-to-plane
///     distance of an inlier)
///
/// (in one line).
class ParameterError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace mrpt_terrain::params
