// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/slope_score.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace mrpt_terrain::eval {
namespace {

/// The face on which nearly all points lie that a thing and a cluster share, or kNoFace.
std::int32_t face_of(const MatchedThing& thing, const ScanTruth& truth, const PointLabels& labels) {
  std::vector<std::size_t> on_face(truth.faces.size(), 0);
  std::size_t all = 0;
  for (std::size_t i = 0; i < truth.face.size(); ++i) {
    if (labels.cluster[i] != thing.cluster || truth.thing[i] != thing.thing) continue;
    if (truth.face[i] == kNoFace) continue;
    ++on_face[static_cast<std::size_t>(truth.face[i])];
    ++all;
  }
  const auto most = std::max_element(on_face.begin(), on_face.end());
  if (all == 0 || static_cast<double>(*most) < kOneFace * static_cast<double>(all)) return kNoFace;
  const auto face = static_cast<std::int32_t>(most - on_face.begin());
  return truth.faces[static_cast<std::size_t>(face)].inclination < kLeastInclination ? kNoFace
                                                                                     : face;
}

SlopeSample sample_of(const Slope& slope, const TrueFace& face, double distance) {
  SlopeSample sample;
  sample.truth = std::acos(std::clamp(face.normal.z(), -1.0, 1.0));
  sample.angle_error = slope.angle - sample.truth;
  sample.direction_error = std::remainder(slope.direction - direction_of(face.normal), 2.0 * M_PI);
  sample.angle_sigma = slope.angle_sigma;
  sample.direction_sigma = slope.direction_sigma;
  sample.distance = distance;
  return sample;
}

}  // namespace

void SlopeScore::add(const SlopeScore& other) {
  samples.insert(samples.end(), other.samples.begin(), other.samples.end());
  ramps += other.ramps;
  no_angle += other.no_angle;
  several += other.several;
}

void add_slopes(const ClusterMatching& matching, const ScanTruth& truth, const PointLabels& labels,
                const std::vector<ClusterDescription>& clusters, SlopeScore& score) {
  for (const MatchedThing& thing : matching.things) {
    const TrueThing& is = truth.things[static_cast<std::size_t>(thing.thing)];
    if (thing.cluster == kNoCluster || is.terrain_class != TerrainClass::kSlope) continue;
    ++score.ramps;
    const Slope& slope = clusters[static_cast<std::size_t>(thing.cluster)].slope;
    const std::int32_t face = face_of(thing, truth, labels);
    if (slope.status != FeatureStatus::kOk) {
      ++score.no_angle;
    } else if (face == kNoFace) {
      ++score.several;
    } else {
      score.samples.push_back(
          sample_of(slope, truth.faces[static_cast<std::size_t>(face)], thing.distance));
    }
  }
}

ErrorSummary summarise(const std::vector<double>& errors, const std::vector<double>& sigmas) {
  assert(errors.size() == sigmas.size());
  ErrorSummary summary;
  summary.samples = errors.size();
  if (errors.empty()) {
    summary.bias = summary.rmse = summary.p95 = summary.greatest =
        std::numeric_limits<double>::quiet_NaN();
    return summary;
  }
  const auto n = static_cast<double>(errors.size());
  std::vector<double> sizes;
  double squares = 0.0;
  for (std::size_t k = 0; k < errors.size(); ++k) {
    summary.bias += errors[k] / n;
    squares += errors[k] * errors[k];
    sizes.push_back(std::abs(errors[k]));
    if (sigmas[k] > 0.0) summary.in_two_sigma.count(sizes.back() <= 2.0 * sigmas[k]);
  }
  summary.rmse = std::sqrt(squares / n);
  std::sort(sizes.begin(), sizes.end());
  // The smallest one that at least 95 % do not exceed.
  summary.p95 = sizes[(95 * sizes.size() + 99) / 100 - 1];
  summary.greatest = sizes.back();
  return summary;
}

ErrorSummary angle_summary(const SlopeScore& score) {
  std::vector<double> errors, sigmas;
  for (const SlopeSample& sample : score.samples) {
    errors.push_back(sample.angle_error);
    sigmas.push_back(sample.angle_sigma);
  }
  return summarise(errors, sigmas);
}

ErrorSummary direction_summary(const SlopeScore& score) {
  std::vector<double> errors, sigmas;
  for (const SlopeSample& sample : score.samples) {
    errors.push_back(sample.direction_error);
    sigmas.push_back(sample.direction_sigma);
  }
  return summarise(errors, sigmas);
}

}  // namespace mrpt_terrain::eval
