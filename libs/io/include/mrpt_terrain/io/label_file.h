// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace mrpt_terrain::io {

/// Labels of points as SemanticKITTI stores them: one little-endian uint32 per point slot of the
/// scan, class in the low 16 bits, instance in the high 16 bits.
[[nodiscard]] constexpr std::uint16_t label_class(std::uint32_t label) {
  return static_cast<std::uint16_t>(label & 0xFFFFu);
}
[[nodiscard]] constexpr std::uint16_t label_instance(std::uint32_t label) {
  return static_cast<std::uint16_t>(label >> 16);
}
[[nodiscard]] constexpr std::uint32_t make_label(std::uint16_t class_id, std::uint16_t instance) {
  return (static_cast<std::uint32_t>(instance) << 16) | class_id;
}

/// Reads a label file.
/// \param expected number of points of the scan, if known
/// Throws ReadError when the file is missing, is no whole number of labels, or holds another number
/// of labels than expected.
[[nodiscard]] std::vector<std::uint32_t> read_labels(
    const std::string& file, std::optional<std::size_t> expected = std::nullopt);

/// Writes a label file, whole or not at all. Throws std::runtime_error.
void write_labels(const std::string& file, const std::vector<std::uint32_t>& labels);

}  // namespace mrpt_terrain::io
