// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/params/ini.h"

#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/config/CConfigFilePrefixer.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <memory>
#include <string_view>
#include <variant>

#include "mrpt_terrain/params/parameter_error.h"
#include "text.h"

namespace mrpt_terrain::params {
namespace {

std::string at_line(const std::string& source, int line) {
  return source + ":" + std::to_string(line) + ": ";
}

/// Quotes what stands in a line, shortened where it is long.
std::string quoted(std::string_view text) {
  constexpr std::size_t kMost = 60;
  return "`" + std::string(text.substr(0, kMost)) + (text.size() > kMost ? "...`" : "`");
}

/// Looks at the lines of a file, one after the other.
class LineChecker {
 public:
  explicit LineChecker(const std::string& source) : source_(source) {}

  void check(std::string_view text, int line) {
    // Not `without_comment`: MRPT's reader knows whole-line comments and cuts values by itself.
    const std::string_view content = trimmed(text);
    if (without_comment(content).empty() || content.substr(0, 7) == "@define") return;
    if (content.front() == '[') {
      check_header(content, line);
    } else {
      check_key(content, line);
    }
  }

 private:
  void check_header(std::string_view content, int line) {
    const std::size_t end = content.find(']');
    if (end == std::string_view::npos) {
      throw ParameterError(at_line(source_, line) + quoted(content) +
                           ": the ] of the section is missing");
    }
    if (!without_comment(content.substr(end + 1)).empty()) {
      throw ParameterError(at_line(source_, line) + quoted(content) +
                           ": only a comment may follow the section");
    }
    section_ = std::string(trimmed(content.substr(1, end - 1)));
  }

  void check_key(std::string_view content, int line) {
    const std::size_t equals = content.find('=');
    const std::string_view key = trimmed(content.substr(0, equals));
    if (equals == std::string_view::npos || key.empty()) {
      throw ParameterError(at_line(source_, line) + quoted(content) +
                           ": is neither [section] nor key = value");
    }
    const auto name = lower_case(section_) + "\n" + lower_case(key);
    const auto [first, is_new] = line_of_.emplace(name, line);
    if (is_new) return;
    const std::string_view value = without_comment(trimmed(content.substr(equals + 1)));
    throw ParameterError(at_line(source_, line) + "[" + section_ + "] " + std::string(key) + " = " +
                         std::string(value) + ": is given twice, first in line " +
                         std::to_string(first->second));
  }

  const std::string& source_;
  std::string section_;
  std::map<std::string, int> line_of_;
};

// It lists neither its sections nor its keys right, so that every key would be missed in silence.
void refuse_prefixer(const mrpt::config::CConfigFileBase& config, const std::string& source) {
  if (dynamic_cast<const mrpt::config::CConfigFilePrefixer*>(&config) == nullptr) return;
  throw ParameterError(source + ": cannot be read through a CConfigFilePrefixer; give the file " +
                       "itself and the whole name of the section");
}

SectionText read_section(const mrpt::config::CConfigFileBase& config, const std::string& name) {
  SectionText section{name, {}};
  std::vector<std::string> keys;
  config.getAllKeys(name, keys);
  for (const std::string& key : keys) {
    const std::string value = config.read_string(name, key, "");
    section.keys.push_back({key, std::string(without_comment(value))});
  }
  return section;
}

std::string comment_of(const Field& field) {
  const std::string symbol = field.info.symbol;
  const bool is_enum = std::holds_alternative<EnumField>(field.value);
  return std::string(field.info.meaning) + " (" + symbol + (symbol.empty() ? "" : ": ") +
         (is_enum ? "one of " : "") + permitted_text(field) + ")";
}

}  // namespace

void check_ini_text(const std::string& text, const std::string& source) {
  LineChecker checker(source);
  std::string logical;  // lines that end in a backslash belong together
  int line = 0;
  int first_line = 1;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view physical(text.data() + begin, end - begin);
    begin = end + 1;
    ++line;
    if (!physical.empty() && physical.back() == '\r') physical.remove_suffix(1);
    const bool continued = !physical.empty() && physical.back() == '\\';
    if (continued) physical.remove_suffix(1);
    logical += physical;
    if (continued && begin < text.size()) continue;
    checker.check(logical, first_line);
    logical.clear();
    first_line = line + 1;
  }
}

Document read_ini(const std::string& file) {
  const std::string text = read_text_file(file);
  check_ini_text(text, file);
  std::unique_ptr<mrpt::config::CConfigFileMemory> config;
  try {
    config = std::make_unique<mrpt::config::CConfigFileMemory>(text);
  } catch (const std::exception& error) {
    throw ParameterError(file + ": " + first_message(error.what()));
  }
  return read_ini(*config, file);
}

Document read_ini(const mrpt::config::CConfigFileBase& config, const std::string& source) {
  refuse_prefixer(config, source);
  Document document{source, {}};
  std::vector<std::string> names;
  config.getAllSections(names);
  for (const std::string& name : names) document.sections.push_back(read_section(config, name));
  return document;
}

Document read_ini_section(const mrpt::config::CConfigFileBase& config, const std::string& source,
                          const std::string& section) {
  refuse_prefixer(config, source);
  Document document{source, {}};
  if (config.sectionExists(section)) document.sections.push_back(read_section(config, section));
  return document;
}

std::string ini_text(const std::vector<Section>& sections) {
  std::string text;
  for (const Section& section : sections) {
    if (!text.empty()) text += "\n";
    text += "# " + section.meaning + "\n[" + section.name + "]\n";
    for (const Field& field : section.fields) {
      text += "# " + comment_of(field) + "\n";
      text += std::string(field.info.key) + " = " + text_of(field) + "\n";
    }
  }
  return text;
}

}  // namespace mrpt_terrain::params
