// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/files/whole_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace mrpt_terrain::files {
namespace {

[[noreturn]] void fail(const std::string& file) {
  throw std::runtime_error(file + ": cannot be written: " + std::strerror(errno));
}

}  // namespace

WholeFile::WholeFile(std::string file) : file_(std::move(file)), part_(file_ + ".part") {}

WholeFile::~WholeFile() {
  if (committed_) return;
  stream_.close();
  std::remove(part_.c_str());
}

std::ofstream& WholeFile::stream() {
  if (!stream_.is_open()) {
    errno = 0;
    stream_.open(part_, std::ios::binary | std::ios::trunc);
    if (!stream_) fail(file_);
  }
  return stream_;
}

void WholeFile::commit() {
  errno = 0;
  if (stream_.is_open()) stream_.close();
  if (!stream_) fail(file_);
  if (std::rename(part_.c_str(), file_.c_str()) != 0) fail(file_);
  committed_ = true;
}

}  // namespace mrpt_terrain::files
