// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include "mrpt_terrain/core/param_info.h"

namespace mrpt_terrain {

/// Why nothing is known of the ground in a cell.
enum class UnseenReason : std::uint8_t {
  kSeen = 0,   ///< it holds points on or below the ground
  kOutOfView,  ///< no beam points there: nearer than the lowest beams, or beside the field of view
  kOccluded,   ///< behind something that stands nearer in that direction, or under it
  kNoReturn,   ///< in view, but nothing came back: between rings, too far, water, the ground ends
};
constexpr EnumNames<UnseenReason, 4> enum_names(UnseenReason) {
  return {{{UnseenReason::kSeen, "seen"},
           {UnseenReason::kOutOfView, "out_of_view"},
           {UnseenReason::kOccluded, "occluded"},
           {UnseenReason::kNoReturn, "no_return"}}};
}
inline constexpr std::size_t kUnseenReasonCount = 4;

}  // namespace mrpt_terrain
