// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "mrpt_terrain/io/file_cloud.h"
#include "mrpt_terrain/io/import.h"

namespace mrpt_terrain::io {

/// Writes imported scans; what it writes stands in import.h.
class ImportWriter {
 public:
  ImportWriter(const std::string& rawlog, const ImportOptions& options);
  ~ImportWriter();

  /// \param stamp seconds since the Unix epoch or since the start of the data set
  void add(const FileCloud& cloud, double stamp,
           const std::optional<mrpt::poses::CPose3D>& T_map_robot);
  /// Gives all files their names. Without this call none is left.
  ImportSummary commit();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The loop of every importer: writes scans 0, 1, ... of `available`, as many as the options allow,
/// and asks the options' progress callback before each whether to go on.
/// \param add hands the k-th scan to the writer
ImportSummary import_scans(std::size_t available, const ImportOptions& options,
                           const std::string& rawlog,
                           const std::function<void(std::size_t k, ImportWriter& writer)>& add);

}  // namespace mrpt_terrain::io
