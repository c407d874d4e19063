// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/serialization/CSerializable.h>

#include <memory>
#include <string>

namespace mrpt_terrain::io {

/// Writes a gzip rawlog object by object. The file appears under its name only after `commit`.
class RawlogWriter {
 public:
  /// Throws std::runtime_error "file: cannot be written: reason".
  explicit RawlogWriter(const std::string& file);
  ~RawlogWriter();

  /// Appends an observation, sensory frame or action collection. Throws std::runtime_error when the
  /// disk is full.
  void write(const mrpt::serialization::CSerializable& object);
  void commit();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace mrpt_terrain::io
