// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mrpt_terrain/eval/bootstrap.h"
#include "mrpt_terrain/eval/error_statistics.h"
#include "mrpt_terrain/eval/paper_experiments.h"

/// \file
/// From trials to the rows of the paper's tables.
namespace mrpt_terrain::eval {

/// Names of the two angles of `slope.method = beam` beside those of the estimators.
inline constexpr const char* kBeam = "beam";
inline constexpr const char* kBeamToGround = "beam_to_ground";

/// What a method said in each trial: nothing where it was not asked or gave no answer.
using Series = std::vector<std::optional<double>>;

/// Numbers of a series about the truth, in the unit of the series.
struct SeriesSummary {
  Series series;
  std::size_t missing = 0;  ///< trials without an answer though one was asked for
  ErrorStatistics statistics;
  ErrorIntervals intervals;  ///< of `statistics`, 95 %; zero without answers
};

/// \param asked trials in which an answer was asked for
[[nodiscard]] SeriesSummary summarize(Series series, std::size_t asked, double truth,
                                      const BootstrapParams& bootstrap);

/// Height indices of a target, centimetres as in Table 2.
[[nodiscard]] Series height_indices(const std::vector<Trial>& trials, std::size_t target);

/// Angles of a target as the description has them (Table 3), degrees.
[[nodiscard]] Series described_angles(const std::vector<Trial>& trials, std::size_t target);

/// R_n of a target: 0 flat, 1 rough.
[[nodiscard]] Series roughness_flags(const std::vector<Trial>& trials, std::size_t target);

/// Angles of a target by an estimator, degrees.
/// \param estimator index into the estimators of the trials
[[nodiscard]] Series estimated_angles(const std::vector<Trial>& trials, std::size_t target,
                                      std::size_t estimator);

/// One of our estimators against another, in the trials in which both answered.
struct Duel {
  std::string ours;
  std::size_t trials = 0;
  PairedDifferences differences;  ///< degrees, degrees^2; zero without common trials
};

/// A method in one column of Table 4 or 5; degrees.
struct MethodRow {
  std::string method;
  SeriesSummary summary;
  std::vector<Duel> duels;  ///< of `beam` and `beam_to_ground` against this method
};

/// One slope under one condition.
struct SlopeResult {
  std::string slope;
  TrialConditions conditions;
  double truth = 0.0;           ///< degrees
  std::vector<MethodRow> rows;  ///< the estimators, then beam and beam_to_ground if they ran
  std::optional<Coverage> beam_coverage;
  std::optional<Coverage> beam_to_ground_coverage;
};

/// \param target index of the slope in the scene
/// \param names of the estimators, in the order of the trials
[[nodiscard]] SlopeResult slope_result(const PaperScene& scene, std::size_t target,
                                       const TrialPlan& plan, const std::vector<std::string>& names,
                                       const std::vector<Trial>& trials,
                                       const BootstrapParams& bootstrap);

}  // namespace mrpt_terrain::eval
