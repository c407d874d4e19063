// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/params/document.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "mrpt_terrain/params/parameter_error.h"
#include "text.h"

namespace mrpt_terrain::params {
namespace {

bool same_name(const std::string& a, const std::string& b) {
  return lower_case(a) == lower_case(b);
}

const Section* find_section(const std::vector<Section>& sections, const std::string& name) {
  const auto found = std::find_if(sections.begin(), sections.end(),
                                  [&name](const Section& s) { return same_name(s.name, name); });
  return found == sections.end() ? nullptr : &*found;
}

const Field* find_field(const Section& section, const std::string& key) {
  const auto found =
      std::find_if(section.fields.begin(), section.fields.end(),
                   [&key](const Field& field) { return same_name(field.info.key, key); });
  return found == section.fields.end() ? nullptr : &*found;
}

std::vector<std::string> names_of(const std::vector<Section>& sections) {
  std::vector<std::string> names;
  names.reserve(sections.size());
  for (const Section& section : sections) names.push_back("[" + section.name + "]");
  return names;
}

std::vector<std::string> keys_of(const Section& section) {
  std::vector<std::string> keys;
  for (const Field& field : section.fields) keys.emplace_back(field.info.key);
  return keys;
}

std::string unknown_section(const std::string& name, const std::vector<Section>& sections) {
  const std::vector<std::string> names = names_of(sections);
  const std::string meant = nearest("[" + name + "]", names);
  if (!meant.empty()) return "unknown section; did you mean " + meant + "?";
  return "unknown section; there are " + joined(names, ", ");
}

std::string unknown_key(const std::string& key, const Section& section,
                        const std::vector<Section>& sections) {
  for (const Section& other : sections) {
    const Field* field = find_field(other, key);
    if (field != nullptr) {
      return std::string("unknown key; did you mean `") + field->info.key + "` of [" + other.name +
             "]?";
    }
  }
  const std::string meant = nearest(key, keys_of(section));
  if (!meant.empty()) return "unknown key; did you mean `" + meant + "`?";
  return "unknown key; there are " + joined(keys_of(section), ", ");
}

/// Assigns the keys of one document and gathers what is wrong with them.
class Assignment {
 public:
  Assignment(const Document& document, const std::vector<Section>& sections)
      : document_(document), sections_(sections) {}

  void assign_section(const SectionText& text) {
    const Section* section = find_section(sections_, text.name);
    if (text.name.empty()) {
      for (const KeyText& key : text.keys) {
        problems_.push_back(document_.source + ": " + key.key + " = " + key.value +
                            ": stands outside of any [section]");
      }
    } else if (section == nullptr) {
      problems_.push_back(document_.source + ": [" + text.name +
                          "]: " + unknown_section(text.name, sections_));
    } else {
      for (const KeyText& key : text.keys) assign_key(*section, key);
    }
  }

  void throw_problems() const {
    if (!problems_.empty()) throw ParameterError(joined(problems_, "\n"));
  }

 private:
  void assign_key(const Section& section, const KeyText& text) {
    const Field* field = find_field(section, text.key);
    if (field == nullptr) {
      report(section, text, unknown_key(text.key, section, sections_));
    } else if (!given_.insert(section.name + "." + lower_case(text.key)).second) {
      report(section, text, "is given twice");
    } else if (const auto problem = assign(*field, text.value)) {
      report(section, text, *problem);
    }
  }

  void report(const Section& section, const KeyText& text, const std::string& problem) {
    problems_.push_back(place_text(document_.source, section.name, text.key, text.value) + ": " +
                        problem);
  }

  const Document& document_;
  const std::vector<Section>& sections_;
  std::set<std::string> given_;
  std::vector<std::string> problems_;
};

}  // namespace

void assign_all(const Document& document, const std::vector<Section>& sections) {
  Assignment assignment(document, sections);
  for (const SectionText& section : document.sections) assignment.assign_section(section);
  assignment.throw_problems();
}

std::string read_text_file(const std::string& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    throw ParameterError(file + ": cannot be read: is a folder");
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw ParameterError(file + ": cannot be read: " + std::strerror(errno));
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

}  // namespace mrpt_terrain::params
