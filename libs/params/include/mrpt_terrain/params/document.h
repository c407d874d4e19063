// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "mrpt_terrain/params/fields.h"

namespace mrpt_terrain::params {

/// A key and its value as the file has them, comments removed.
struct KeyText {
  std::string key;
  std::string value;
};

/// A section of a file.
struct SectionText {
  std::string name;
  std::vector<KeyText> keys;
};

/// What every kind of parameter file is read into, before anything is known about parameters.
struct Document {
  std::string source;  ///< file name, beginning of every message
  std::vector<SectionText> sections;
};

/// Sets the fields that the document names; fields it does not name keep their value. Names of
/// sections and keys are compared without regard to case. Throws ParameterError with one line for
/// each unknown section, unknown key (with the one that was probably meant), key given twice,
/// value that cannot be read and value out of range; some fields may be set by then.
void assign_all(const Document& document, const std::vector<Section>& sections);

/// Whole text of a file. Throws ParameterError "file: cannot be read: reason".
[[nodiscard]] std::string read_text_file(const std::string& file);

}  // namespace mrpt_terrain::params
