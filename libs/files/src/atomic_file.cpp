// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/files/atomic_file.h"

#include <stdexcept>

#include "mrpt_terrain/files/whole_file.h"

namespace mrpt_terrain::files {

void write_atomically(const std::string& file,
                      const std::function<void(const std::string& part_file)>& produce) {
  WholeFile whole(file);
  whole.stream().close();  // finds out before any work is done whether the folder takes a file
  try {
    produce(whole.part());
  } catch (const std::exception& failure) {
    throw std::runtime_error(file + ": cannot be written: " + failure.what());
  }
  whole.commit();
}

void write_atomically(const std::string& file, std::string_view content) {
  WholeFile whole(file);
  whole.stream().write(content.data(), static_cast<std::streamsize>(content.size()));
  whole.commit();
}

}  // namespace mrpt_terrain::files
