// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace mrpt_terrain {

// Parts of a hole, by depth below the rim over the depth of the hole.
inline constexpr double kRimShare = 0.3;     // less is rim
inline constexpr double kFloorShare = 0.55;  // more is floor

}  // namespace mrpt_terrain
