// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/published_tables.h"

#include <algorithm>
#include <array>

namespace mrpt_terrain::eval {
namespace {

constexpr std::size_t kMethods = 9;
constexpr std::array<const char*, kMethods> kMethodNames = {
    "ransac", "lmeds", "msac",          "rransac",     "mlesac",
    "prosac", "pca",   "least_squares", "paper_method"};
constexpr double kIllegible = -1.0;

struct SlopeRow {
  const char* slope;
  double angle;
  std::array<double, kMethods> mean;
  std::array<double, kMethods> variance;
};
constexpr std::array<SlopeRow, 6> kSlopes = {{
    {"A",
     7.74,
     {8.102, 8.155, 8.163, 8.154, 8.275, 8.040, 8.494, 8.467, 8.018},
     {0.0437, 0.0209, 0.0562, 0.0689, 0.1212, 0.0283, 0.0080, 0.0082, 0.0145}},
    {"B",
     13.86,
     {14.26, 14.25, 14.25, 14.26, 14.22, 14.24, 15.02, 14.92, 14.23},
     {0.0979, 0.0943, 0.0984, 0.0989, 0.1827, 0.0979, 0.2345, 0.2485, 0.0915}},
    {"C",
     18.51,
     {18.56, 18.54, 18.55, 18.54, 18.56, 18.57, 18.77, 18.74, 18.53},
     {0.0254, 0.0070, 0.0183, 0.0261, 0.1944, 0.0156, 0.0057, 0.0068, 0.0053}},
    {"A1",
     7.74,
     {7.904, 8.024, 7.952, 7.908, 8.120, 7.946, 8.643, 8.601, 7.854},
     {0.0714, 0.0255, 0.0668, 0.0758, 0.1366, 0.1903, 0.0204, 0.0201, 0.0097}},
    {"A2",
     7.74,
     {7.950, 8.021, 7.972, 7.960, 8.238, 7.929, 8.502, 8.470, 7.862},
     {0.0491, 0.0309, 0.0472, 0.0748, 0.0649, 0.0492, 0.0186, 0.0183, 0.0125}},
    {"A3",
     7.74,
     {8.099, 8.077, 8.090, 8.259, 8.072, 8.179, 8.737, 8.707, 8.026},
     {kIllegible, kIllegible, kIllegible, kIllegible, kIllegible, kIllegible, kIllegible,
      kIllegible, 0.0049}},
}};

const SlopeRow* row_of(const std::string& slope) {
  const auto* row = std::find_if(kSlopes.begin(), kSlopes.end(),
                                 [&slope](const SlopeRow& r) { return slope == r.slope; });
  return row == kSlopes.end() ? nullptr : row;
}

}  // namespace

std::optional<PublishedErrors> published_errors(const std::string& target) {
  if (target == "obstacle") return PublishedErrors{15.0, 0.1992, 0.3688, 0.3907, 0.5121};
  if (target == "pothole") return PublishedErrors{-9.0, 0.4385, 0.4385, 0.4463, 0.5851};
  if (target == "cluster 3") return PublishedErrors{18.51, -0.0353, 0.0666, 0.0779, 0.1636};
  return std::nullopt;
}

std::optional<PublishedSlope> published_slope(const std::string& slope, const std::string& method) {
  const SlopeRow* row = row_of(slope);
  const auto* name = std::find(kMethodNames.begin(), kMethodNames.end(), method);
  if (row == nullptr || name == kMethodNames.end()) return std::nullopt;
  const auto column = static_cast<std::size_t>(name - kMethodNames.begin());
  PublishedSlope cell{row->mean[column], std::nullopt};
  if (row->variance[column] != kIllegible) cell.variance = row->variance[column];
  return cell;
}

std::optional<double> published_angle(const std::string& slope) {
  const SlopeRow* row = row_of(slope);
  if (row == nullptr) return std::nullopt;
  return row->angle;
}

}  // namespace mrpt_terrain::eval
