// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "../terrain-rawlog/app_params.h"
#include "options.h"

/// The parameters of terrain-rawlog with what the command line changes.
[[nodiscard]] AppParams load_params(const CommonOptions& options);
