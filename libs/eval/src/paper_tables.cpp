// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/paper_tables.h"

#include <algorithm>

namespace mrpt_terrain::eval {
namespace {

constexpr double kDegrees = 57.29577951308232;
constexpr double kCentimetres = 100.0;

// One value per trial in which `value` finds one.
template <class Value>
Series series_of(const std::vector<Trial>& trials, std::size_t target, Value&& value) {
  Series series;
  series.reserve(trials.size());
  for (const Trial& trial : trials) {
    const Measurement& measured = trial[target];
    series.push_back(measured.clusters > 0 ? value(measured) : std::nullopt);
  }
  return series;
}

std::optional<double> degrees_if_ok(FeatureStatus status, double angle) {
  if (status != FeatureStatus::kOk) return std::nullopt;
  return kDegrees * angle;
}

using BeamMember = BeamAngle Measurement::*;

Series beam_angles(const std::vector<Trial>& trials, std::size_t target, BeamMember member) {
  return series_of(trials, target, [member](const Measurement& m) {
    return degrees_if_ok((m.*member).status, (m.*member).angle);
  });
}

bool has_run(const std::vector<Trial>& trials, std::size_t target, BeamMember member) {
  return std::any_of(trials.begin(), trials.end(), [&](const Trial& trial) {
    return (trial[target].*member).status != FeatureStatus::kNotNeeded;
  });
}

Coverage coverage_of(const std::vector<Trial>& trials, std::size_t target, BeamMember member,
                     double truth) {
  std::vector<double> errors;
  std::vector<double> sigmas;
  for (const Trial& trial : trials) {
    const BeamAngle& beam = trial[target].*member;
    if (trial[target].clusters == 0 || beam.status != FeatureStatus::kOk) continue;
    errors.push_back(kDegrees * beam.angle - truth);
    sigmas.push_back(kDegrees * beam.sigma);
  }
  return two_sigma_coverage(errors, sigmas);
}

Duel duel(const MethodRow& ours, const MethodRow& theirs, double truth,
          const BootstrapParams& bootstrap) {
  std::vector<double> our_errors;
  std::vector<double> their_errors;
  for (std::size_t k = 0; k < ours.summary.series.size(); ++k) {
    const std::optional<double>& a = ours.summary.series[k];
    const std::optional<double>& b = theirs.summary.series[k];
    if (!a || !b) continue;
    our_errors.push_back(*a - truth);
    their_errors.push_back(*b - truth);
  }
  Duel result{ours.method, our_errors.size(), {}};
  if (result.trials > 0) {
    result.differences = bootstrap_differences(our_errors, their_errors, bootstrap);
  }
  return result;
}

}  // namespace

SeriesSummary summarize(Series series, std::size_t asked, double truth,
                        const BootstrapParams& bootstrap) {
  SeriesSummary result;
  std::vector<double> values;
  for (const std::optional<double>& value : series) {
    if (value) values.push_back(*value);
  }
  result.series = std::move(series);
  result.missing = asked - values.size();
  result.statistics = error_statistics(values, truth);
  if (values.empty()) return result;
  for (double& value : values) value -= truth;
  result.intervals = bootstrap_intervals(values, bootstrap);
  return result;
}

Series height_indices(const std::vector<Trial>& trials, std::size_t target) {
  return series_of(trials, target, [](const Measurement& m) -> std::optional<double> {
    return kCentimetres * m.description.height.h_f;
  });
}

Series described_angles(const std::vector<Trial>& trials, std::size_t target) {
  return series_of(trials, target, [](const Measurement& m) {
    return degrees_if_ok(m.description.slope.status, m.description.slope.angle);
  });
}

Series roughness_flags(const std::vector<Trial>& trials, std::size_t target) {
  return series_of(trials, target, [](const Measurement& m) -> std::optional<double> {
    if (m.description.roughness.status != FeatureStatus::kOk) return std::nullopt;
    return m.description.roughness.rough ? 1.0 : 0.0;
  });
}

Series estimated_angles(const std::vector<Trial>& trials, std::size_t target,
                        std::size_t estimator) {
  return series_of(trials, target, [estimator](const Measurement& m) {
    return degrees_if_ok(m.planes[estimator].status, m.planes[estimator].angle);
  });
}

SlopeResult slope_result(const PaperScene& scene, std::size_t target, const TrialPlan& plan,
                         const std::vector<std::string>& names, const std::vector<Trial>& trials,
                         const BootstrapParams& bootstrap) {
  SlopeResult result;
  result.slope = scene.targets[target].name;
  result.conditions = plan.conditions;
  result.truth = kDegrees * scene.targets[target].slope;
  const auto add = [&](const std::string& method, Series series) {
    const auto limit = plan.limits.find(method);
    const std::size_t asked =
        limit == plan.limits.end() ? trials.size() : std::min(trials.size(), limit->second);
    result.rows.push_back(
        {method, summarize(std::move(series), asked, result.truth, bootstrap), {}});
  };
  for (std::size_t k = 0; k < names.size(); ++k) {
    add(names[k], estimated_angles(trials, target, k));
  }
  const std::size_t compared = result.rows.size();
  if (has_run(trials, target, &Measurement::beam)) {
    add(kBeam, beam_angles(trials, target, &Measurement::beam));
    result.beam_coverage = coverage_of(trials, target, &Measurement::beam, result.truth);
  }
  if (has_run(trials, target, &Measurement::beam_to_ground)) {
    add(kBeamToGround, beam_angles(trials, target, &Measurement::beam_to_ground));
    result.beam_to_ground_coverage =
        coverage_of(trials, target, &Measurement::beam_to_ground, result.truth);
  }
  for (std::size_t k = 0; k < compared; ++k) {
    for (std::size_t ours = compared; ours < result.rows.size(); ++ours) {
      result.rows[k].duels.push_back(
          duel(result.rows[ours], result.rows[k], result.truth, bootstrap));
    }
  }
  return result;
}

}  // namespace mrpt_terrain::eval
