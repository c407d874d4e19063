// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

/// \file
/// How a parameter struct describes itself. Each struct has one static template
///
///     template <class Self, class Visitor>
///     static void visit_params(Self& self, Visitor&& visit) {
///       visit(self.t_diff, ParamInfo{"t_diff", "T_diff", "m", 0.0, 10.0, "meaning"});
///     }
///
/// and the loader, the range check, the dump and doc/parameters.md all walk that one list, so that
/// they cannot disagree. A struct of structs has `visit_sections(self, visit)` instead, which calls
/// `visit(self.ground, "ground", "what the section is for")` per member.
///
/// Field types: `double`, `int`, `std::uint64_t`, `bool`, and enumerations that have an
/// `enum_names(E)` found by argument-dependent lookup (see `EnumNames`).
namespace mrpt_terrain {

/// One parameter: its key in files, the paper's symbol, unit, permitted range and meaning.
///
/// Angles are radians in memory. A key that ends in `_deg` is written in degrees in files; `unit`
/// is then "deg" and `min` and `max` are degrees too. The range is closed and not used for `bool`
/// and enumerations.
struct ParamInfo {
  const char* key;      ///< key in the file, unique within its section even when case is ignored
  const char* symbol;   ///< symbol in Meng, Cao et al. 2018, or "" where the paper has none
  const char* unit;     ///< "m", "m^2", "deg", "s", or "" for a plain number
  double min;           ///< smallest permitted value, in the unit of the file
  double max;           ///< largest permitted value, in the unit of the file
  const char* meaning;  ///< one phrase, without a full stop
};

/// The name of one enumerator as it stands in parameter files.
template <class Enum>
struct EnumName {
  Enum value;
  const char* name;
};

/// All names of an enumeration. Provide `constexpr EnumNames<E, N> enum_names(E)` beside `E`.
template <class Enum, std::size_t N>
using EnumNames = std::array<EnumName<Enum>, N>;

/// Name of an enumerator ("?" for a value outside the list, which only a cast can produce).
template <class Enum>
[[nodiscard]] constexpr const char* name_of(Enum value) {
  for (const auto& entry : enum_names(value)) {
    if (entry.value == value) return entry.name;
  }
  return "?";
}

}  // namespace mrpt_terrain
