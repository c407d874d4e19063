// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/io/import_writer.h"
#include "mrpt_terrain/io/observation_reader.h"
#include "mrpt_terrain/io/pcd.h"
#include "mrpt_terrain/io/ply.h"

namespace mrpt_terrain::io {
namespace {

ImportSummary import_files(const std::vector<std::string>& files, const ImportOptions& options,
                           const std::string& rawlog, FileCloud (*read)(const std::string&)) {
  if (files.empty()) throw ReadError(rawlog + ": there are no files to import");
  return import_scans(files.size(), options, rawlog, [&](std::size_t k, ImportWriter& writer) {
    writer.add(read(files[k]), static_cast<double>(k) * options.period, std::nullopt);
  });
}

}  // namespace

ImportSummary import_pcd(const std::vector<std::string>& files, const ImportOptions& options,
                         const std::string& rawlog) {
  return import_files(files, options, rawlog, read_pcd);
}

ImportSummary import_ply(const std::vector<std::string>& files, const ImportOptions& options,
                         const std::string& rawlog) {
  return import_files(files, options, rawlog, read_ply);
}

}  // namespace mrpt_terrain::io
