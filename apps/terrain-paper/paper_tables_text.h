// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "results.h"
#include "text_table.h"

/// The tables that are printed and put into the report, in the order of the paper.
[[nodiscard]] std::vector<TextTable> paper_tables(const Results& results);
