// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Writes doc/parameters.md (to the file named on the command line) from the field lists of the
/// parameter structs, so that the document cannot disagree with the program.
#include <cstdlib>
#include <fstream>
#include <iostream>

#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/params/documentation.h"

namespace {

using mrpt_terrain::DescriptionParams;

constexpr const char* kIntroduction =
    "# Parameters\n"
    "\n"
    "Generated from the field lists in the headers by `terrain-parameters-doc`; CONTRIBUTING.md "
    "says "
    "how to make\n"
    "it again. A parameter file is an `.ini` file with the sections below; keys that it does not "
    "give "
    "keep their\n"
    "default, and unknown keys, values out of range and values that cannot be read are refused. "
    "`params/paper.ini`\n"
    "holds all defaults. \"In the paper\": the symbol in Meng, Cao et al. 2018. Keys that end in "
    "`_deg` are degrees.\n"
    "\n";

/// All sections that a parameter file of the programs can have.
struct AllParams {
  DescriptionParams description;

  template <class Self, class Visitor>
  static void visit_sections(Self& self, Visitor&& visit) {
    DescriptionParams::visit_sections(self.description, visit);
  }
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: terrain-parameters-doc FILE\n";
    return EXIT_FAILURE;
  }
  std::ofstream file(argv[1], std::ios::binary);
  file << kIntroduction << mrpt_terrain::params::markdown_table(AllParams{});
  file.close();
  if (!file) {
    std::cerr << argv[1] << ": cannot be written\n";
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
