// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/site_plan.h"

#include <gtest/gtest.h>
#include <mrpt/img/CImage.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>

#include "mrpt_terrain/view/palette.h"
#include "test_files.h"

namespace mrpt_terrain::view {
namespace {

constexpr int kPanelLeft = 70, kPanelTop = 96;  // pixels

/// 20 m x 10 m, level at 1 m in the west and 2 m in the east, an obstacle in the north-west, a
/// strip without ground in the south.
SitePlan example_plan() {
  SitePlan plan;
  plan.title = "example";
  plan.extent = {0.0, 20.0, 0.0, 10.0};
  const PanelSize size = plan_panel_size(plan.extent, 400, 400);
  plan.heights = Raster<float>(size.width, size.height);
  plan.thing = Raster<std::int32_t>(size.width, size.height);
  for (int row = 0; row < size.height; ++row) {
    for (int column = 0; column < size.width; ++column) {
      const bool none = row >= size.height - 20;
      plan.heights.at(column, row) =
          none ? std::numeric_limits<float>::quiet_NaN() : (column < size.width / 2 ? 1.0F : 2.0F);
      plan.thing.at(column, row) = row < 80 && column < 100 ? 0 : -1;
    }
  }
  plan.things.push_back({7, "box", TerrainClass::kObstacle, 0.5, {2.5, 8.0}});
  plan.path = {{12.0, 3.0}, {18.0, 3.0}};
  return plan;
}

struct Picture {
  explicit Picture(const SitePlan& plan) {
    const std::string file = test::empty_test_folder() + "plan.png";
    write_site_plan(file, plan);
    if (!image.loadFromFile(file)) throw std::runtime_error("not a picture");
  }
  [[nodiscard]] Rgb at(int column, int row) const {
    const auto* bgr = image.ptr<std::uint8_t>(static_cast<unsigned>(kPanelLeft + column),
                                              static_cast<unsigned>(kPanelTop + row));
    return {bgr[2], bgr[1], bgr[0]};
  }
  mrpt::img::CImage image;
};

int distance(Rgb a, Rgb b) {
  return std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b);
}

TEST(SitePlan, PanelKeepsTheShapeOfTheSite) {
  const PanelSize wide = plan_panel_size({0.0, 20.0, -5.0, 5.0}, 400, 400);
  EXPECT_EQ(wide.width, 400);
  EXPECT_EQ(wide.height, 200);
  const PanelSize tall = plan_panel_size({0.0, 5.0, 0.0, 20.0}, 400, 400);
  EXPECT_EQ(tall.width, 100);
  EXPECT_EQ(tall.height, 400);
}

TEST(SitePlan, LowGroundIsDarkHighGroundIsBrightAndNothingIsWhite) {
  const Picture picture(example_plan());
  const Rgb low = picture.at(150, 150), high = picture.at(350, 30);
  EXPECT_LT(low.r + low.g, high.r + high.g);
  EXPECT_EQ(picture.at(150, 195), kUnobservedColour);
}

TEST(SitePlan, ThingsHaveTheColourOfTheirClassAndNorthIsUp) {
  SitePlan plan = example_plan();
  const Picture obstacle(plan);
  EXPECT_LT(distance(obstacle.at(25, 65), kObstacleColour),
            distance(obstacle.at(25, 65), kPotholeColour));
  plan.things[0].terrain_class = TerrainClass::kPothole;
  const Picture pothole(plan);
  EXPECT_LT(distance(pothole.at(25, 65), kPotholeColour),
            distance(pothole.at(25, 65), kObstacleColour));
  EXPECT_EQ(obstacle.at(150, 150), pothole.at(150, 150));
}

TEST(SitePlan, PathIsDrawnWhereItIs) {
  const SitePlan plan = example_plan();
  SitePlan bare = plan;
  bare.path.clear();
  const Picture with(plan), without(bare);
  EXPECT_GT(distance(with.at(300, 140), without.at(300, 140)), 100);  // (15, 3)
  EXPECT_EQ(with.at(300, 160), without.at(300, 160));
}

TEST(SitePlan, ManyThingsAndNoneFit) {
  SitePlan plan = example_plan();
  for (int k = 0; k < 200; ++k) {
    plan.things.push_back({k + 8, "pole", TerrainClass::kObstacle, 1.0, {0.1 * k, 5.0}});
  }
  EXPECT_NO_THROW(Picture{plan});
  plan.things.clear();
  plan.thing.values.assign(plan.thing.values.size(), -1);
  plan.heights.values.assign(plan.heights.values.size(), std::nanf(""));
  EXPECT_NO_THROW(Picture{plan});
}

TEST(SitePlan, UnwritableFileIsNamed) {
  try {
    write_site_plan("/nowhere/plan.png", example_plan());
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/nowhere/plan.png: cannot be written"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace mrpt_terrain::view
