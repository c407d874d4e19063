// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/top_view.h"

#include <gtest/gtest.h>
#include <mrpt/img/CImage.h>

#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "description_builder.h"
#include "mrpt_terrain/view/palette.h"
#include "mrpt_terrain/view/top_view_layout.h"
#include "test_files.h"

namespace mrpt_terrain::view {
namespace {

/// 10 m x 10 m in cells of 0.1 m, low ground behind and high ground ahead, an obstacle ahead on the
/// left, a pothole ahead on the right, a slope behind on the left, a small group behind on the
/// right. Everything is well clear of the robot's symbol and of grid lines.
class TopView : public testing::Test {
 protected:
  static Description world() {
    test::DescriptionBuilder builder(10.0, 10.0, 0.1);
    for (int l = 10; l < 90; ++l) {
      for (int w = 10; w < 90; ++w) builder.ground({l, w}, 0.01F * static_cast<float>(l));
    }
    builder.cluster(TerrainClass::kObstacle, {75, 65}, {88, 88}, 0.0F, 1.0F);
    builder.cluster(TerrainClass::kPothole, {75, 12}, {88, 35}, -0.4F, -0.2F);
    builder.cluster(TerrainClass::kSlope, {12, 65}, {25, 88}, 0.1F, 0.4F);
    for (int l = 12; l < 26; ++l) {
      for (int w = 12; w < 36; ++w) builder.dropped({l, w}, 0.3F);
    }
    return builder.build();
  }

  mrpt::img::CImage drawn(const Description& description, TopViewOptions options = {}) {
    const std::string file = test::empty_test_folder() + "view.png";
    write_top_view(file, description, options);
    mrpt::img::CImage image;
    if (!image.loadFromFile(file)) throw std::runtime_error("not a picture");
    return image;
  }

  static Rgb pixel(const mrpt::img::CImage& image, double x, double y) {
    const std::uint8_t* bgr =
        image.ptr<std::uint8_t>(static_cast<unsigned>(x), static_cast<unsigned>(y));
    return {bgr[2], bgr[1], bgr[0]};
  }

  /// Colour of a place of the map in a panel.
  static Rgb colour_at(const mrpt::img::CImage& image, const MapPanel& panel, Position2 place) {
    const PixelPosition at = panel.pixel_of(place);
    return pixel(image, at.x, at.y);
  }

  /// Ink, also where its edges are smoothed.
  static bool is_dark(Rgb colour) { return colour.r < 100 && colour.g < 100 && colour.b < 100; }

  /// Where the middle of all pixels of one colour lies; column and row.
  static PixelPosition middle_of(const mrpt::img::CImage& image, Rgb colour, int first_column,
                                 int last_row) {
    double n = 0.0;
    PixelPosition sum;
    for (int row = 0; row < last_row; ++row) {
      for (int column = first_column; column < static_cast<int>(image.getWidth()); ++column) {
        if (pixel(image, column, row) != colour) continue;
        n += 1.0;
        sum.x += column;
        sum.y += row;
      }
    }
    EXPECT_GT(n, 1000.0);
    return {sum.x / n, sum.y / n};
  }

  const TopViewLayout layout_ = top_view_layout({10.0, 10.0, 0.1}, 1600, 920);
};

TEST_F(TopView, CellsHaveTheColourOfTheirClassAtTheirPlace) {
  const auto image = drawn(world());
  ASSERT_EQ(static_cast<int>(image.getWidth()), layout_.width);
  ASSERT_EQ(static_cast<int>(image.getHeight()), layout_.height);
  const MapPanel& panel = layout_.classes;
  EXPECT_EQ(colour_at(image, panel, {2.75, 1.75}), kObstacleColour);
  EXPECT_EQ(colour_at(image, panel, {2.75, -3.65}), kPotholeColour);
  EXPECT_EQ(colour_at(image, panel, {-3.65, 1.75}), kSlopeColour);
  EXPECT_EQ(colour_at(image, panel, {-3.65, -1.75}), kDroppedColour);
  EXPECT_EQ(colour_at(image, panel, {1.55, -2.55}), kGroundColour);
  EXPECT_EQ(colour_at(image, panel, {4.55, -4.55}), kUnobservedColour);
}

// Without the layout's help: an axis that is flipped there would be flipped in both.
TEST_F(TopView, ForwardIsUpAndLeftIsLeftInThePicture) {
  const auto image = drawn(world());
  const int half = layout_.width / 2;
  const auto obstacle = middle_of(image, kObstacleColour, half, layout_.key_top);
  const auto pothole = middle_of(image, kPotholeColour, half, layout_.key_top);
  const auto slope = middle_of(image, kSlopeColour, half, layout_.key_top);
  EXPECT_LT(obstacle.y + 100.0, slope.y) << "the obstacle is ahead of the slope";
  EXPECT_LT(obstacle.x + 100.0, pothole.x) << "the obstacle is left of the pothole";
  EXPECT_NEAR(obstacle.y, pothole.y, 10.0);
  EXPECT_NEAR(obstacle.x, slope.x, 10.0);
}

TEST_F(TopView, HigherGroundIsLighter) {
  const auto image = drawn(world());
  const auto sum = [&](double x) {
    const Rgb colour = colour_at(image, layout_.heights, {x, 0.75});
    return colour.r + colour.g + colour.b;
  };
  EXPECT_LT(sum(-2.25) + 20, sum(-0.75));
  EXPECT_LT(sum(-0.75) + 20, sum(1.75));
  EXPECT_EQ(colour_at(image, layout_.heights, {4.55, -4.55}), kUnobservedColour);
}

TEST_F(TopView, EveryClusterHasItsNumberInItsFrame) {
  TopViewOptions none;
  none.max_labels = 0;
  const auto plain = drawn(world(), none);
  const auto numbered = drawn(world());
  // The label lies over a cluster as large as these.
  const PixelPosition middle = layout_.classes.pixel_of({3.2, 2.7});
  int changed = 0;
  for (int row = -10; row <= 10; ++row) {
    for (int column = -12; column <= 12; ++column) {
      changed += pixel(plain, middle.x + column, middle.y + row) !=
                 pixel(numbered, middle.x + column, middle.y + row);
    }
  }
  EXPECT_GT(changed, 100);
  EXPECT_EQ(colour_at(plain, layout_.classes, {3.25, 2.75}), kObstacleColour);
}

TEST_F(TopView, TheRobotIsAtTheOriginOfBothPanels) {
  const auto image = drawn(world());
  for (const MapPanel& panel : {layout_.heights, layout_.classes}) {
    const PixelPosition origin = panel.pixel_of({0.0, 0.0});
    EXPECT_TRUE(is_dark(pixel(image, origin.x, origin.y)));
    EXPECT_TRUE(is_dark(pixel(image, origin.x, origin.y - 30.0))) << "x points up";
    EXPECT_TRUE(is_dark(pixel(image, origin.x - 30.0, origin.y))) << "y points left";
    EXPECT_FALSE(is_dark(pixel(image, origin.x + 30.0, origin.y)));
    EXPECT_FALSE(is_dark(pixel(image, origin.x, origin.y + 30.0)));
  }
}

TEST_F(TopView, AnEmptyDescriptionIsAPictureToo) {
  test::DescriptionBuilder builder(200.0, 200.0, 0.2);
  const auto image = drawn(builder.build());
  EXPECT_GT(image.getWidth(), 1000U);
}

TEST_F(TopView, NamesThatAreNotUtf8DoNotSpoilThePicture) {
  TopViewOptions options;
  options.source = "/data/\xFF\xFE" + std::string(400, 'x') + ".rawlog";
  const auto image = drawn(world(), options);
  EXPECT_EQ(colour_at(image, layout_.classes, {2.75, 1.75}), kObstacleColour);
}

TEST_F(TopView, AnUnwritablePlaceIsNamedWithItsReason) {
  const std::string file = test::empty_test_folder() + "missing/view.png";
  try {
    write_top_view(file, world(), {});
    FAIL() << "no exception";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), file + ": cannot be written: No such file or directory");
  }
}

}  // namespace
}  // namespace mrpt_terrain::view
