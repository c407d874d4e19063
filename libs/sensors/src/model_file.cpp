// SPDX-License-Identifier: BSD-3-Clause
#include "model_file.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

#include "mrpt_terrain/params/numbers.h"

namespace mrpt_terrain::sensors {

ModelFile::ModelFile(std::string file) : file_(std::move(file)) {
  try {
    root_ = YAML::LoadFile(file_);
  } catch (const YAML::BadFile&) {
    throw std::runtime_error(file_ + ": cannot be read");
  } catch (const YAML::ParserException& error) {
    throw std::runtime_error(file_ + ":" + std::to_string(error.mark.line + 1) +
                             ": is not valid YAML: " + error.msg);
  }
  if (!root_.IsMap()) throw std::runtime_error(file_ + ": must be a map of keys to values");
  refuse_keys_given_twice(root_);
}

std::string ModelFile::place(const YAML::Node& node) const {
  return file_ + ":" + std::to_string(node.Mark().line + 1) + ": ";
}

void ModelFile::fail(const std::string& key, const std::string& what) const {
  const YAML::Node node = root_[key];
  throw std::runtime_error((node.IsDefined() ? place(node) : file_ + ": ") + key + ": " + what);
}

void ModelFile::refuse_keys_given_twice(const YAML::Node& map) const {
  std::set<std::string> seen;
  for (const auto& entry : map) {
    const auto key = entry.first.as<std::string>("");
    if (key.empty()) throw std::runtime_error(place(entry.first) + "a key must be a word");
    if (!seen.insert(key).second) {
      throw std::runtime_error(place(entry.first) + key + ": is given twice");
    }
  }
}

void ModelFile::refuse_other_keys(const std::vector<std::string_view>& known) const {
  for (const auto& entry : root_) {
    const auto key = entry.first.as<std::string>();
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      throw std::runtime_error(place(entry.first) + key + ": unknown key");
    }
  }
}

std::string ModelFile::text(const std::string& key) const { return text_of(key, required(key)); }

std::vector<std::string> ModelFile::texts(const std::string& key) const {
  std::vector<std::string> result;
  if (!has(key)) return result;
  for (const auto& item : list(key)) result.push_back(text_of(key, item));
  return result;
}

double ModelFile::number(const std::string& key, Range range) const {
  return number_of(key, required(key), range);
}

double ModelFile::number_or(const std::string& key, Range range, double otherwise) const {
  return has(key) ? number(key, range) : otherwise;
}

std::vector<double> ModelFile::numbers(const std::string& key, Range range) const {
  std::vector<double> result;
  for (const auto& item : list(key)) result.push_back(number_of(key, item, range));
  return result;
}

params::Document ModelFile::section(const std::string& key) const {
  const YAML::Node map = required(key);
  if (!map.IsMap()) fail(key, "must be a map of keys to values");
  refuse_keys_given_twice(map);
  params::Document document{file_, {{key, {}}}};
  for (const auto& entry : map) {
    const auto name = entry.first.as<std::string>();
    document.sections[0].keys.push_back({name, text_of(key + "." + name, entry.second)});
  }
  return document;
}

YAML::Node ModelFile::required(const std::string& key) const {
  if (!has(key)) fail(key, "is missing");
  return root_[key];
}

YAML::Node ModelFile::list(const std::string& key) const {
  YAML::Node node = required(key);
  if (!node.IsSequence()) fail(key, "must be a list");
  return node;
}

std::string ModelFile::text_of(const std::string& key, const YAML::Node& node) const {
  const std::string text = node.IsScalar() ? node.Scalar() : std::string();
  if (text.empty())
    throw std::runtime_error(place(node) + key + ": must be a text that is not empty");
  return text;
}

double ModelFile::number_of(const std::string& key, const YAML::Node& node, Range range) const {
  const std::string text = text_of(key, node);
  double value = 0.0;
  if (params::parse(text, value) != params::NumberStatus::kOk) {
    throw std::runtime_error(place(node) + key + ": '" + text + "' is not a number");
  }
  if (!(value >= range.min && value <= range.max)) {
    throw std::runtime_error(place(node) + key + ": = " + text + ": must be within [" +
                             params::to_text(range.min) + ", " + params::to_text(range.max) + "]");
  }
  return value;
}

}  // namespace mrpt_terrain::sensors
