// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/io/label_file.h"

#include "file_bytes.h"
#include "mrpt_terrain/files/whole_file.h"

namespace mrpt_terrain::io {

std::vector<std::uint32_t> read_labels(const std::string& file,
                                       std::optional<std::size_t> expected) {
  const std::vector<std::uint8_t> bytes = read_bytes(file);
  if (bytes.size() % 4 != 0) {
    fail_at_byte(file, bytes.size() - bytes.size() % 4,
                 "cut off: " + std::to_string(bytes.size()) +
                     " bytes are no whole number of labels of 4 bytes");
  }
  const std::size_t count = bytes.size() / 4;
  if (expected && count != *expected) {
    throw ReadError(file + ": holds " + std::to_string(count) + " labels for a scan of " +
                    std::to_string(*expected) + " points");
  }
  std::vector<std::uint32_t> labels(count);
  for (std::size_t k = 0; k < 4 * count; ++k) {
    labels[k / 4] |= static_cast<std::uint32_t>(bytes[k]) << (8 * (k % 4));
  }
  return labels;
}

void write_labels(const std::string& file, const std::vector<std::uint32_t>& labels) {
  std::string bytes;
  bytes.reserve(4 * labels.size());
  for (const std::uint32_t label : labels) {
    for (unsigned k = 0; k < 4; ++k) bytes.push_back(static_cast<char>((label >> (8 * k)) & 0xFFu));
  }
  files::WholeFile whole(file);
  whole.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  whole.commit();
}

}  // namespace mrpt_terrain::io
