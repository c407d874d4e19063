// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/unseen_cells.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "field_worlds.h"

namespace mrpt_terrain {
namespace {

constexpr double kHeight = 1.0;  // of the sensor
constexpr std::array<float, 3> kOrigin{0.0F, 0.0F, static_cast<float>(kHeight)};
// The lowest beam meets level ground here.
const double kBlind = kHeight / std::tan(worlds::radians(25.0));

worlds::LidarModel sensor() {
  worlds::LidarModel model;
  model.beams = 64;
  model.lowest_deg = -25.0;
  model.highest_deg = 5.0;
  model.azimuth_step_deg = 0.25;
  return model;
}

struct Cells {
  DescriptionWorkspace workspace;
  Description description;
  UnseenWorkspace scratch;
  std::vector<UnseenReason> reasons;

  explicit Cells(const Points& points, bool origins = true) {
    const ScanView scan{points.view(), {origins ? &kOrigin : nullptr, nullptr}};
    describe(scan, worlds::field_params(), workspace, description);
    explain_unseen_cells(scan, workspace, description, scratch, reasons);
  }
  [[nodiscard]] UnseenReason at(double x, double y) const {
    CellIndex cell;
    EXPECT_TRUE(description.grid.geometry.cell_at(x, y, cell));
    return reasons[static_cast<std::size_t>(value_of(description.grid.geometry.id_of(cell)))];
  }
};

Points level_ground(double only_left_of = 1e9) {
  const Points all = worlds::ring_scan(sensor(), kHeight, [](double, double) { return 0.0; });
  Points points;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (double{all.y[i]} > -only_left_of) points.push_back(all.x[i], all.y[i], all.z[i]);
  }
  return points;
}

// A cell of 0.2 m is told by its centre, and by any point in it: within a diagonal of the rim both
// are right.
TEST(UnseenCells, TheBlindSpotIsOutOfView) {
  const Cells cells(level_ground());
  for (double angle = 0.05; angle < 6.2; angle += 0.31) {
    for (double r = 0.3; r < 8.0; r += 0.2) {
      if (std::abs(r - kBlind) < 0.3) continue;
      const UnseenReason reason = cells.at(r * std::cos(angle), r * std::sin(angle));
      if (r < kBlind) {
        EXPECT_EQ(reason, UnseenReason::kOutOfView) << r << " " << angle;
      } else {
        EXPECT_TRUE(reason == UnseenReason::kSeen || reason == UnseenReason::kNoReturn)
            << r << " " << angle;
      }
    }
  }
}

// Only the half with y > 0 is scanned; ten degrees from its edge, the view counts as its own.
TEST(UnseenCells, BesideTheFieldOfViewIsOutOfView) {
  const Cells cells(level_ground(0.0));
  for (double angle = 0.25; angle < M_PI - 0.25; angle += 0.3) {
    EXPECT_EQ(cells.at(6.0 * std::cos(angle), -6.0 * std::sin(angle)), UnseenReason::kOutOfView);
    EXPECT_NE(cells.at(6.0 * std::cos(angle), 6.0 * std::sin(angle)), UnseenReason::kOutOfView);
  }
}

// A box from x = 4 to 5 and |y| < 1, 0.5 m high: seen from 1 m, its front edge at 4 m hides the
// ground up to where the beam over its farther top edge comes down, 5 / (1 - 0.5) = 10 m.
TEST(UnseenCells, ABoxHasAShadow) {
  const auto height = [](double x, double y) {
    return x > 4.0 && x < 5.0 && std::abs(y) < 1.0 ? 0.4 : 0.0;
  };
  const Cells cells(worlds::ring_scan(sensor(), kHeight, height));
  for (double x = 5.3; x < 8.0; x += 0.2) EXPECT_EQ(cells.at(x, 0.1), UnseenReason::kOccluded) << x;
  for (double x = 8.8; x < 14.0; x += 0.2)
    EXPECT_NE(cells.at(x, 0.1), UnseenReason::kOccluded) << x;
  // Beside the shadow, whose edge goes through (4, 1).
  for (double x = 5.3; x < 8.0; x += 0.2)
    EXPECT_NE(cells.at(x, 0.25 * x + 0.5), UnseenReason::kOccluded) << x;
}

TEST(UnseenCells, WithoutOriginsNothingIsKnown) {
  const Cells cells(level_ground(), false);
  for (const UnseenReason reason : cells.reasons)
    EXPECT_TRUE(reason == UnseenReason::kSeen || reason == UnseenReason::kNoReturn);
}

TEST(UnseenCells, NoPoints) {
  const Cells cells(Points{});
  for (const UnseenReason reason : cells.reasons) EXPECT_EQ(reason, UnseenReason::kNoReturn);
}

}  // namespace
}  // namespace mrpt_terrain
