// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace mrpt_terrain::files {

/// Writes a file so that it is there as a whole or not at all: `produce` fills a file of another
/// name in the same folder, which then takes the place of `file`. When `produce` throws, the
/// unfinished file is removed and an older `file` stays as it was.
///
/// Throws std::runtime_error "FILE: cannot be written: reason"; the reason is the system's or what
/// `produce` threw.
/// \param produce gets the name it has to write to
void write_atomically(const std::string& file,
                      const std::function<void(const std::string& part_file)>& produce);

/// Writes `content` the same way.
void write_atomically(const std::string& file, std::string_view content);

}  // namespace mrpt_terrain::files
