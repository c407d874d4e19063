// SPDX-License-Identifier: BSD-3-Clause
#include "label_inputs.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <stdexcept>

#include "input_support.h"
#include "mrpt_terrain/io/kitti_scan.h"

namespace {

using namespace mrpt_terrain;
namespace fs = std::filesystem;

bool is_folder(const std::string& input) {
  std::error_code ignored;
  return fs::is_directory(input, ignored);
}

bool holds_scans(const std::string& input) {
  return is_folder(input) || lower_extension(input) == ".bin";
}

// Scans and recordings are named differently; in one folder one could replace the other.
void refuse_mixture(const std::vector<std::string>& inputs) {
  std::error_code ignored;
  std::string scans, recording;
  for (const std::string& input : inputs) {
    if (holds_scans(input)) {
      scans = input;
    } else if (fs::exists(input, ignored)) {
      recording = input;
    }
  }
  if (scans.empty() || recording.empty()) return;
  throw std::invalid_argument(scans + " and " + recording +
                              ": .bin files and recordings in one run; label them in two, into "
                              "different folders");
}

void refuse_same_names(const std::vector<std::string>& scans) {
  std::map<std::string, std::string> scan_of;
  for (const std::string& scan : scans) {
    const auto [other, is_new] = scan_of.emplace(label_name(scan), scan);
    if (is_new) continue;
    throw std::invalid_argument(other->second + " and " + scan + ": both would be labelled in " +
                                other->first + "; label them in two runs, into different folders");
  }
}

void add_selected(const std::vector<std::string>& scans, const Selection& selection,
                  std::vector<std::string>& result) {
  for (std::size_t k = selection.from_index; k < scans.size() && k <= selection.to_index; ++k) {
    result.push_back(scans[k]);
  }
}

}  // namespace

LabelInputs find_label_inputs(const InputOptions& given) {
  LabelInputs result{given, {}};
  refuse_mixture(given.inputs);
  if (std::none_of(given.inputs.begin(), given.inputs.end(), holds_scans)) return result;
  if (!given.poses.empty()) {
    throw std::invalid_argument(
        "--poses: .bin files hold no times, so that poses have nothing to say about their points");
  }
  result.input.inputs.clear();
  for (const std::string& input : given.inputs) {
    try {
      add_selected(is_folder(input) ? io::find_kitti_scans(input) : std::vector{input},
                   given.selection, result.input.inputs);
    } catch (const io::ReadError& error) {
      result.problems.emplace_back(error.what());
    }
  }
  refuse_same_names(result.input.inputs);
  result.input.scan_files = true;
  result.input.selection.from_index = 0;
  result.input.selection.to_index = std::numeric_limits<std::size_t>::max();
  return result;
}

std::string label_name(const std::string& scan_file) {
  return fs::path(scan_file).stem().string() + ".label";
}

std::string label_name(std::size_t scan) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "%06zu.label", scan);
  return name.data();
}
