// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

#include "messages.h"

/// Adds `-v,--verbosity LEVEL` and `-q,--quiet` to a command.
void add_verbosity(CLI::App& command, Verbosity& verbosity);
