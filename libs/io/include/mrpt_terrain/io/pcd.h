// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mrpt_terrain/io/file_cloud.h"

namespace mrpt_terrain::io {

/// Reads a PCD file (`DATA ascii`, `binary` or `binary_compressed`) with fields x, y, z and, where
/// present, intensity and label (`label`, integer). Other fields are stepped over. VIEWPOINT is not
/// applied: the points stay in the frame of the file.
/// Throws ReadError "file:line: ..." or "file: byte N: ...".
[[nodiscard]] FileCloud read_pcd(const std::string& file);

/// Undoes LZF compression (the one of `binary_compressed`): a control byte c < 32 is followed by
/// c + 1 literal bytes; otherwise c >> 5 (7: plus one more byte) + 2 bytes are copied from
/// ((c & 31) << 8) + next byte + 1 bytes back.
/// \param size of the result
/// \return the bytes, or an empty vector if the data is damaged
[[nodiscard]] std::vector<std::uint8_t> decompress_lzf(const std::uint8_t* data, std::size_t length,
                                                       std::size_t size);

}  // namespace mrpt_terrain::io
