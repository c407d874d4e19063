// SPDX-License-Identifier: BSD-3-Clause
#include "verbosity_option.h"

#include <map>
#include <string>

void add_verbosity(CLI::App& command, Verbosity& verbosity) {
  static const std::map<std::string, Verbosity> kVerbosities = {{"ERROR", Verbosity::kError},
                                                                {"WARN", Verbosity::kWarn},
                                                                {"INFO", Verbosity::kInfo},
                                                                {"DEBUG", Verbosity::kDebug}};
  command.add_option("-v,--verbosity", verbosity, "ERROR, WARN, INFO or DEBUG")
      ->transform(CLI::CheckedTransformer(kVerbosities, CLI::ignore_case).description(""))
      ->type_name("LEVEL");
  command.add_flag_callback(
      "-q,--quiet", [&verbosity] { verbosity = Verbosity::kError; }, "Print errors only");
}
