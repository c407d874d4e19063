// SPDX-License-Identifier: BSD-3-Clause
#include "npy_file.h"

#include <cstring>

#include "mrpt_terrain/files/atomic_file.h"

namespace mrpt_terrain::sim {
namespace {

/// The dictionary of the header: a Python literal.
std::string dictionary_of(const std::vector<NpyField>& fields,
                          const std::vector<std::size_t>& shape) {
  std::string text = "{'descr': [";
  for (const NpyField& field : fields) text += "('" + field.name + "', '" + field.type + "'), ";
  text += "], 'fortran_order': False, 'shape': (";
  for (const std::size_t extent : shape) text += std::to_string(extent) + ", ";
  return text + "), }";
}

}  // namespace

NpyRecords::NpyRecords(std::vector<NpyField> fields, std::vector<std::size_t> shape) {
  // Magic, version and length take ten bytes; the header ends with a newline at a multiple of 64.
  constexpr std::size_t kPreamble = 10, kAlignment = 64;
  std::string header = dictionary_of(fields, shape);
  while ((kPreamble + header.size() + 1) % kAlignment != 0) header += ' ';
  header += '\n';
  bytes_ = std::string("\x93NUMPY\x01\x00", 8);
  bytes_ += static_cast<char>(header.size() & 0xFFU);
  bytes_ += static_cast<char>(header.size() >> 8U);
  bytes_ += header;
}

void NpyRecords::add(float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  append_little_endian(bits, bytes_);
}

void NpyRecords::add(std::int32_t value) {
  append_little_endian(static_cast<std::uint32_t>(value), bytes_);
}

void NpyRecords::add(std::uint8_t value) { bytes_ += static_cast<char>(value); }

void NpyRecords::write(const std::string& file) const { files::write_atomically(file, bytes_); }

void append_little_endian(std::uint32_t value, std::string& bytes) {
  for (unsigned shift = 0; shift < 32; shift += 8) {
    bytes += static_cast<char>((value >> shift) & 0xFFU);
  }
}

}  // namespace mrpt_terrain::sim
