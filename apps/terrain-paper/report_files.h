// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "figures.h"
#include "options.h"
#include "results.h"
#include "text_table.h"

/// Every number of the tables, one per line: table, row, condition, method, statistic, published
/// value, ours, difference, 95 % interval, verdicts.
[[nodiscard]] std::string tables_csv(const Results& results);

/// Every angle of Tables 4 and 5, one per line: slope, condition, trial, method, degrees.
[[nodiscard]] std::string estimates_csv(const Results& results);

/// One page with all tables and figures and how they were made.
/// \param figures those whose pictures were made; they are in `figures/`
/// \param remarks what is missing and why, a line each
[[nodiscard]] std::string report_html(const Options& options, const Results& results,
                                      const std::vector<TextTable>& tables,
                                      const std::vector<Figure>& figures,
                                      const std::vector<std::string>& remarks);
