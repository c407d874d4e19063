// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "describe_stages.h"
#include "mrpt_terrain/core/describe.h"

namespace mrpt_terrain {

/// Field mode: features of every thing but its slope, from its points (`cluster_slots` of the
/// workspace). Heights are above the ground reference, or above the ground around it for raised
/// ground, or above the rim for holes.
///
/// * Steps: for every cell of the thing with a ground cell within two cells along an axis, the
///   height of its highest point above the mean of that cell's ground, without what the ground
///   around rises by; lowest and highest are the values that a tenth of them do not reach, or
///   exceed. A ramp has its lowest step at its foot.
/// * Confidence: probability that such a cluster is a thing, by logistic regression on simulated
///   worlds (doc/field-mode.md).
void measure_things(const StageInput& stage, DescriptionWorkspace& workspace,
                    Description& description);

/// Field mode: slopes of the things whose class depends on them, by the points of their faces with
/// `slope.method = beam`. A thing most of whose points lie on one face is not rough.
void measure_thing_slopes(const StageInput& stage, DescriptionWorkspace& workspace,
                          Description& description);

/// Confidence of a cluster.
/// \param points of it, >= 1
/// \param raised share of its points that are raised ground
[[nodiscard]] double confidence_of(double points, double raised);

}  // namespace mrpt_terrain
