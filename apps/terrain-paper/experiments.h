// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "options.h"
#include "results.h"

/// Told what is being done and the share of the run that is done, 0 to 1; returns whether to go on.
using RunProgress = std::function<bool(double share, const std::string& text)>;

/// The estimators that were built in, in the order of Table 4.
[[nodiscard]] mrpt_terrain::eval::PlaneEstimators built_in_estimators(const Options& options);

/// What a user should know about estimators that were not built in; empty if all were.
[[nodiscard]] std::string missing_estimators_text();

/// Runs all experiments that the options ask for. Throws for bad scenes and missing files.
[[nodiscard]] Results run_experiments(const Options& options, const RunProgress& progress);
