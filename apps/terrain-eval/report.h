// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "mrpt_terrain/eval/world_score.h"
#include "text_table.h"

/// The score of a family, or of all.
struct NamedScore {
  std::string name;
  mrpt_terrain::eval::WorldScore score;
};

/// Tables for people, the pooled score last in each.
/// \param scores one per family; the last one is pooled
/// \param details tables of every family and whole lists
[[nodiscard]] std::vector<TextTable> world_tables(const std::vector<NamedScore>& scores,
                                                  bool details);

/// "family,metric,group,value,count": everything, a number per line; `value` is empty where there
/// is nothing to measure, `count` is of what it was measured.
[[nodiscard]] std::string world_csv(const std::vector<NamedScore>& scores);

/// One line per false pothole.
[[nodiscard]] std::string false_potholes_csv(const mrpt_terrain::eval::WorldScore& score);
/// One line per true thing that counts and per cluster that is none.
[[nodiscard]] std::string things_csv(const mrpt_terrain::eval::WorldScore& score);

/// Support of labelled scans.
struct NamedSupport {
  std::string name;
  mrpt_terrain::eval::SupportScore score;
};
[[nodiscard]] std::vector<TextTable> support_tables(const std::vector<NamedSupport>& scores);
[[nodiscard]] std::string support_csv(const std::vector<NamedSupport>& scores);
