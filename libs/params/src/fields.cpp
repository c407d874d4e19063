// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/params/fields.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include "mrpt_terrain/params/numbers.h"
#include "mrpt_terrain/params/parameter_error.h"
#include "text.h"

namespace mrpt_terrain::params {
namespace {

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

bool in_degrees(const ParamInfo& info) { return std::string_view(info.unit) == "deg"; }

std::string with_meaning(const std::string& rule, const ParamInfo& info) {
  return rule + " (" + info.meaning + ")";
}

std::string out_of_range(const Field& field) {
  return with_meaning("must be within " + permitted_text(field), field.info);
}

std::string not_listed(const Field& field) {
  const bool is_bool = std::holds_alternative<bool*>(field.value);
  return with_meaning((is_bool ? "must be " : "must be one of ") + permitted_text(field),
                      field.info);
}

// Bounds in the unit in memory: a value read from the text of a bound equals it bit for bit.
bool in_range(double value, const ParamInfo& info) {
  const double min = in_degrees(info) ? radians_of(info.min) : info.min;
  const double max = in_degrees(info) ? radians_of(info.max) : info.max;
  return value >= min && value <= max;  // false for NaN
}

template <class Number>
bool whole_in_range(Number value, const ParamInfo& info) {
  return in_range(static_cast<double>(value), info);
}

std::optional<std::string> number_problem(NumberStatus status, const Field& field,
                                          const char* not_a_number) {
  const std::string range = "; " + out_of_range(field);
  switch (status) {
    case NumberStatus::kOk:
      return std::nullopt;
    case NumberStatus::kNotANumber:
      return not_a_number + range;
    case NumberStatus::kNotFinite:
      return "is not a finite number" + range;
    case NumberStatus::kUnrepresentable:
      break;
  }
  return out_of_range(field);
}

std::optional<std::string> assign_real(const Field& field, double& target, std::string_view text) {
  double value = 0.0;
  const NumberStatus status =
      in_degrees(field.info) ? parse_degrees(text, value) : parse(text, value);
  if (auto problem = number_problem(status, field, "is not a number")) return problem;
  if (!in_range(value, field.info)) return out_of_range(field);
  target = value;
  return std::nullopt;
}

template <class Integer>
std::optional<std::string> assign_whole(const Field& field, Integer& target,
                                        std::string_view text) {
  Integer value = 0;
  const NumberStatus status = parse(text, value);
  if (auto problem = number_problem(status, field, "is not a whole number")) return problem;
  if (!whole_in_range(value, field.info)) return out_of_range(field);
  target = value;
  return std::nullopt;
}

std::optional<std::string> assign_bool(const Field& field, bool& target, std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, bool>, 8> kWords = {{{"true", true},
                                                                               {"false", false},
                                                                               {"yes", true},
                                                                               {"no", false},
                                                                               {"on", true},
                                                                               {"off", false},
                                                                               {"1", true},
                                                                               {"0", false}}};
  const std::string word = lower_case(text);
  const auto found = std::find_if(kWords.begin(), kWords.end(),
                                  [&word](const auto& entry) { return entry.first == word; });
  if (found == kWords.end()) return not_listed(field);
  target = found->second;
  return std::nullopt;
}

}  // namespace

std::optional<std::string> assign(const Field& field, std::string_view text) {
  if (text.empty()) return with_meaning("has no value", field.info);
  return std::visit(Overloaded{
                        [&](double* target) { return assign_real(field, *target, text); },
                        [&](int* target) { return assign_whole(field, *target, text); },
                        [&](std::uint64_t* target) { return assign_whole(field, *target, text); },
                        [&](bool* target) { return assign_bool(field, *target, text); },
                        [&](const EnumField& target) -> std::optional<std::string> {
                          if (target.assign(target.value, text)) return std::nullopt;
                          return not_listed(field);
                        },
                    },
                    field.value);
}

std::optional<std::string> problem_of(const Field& field) {
  const bool permitted = std::visit(
      Overloaded{
          [&](const double* value) { return in_range(*value, field.info); },
          [&](const int* value) { return whole_in_range(*value, field.info); },
          [&](const std::uint64_t* value) { return whole_in_range(*value, field.info); },
          [](const bool*) { return true; },
          [](const EnumField& value) {
            const std::string_view name = value.name(value.value);
            return std::find(value.names.begin(), value.names.end(), name) != value.names.end();
          },
      },
      field.value);
  if (permitted) return std::nullopt;
  const bool is_enum = std::holds_alternative<EnumField>(field.value);
  return is_enum ? not_listed(field) : out_of_range(field);
}

std::string text_of(const Field& field) {
  return std::visit(Overloaded{
                        [&](const double* value) {
                          return in_degrees(field.info) ? to_text_degrees(*value) : to_text(*value);
                        },
                        [](const int* value) { return std::to_string(*value); },
                        [](const std::uint64_t* value) { return std::to_string(*value); },
                        [](const bool* value) { return std::string(*value ? "true" : "false"); },
                        [](const EnumField& value) { return std::string(value.name(value.value)); },
                    },
                    field.value);
}

std::string permitted_text(const Field& field) {
  if (std::holds_alternative<bool*>(field.value)) return "true or false";
  if (const auto* value = std::get_if<EnumField>(&field.value)) return joined(value->names, ", ");
  const std::string range = "[" + to_text(field.info.min) + ", " + to_text(field.info.max) + "]";
  const std::string unit = field.info.unit;
  return unit.empty() ? range : range + " " + unit;
}

std::string place_text(const std::string& source, const std::string& section,
                       const std::string& key, const std::string& value) {
  return source + ": [" + section + "] " + key + " = " + value;
}

void check_fields(const std::string& source, const std::vector<Section>& sections) {
  std::vector<std::string> problems;
  for (const Section& section : sections) {
    for (const Field& field : section.fields) {
      const auto problem = problem_of(field);
      if (!problem) continue;
      problems.push_back(place_text(source, section.name, field.info.key, text_of(field)) + ": " +
                         *problem);
    }
  }
  if (!problems.empty()) throw ParameterError(joined(problems, "\n"));
}

}  // namespace mrpt_terrain::params
