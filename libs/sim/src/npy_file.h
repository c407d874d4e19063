// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace mrpt_terrain::sim {

/// One field of the records of a .npy file.
struct NpyField {
  std::string name;
  std::string type;  ///< NumPy's: "<f4", "<i4", "|u1"
};

/// Collects records for a .npy file of version 1.0 (numpy.lib.format). Fields are appended in the
/// order of their list, record by record.
class NpyRecords {
 public:
  /// \param shape of the array; its product is the number of records
  NpyRecords(std::vector<NpyField> fields, std::vector<std::size_t> shape);

  void add(float value);
  void add(std::int32_t value);
  void add(std::uint8_t value);

  /// Writes the file, whole or not at all. Throws std::runtime_error.
  void write(const std::string& file) const;

 private:
  std::string bytes_;
};

/// Appends a number in little-endian order.
void append_little_endian(std::uint32_t value, std::string& bytes);

}  // namespace mrpt_terrain::sim
