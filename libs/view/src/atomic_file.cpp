// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/atomic_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <system_error>

namespace mrpt_terrain::view {
namespace {

[[noreturn]] void refuse(const std::string& file, const std::string& reason) {
  throw std::runtime_error(file + ": cannot be written: " + reason);
}

/// Finds out before any work is done whether the folder takes a file, and why not.
void check_writable(const std::string& file, const std::string& part_file) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) refuse(file, std::strerror(EISDIR));
  std::FILE* probe = std::fopen(part_file.c_str(), "wb");
  if (probe == nullptr) refuse(file, std::strerror(errno));
  std::fclose(probe);
}

void write_content(const std::string& part_file, std::string_view content) {
  struct Closer {
    void operator()(std::FILE* open_file) const { std::fclose(open_file); }
  };
  std::unique_ptr<std::FILE, Closer> out(std::fopen(part_file.c_str(), "wb"));
  if (!out || std::fwrite(content.data(), 1, content.size(), out.get()) != content.size() ||
      std::fflush(out.get()) != 0) {
    throw std::runtime_error(std::strerror(errno));
  }
}

}  // namespace

void write_atomically(const std::string& file,
                      const std::function<void(const std::string& part_file)>& produce) {
  const std::string part_file = file + ".part";
  check_writable(file, part_file);
  std::error_code error;
  try {
    produce(part_file);
  } catch (const std::exception& failure) {
    std::filesystem::remove(part_file, error);
    refuse(file, failure.what());
  }
  std::filesystem::rename(part_file, file, error);
  if (!error) return;
  const std::string reason = error.message();
  std::filesystem::remove(part_file, error);
  refuse(file, reason);
}

void write_atomically(const std::string& file, std::string_view content) {
  write_atomically(file, [&](const std::string& part_file) { write_content(part_file, content); });
}

}  // namespace mrpt_terrain::view
