// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <string_view>
#include <vector>

#include "mrpt_terrain/params/document.h"

namespace mrpt_terrain::sensors {

/// A permitted range, both ends included.
struct Range {
  double min, max;
};

/// The YAML file of one model. Every complaint is a std::runtime_error that names file, line and
/// key.
class ModelFile {
 public:
  explicit ModelFile(std::string file);

  void refuse_other_keys(const std::vector<std::string_view>& known) const;
  [[nodiscard]] bool has(const std::string& key) const { return root_[key].IsDefined(); }
  [[nodiscard]] std::string text(const std::string& key) const;
  /// Empty if the key is not there.
  [[nodiscard]] std::vector<std::string> texts(const std::string& key) const;
  [[nodiscard]] double number(const std::string& key, Range range) const;
  [[nodiscard]] double number_or(const std::string& key, Range range, double otherwise) const;
  [[nodiscard]] std::vector<double> numbers(const std::string& key, Range range) const;
  /// A map of keys and values, as a document with one section of that name.
  [[nodiscard]] params::Document section(const std::string& key) const;

  [[noreturn]] void fail(const std::string& key, const std::string& what) const;

 private:
  [[nodiscard]] std::string place(const YAML::Node& node) const;
  [[nodiscard]] YAML::Node required(const std::string& key) const;
  [[nodiscard]] YAML::Node list(const std::string& key) const;
  [[nodiscard]] std::string text_of(const std::string& key, const YAML::Node& node) const;
  [[nodiscard]] double number_of(const std::string& key, const YAML::Node& node, Range range) const;
  void refuse_keys_given_twice(const YAML::Node& map) const;

  std::string file_;
  YAML::Node root_;
};

}  // namespace mrpt_terrain::sensors
