// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/params/set.h"

#include <cstddef>
#include <string_view>

#include "mrpt_terrain/params/parameter_error.h"
#include "text.h"

namespace mrpt_terrain::params {

Document read_assignment(const std::string& assignment, const std::string& source) {
  const std::string_view text = assignment;
  const std::size_t equals = text.find('=');
  const std::string_view name = trimmed(text.substr(0, equals));
  const std::size_t dot = name.find('.');
  const bool has_both = equals != std::string_view::npos && dot != std::string_view::npos &&
                        dot > 0 && dot + 1 < name.size();
  if (!has_both) {
    throw ParameterError(source + ": `" + assignment + "` must be written section.key=value");
  }
  const std::string section(name.substr(0, dot));
  const std::string key(name.substr(dot + 1));
  const std::string value(trimmed(text.substr(equals + 1)));
  return {source, {{section, {{key, value}}}}};
}

}  // namespace mrpt_terrain::params
