// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "figures.h"
#include "options.h"
#include "results.h"
#include "text_table.h"

/// One page with all tables and figures and how they were made. It holds the pictures itself, so
/// that it can be sent about, and links to the files beside it.
/// \param figures those whose pictures were made; they are read from `figures/`
/// \param remarks what is missing and why, a line each
[[nodiscard]] std::string report_html(const Options& options, const Results& results,
                                      const std::vector<TextTable>& tables,
                                      const std::vector<Figure>& figures,
                                      const std::vector<std::string>& remarks);
