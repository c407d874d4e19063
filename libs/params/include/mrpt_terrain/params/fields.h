// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "mrpt_terrain/core/param_info.h"

/// \file
/// Parameter structs seen as lists of fields: the templates turn `visit_params` and
/// `visit_sections` (core/param_info.h) into plain lists, and all readers and writers work on
/// those.
namespace mrpt_terrain::params {

/// A field of any enumeration.
struct EnumField {
  void* value;
  std::vector<const char*> names;          ///< permitted names, in the order of declaration
  const char* (*name)(const void* value);  ///< name of the current value, "?" if it has none
  bool (*assign)(void* value, std::string_view name);  ///< false if there is no such name
};

/// One field of a struct that is alive elsewhere.
struct Field {
  ParamInfo info;
  std::variant<double*, int*, std::uint64_t*, bool*, EnumField> value;
};

/// One struct of fields, with the name that its section has in files.
struct Section {
  std::string name;
  std::string meaning;
  std::vector<Field> fields;
};

/// Sets a field from its text in a file. Empty if it worked, otherwise what is wrong with the text:
/// "must be within [0.0001, 1] m (point-to-plane distance of an inlier)"; the field is then
/// unchanged.
[[nodiscard]] std::optional<std::string> assign(const Field& field, std::string_view text);

/// Empty if the field's value is permitted, otherwise what is wrong with it.
[[nodiscard]] std::optional<std::string> problem_of(const Field& field);

/// Value as it is written in files; `assign` of this text gives the same bits back.
[[nodiscard]] std::string text_of(const Field& field);

/// Permitted values for people: "[0.0001, 1] m", "true or false", "mean_difference, ...".
[[nodiscard]] std::string permitted_text(const Field& field);

/// "file: [section] key = value", the beginning of every message about a key.
[[nodiscard]] std::string place_text(const std::string& source, const std::string& section,
                                     const std::string& key, const std::string& value);

/// Throws ParameterError with one line for each field whose value is not permitted.
void check_fields(const std::string& source, const std::vector<Section>& sections);

namespace detail {

inline auto access(double& value) { return &value; }
inline auto access(int& value) { return &value; }
inline auto access(std::uint64_t& value) { return &value; }
inline auto access(bool& value) { return &value; }

template <class Enum>
const char* enum_name(const void* value) {
  return name_of(*static_cast<const Enum*>(value));
}

template <class Enum>
bool assign_enum(void* value, std::string_view name) {
  for (const auto& entry : enum_names(Enum{})) {
    if (name != entry.name) continue;
    *static_cast<Enum*>(value) = entry.value;
    return true;
  }
  return false;
}

template <class Enum, class = std::enable_if_t<std::is_enum_v<Enum>>>
EnumField access(Enum& value) {
  EnumField field{&value, {}, &enum_name<Enum>, &assign_enum<Enum>};
  for (const auto& entry : enum_names(Enum{})) field.names.push_back(entry.name);
  return field;
}

}  // namespace detail

/// Fields of a struct with `visit_params`. They point into `params`.
template <class Params>
[[nodiscard]] std::vector<Field> fields_of(Params& params) {
  std::vector<Field> fields;
  Params::visit_params(params, [&fields](auto& value, const ParamInfo& info) {
    fields.push_back({info, detail::access(value)});
  });
  return fields;
}

/// Sections of a struct with `visit_sections`. They point into `params`.
template <class Params>
[[nodiscard]] std::vector<Section> sections_of(Params& params) {
  std::vector<Section> sections;
  Params::visit_sections(params, [&sections](auto& member, const char* name, const char* meaning) {
    sections.push_back({name, meaning, fields_of(member)});
  });
  return sections;
}

/// Range check of a struct in memory, for values that did not come from a file. Throws
/// ParameterError with one line per problem.
/// \param source beginning of the messages
template <class Params>
void check(const Params& params, const std::string& source = "parameters") {
  Params copy = params;
  check_fields(source, sections_of(copy));
}

}  // namespace mrpt_terrain::params
