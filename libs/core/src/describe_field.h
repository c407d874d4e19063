// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mrpt_terrain/core/describe.h"

namespace mrpt_terrain {

/// `describe` in field mode.
void describe_field(const ScanView& scan, const DescriptionParams& params,
                    DescriptionWorkspace& workspace, Description& description,
                    StageListener* listener);

}  // namespace mrpt_terrain
