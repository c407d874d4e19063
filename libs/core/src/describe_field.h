// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mrpt_terrain/core/describe.h"

namespace mrpt_terrain {

/// `describe` in field mode.
/// \param points_cover see `StageInput`; null if all points are the scan's own
void describe_field(const ScanView& scan, const DescriptionParams& params,
                    DescriptionWorkspace& workspace, Description& description,
                    StageListener* listener, const double* points_cover = nullptr);

}  // namespace mrpt_terrain
