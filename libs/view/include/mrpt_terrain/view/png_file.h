// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "mrpt_terrain/view/raster.h"

namespace mrpt_terrain::view {

/// A picture as the bytes of a PNG file (8 bits per channel, no transparency).
/// Pictures of ours are flat areas: unfiltered rows and a quick compression take a quarter of the
/// time of libpng's defaults and make files of the same size.
/// \param pixels 0x00RRGGBB
[[nodiscard]] std::string png_bytes(const Raster<std::uint32_t>& pixels);

}  // namespace mrpt_terrain::view
