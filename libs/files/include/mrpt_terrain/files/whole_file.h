// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fstream>
#include <string>

namespace mrpt_terrain::files {

/// A file that appears under its name only when it is complete: it is written as `<name>.part` and
/// renamed by `commit`. Without `commit` the part is removed and an older file of that name stays.
class WholeFile {
 public:
  explicit WholeFile(std::string file);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  /// Binary stream into the part, opened at the first call.
  /// Throws std::runtime_error "file: cannot be written: reason".
  std::ofstream& stream();
  /// Where to write, for code that opens files itself.
  [[nodiscard]] const std::string& part() const { return part_; }
  [[nodiscard]] const std::string& file() const { return file_; }
  /// Closes the stream and gives the file its name. Throws std::runtime_error if anything could
  /// not be written.
  void commit();

 private:
  std::string file_, part_;
  std::ofstream stream_;
  bool committed_ = false;
};

}  // namespace mrpt_terrain::files
