// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/params/yaml.h"

#include <cstddef>
#include <map>
#include <sstream>
#include <string_view>
#include <typeinfo>

#include "mrpt_terrain/params/numbers.h"
#include "mrpt_terrain/params/parameter_error.h"
#include "text.h"

namespace mrpt_terrain::params {
namespace {

using mrpt::containers::yaml;

/// Text of a scalar. Parsed YAML holds the text itself; trees built in memory hold numbers, and
/// MRPT's conversion to text would round them.
std::string scalar_text(const yaml::node_t& node) {
  const std::type_info& type = node.asScalar().type();
  if (type == typeid(double)) return to_text(node.as<double>());
  if (type == typeid(float)) return to_text(static_cast<double>(node.as<float>()));
  if (type == typeid(bool)) return node.as<bool>() ? "true" : "false";
  return node.as<std::string>();
}

std::string keys_wanted(const std::string& source, const std::string& section) {
  return source + ": [" + section + "]: must be a map of keys and values";
}

SectionText read_keys(const yaml::map_t& keys, const std::string& source,
                      const std::string& section) {
  SectionText text{section, {}};
  const std::string place = source + ": [" + section + "] ";
  for (const auto& [key, value] : keys) {
    const std::string name(key.internalAsStr());
    if (!value.isScalar() && !value.isNullNode()) {
      throw ParameterError(std::string(place)
                               .append(name)
                               .append(": must be a single value, not a ")
                               .append(value.typeName()));
    }
    text.keys.push_back({name, value.isScalar() ? scalar_text(value) : ""});
  }
  return text;
}

/// Looks at the lines of a file, one after the other.
class LineChecker {
 public:
  explicit LineChecker(const std::string& source) : source_(source) {}

  void check(std::string_view text, int line) {
    line_ = line;
    if (text.find('\t') < text.find_first_not_of(" \t")) fail("a tab cannot indent YAML");
    const std::string_view content = trimmed(yaml_without_comment(text));
    if (content.empty() || content == "---" || content.substr(0, 5) == "%YAML") return;
    const std::size_t colon = content.find(':');
    if (colon == std::string_view::npos) fail("is neither `section:` nor `key: value`");
    const std::string key(trimmed(content.substr(0, colon)));
    const std::string_view value = trimmed(content.substr(colon + 1));
    if (text.front() != ' ') {
      check_section(key, value);
    } else {
      check_key(key, value);
    }
  }

  /// After the last line of a section: MRPT's reader cannot read one without keys either.
  void finish() const {
    if (section_.empty() || keys_ > 0) return;
    throw ParameterError(source_ + ": [" + section_ + "]: has no keys; leave the section out");
  }

 private:
  // Only # starts a comment in YAML.
  static std::string_view yaml_without_comment(std::string_view text) {
    for (std::size_t k = 0; k < text.size(); ++k) {
      if (text[k] == '#' && (k == 0 || text[k - 1] == ' ')) return text.substr(0, k);
    }
    return text;
  }

  void check_section(const std::string& name, std::string_view value) {
    if (!value.empty()) {
      fail("stands outside of any section; write `section:` and below it `  " + name + ": " +
           std::string(value) + "`");
    }
    finish();
    section_ = name;
    keys_ = 0;
    remember("[" + section_ + "]", lower_case(section_));
  }

  void check_key(const std::string& key, std::string_view value) {
    const std::string place = "[" + section_ + "] " + key + " = " + std::string(value);
    if (section_.empty()) fail(place + ": stands outside of any section");
    // MRPT's reader fails at an empty value, with a message that does not say where.
    if (value.empty()) fail(place + ": has no value");
    if (std::string_view("{[|>&*!").find(value.front()) != std::string_view::npos) {
      fail(place + ": must be a single value");
    }
    remember(place, lower_case(section_) + "\n" + lower_case(key));
    ++keys_;
  }

  void remember(const std::string& place, const std::string& name) {
    const auto [first, is_new] = line_of_.emplace(name, line_);
    if (!is_new) {
      fail(place + ": is given twice, first in line " + std::to_string(first->second));
    }
  }

  [[noreturn]] void fail(const std::string& problem) const {
    throw ParameterError(source_ + ":" + std::to_string(line_) + ": " + problem);
  }

  const std::string& source_;
  int line_ = 0;
  std::string section_;
  int keys_ = 0;  // of the section so far
  std::map<std::string, int> line_of_;
};

}  // namespace

void check_yaml_text(const std::string& text, const std::string& source) {
  LineChecker checker(source);
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (!trimmed(line).empty()) checker.check(line, number);
  }
  checker.finish();
}

Document read_yaml(const std::string& file) {
  const std::string text = read_text_file(file);
  check_yaml_text(text, file);
  yaml root;
  try {
    root = yaml::FromText(text);
  } catch (const std::exception& error) {
    throw ParameterError(file + ": " + first_message(error.what()));
  }
  return read_yaml(root, file);
}

Document read_yaml(const yaml& root, const std::string& source) {
  Document document{source, {}};
  if (root.isNullNode()) return document;
  if (!root.isMap()) throw ParameterError(source + ": must be a map of sections");
  for (const auto& [name, keys] : root.asMap()) {
    const std::string section(name.internalAsStr());
    if (keys.isNullNode()) {
      document.sections.push_back({section, {}});
    } else if (keys.isMap()) {
      document.sections.push_back(read_keys(keys.asMap(), source, section));
    } else {
      throw ParameterError(keys_wanted(source, section));
    }
  }
  return document;
}

Document read_yaml_section(const yaml& keys, const std::string& source,
                           const std::string& section) {
  Document document{source, {}};
  if (keys.isNullNode()) return document;
  if (!keys.isMap()) {
    throw ParameterError(keys_wanted(source, section));
  }
  document.sections.push_back(read_keys(keys.asMap(), source, section));
  return document;
}

}  // namespace mrpt_terrain::params
