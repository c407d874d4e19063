// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "options.h"

/// What a run of `label` reads: recordings as they were given, or the scans of KITTI folders one by
/// one, of which the selection by entries has been made.
struct LabelInputs {
  InputOptions input;
  std::vector<std::string> problems;  ///< inputs that cannot be read, and why
};

/// Finds the scans of folders. Throws std::invalid_argument for recordings and scans in one run,
/// for scans whose labels would have the same name, and for options that say nothing about scans.
[[nodiscard]] LabelInputs find_label_inputs(const InputOptions& given);

/// Name of a scan file's label file.
[[nodiscard]] std::string label_name(const std::string& scan_file);
/// Name of the label file of a recording's scan.
[[nodiscard]] std::string label_name(std::size_t scan);
