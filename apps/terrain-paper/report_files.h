// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "results.h"

/// Every number of the tables, one per line: table, row, condition, method, statistic, published
/// value, ours, difference, 95 % interval, verdicts.
[[nodiscard]] std::string tables_csv(const Results& results);

/// Every angle of Tables 4 and 5, one per line: slope, condition, trial, method, degrees.
[[nodiscard]] std::string estimates_csv(const Results& results);
