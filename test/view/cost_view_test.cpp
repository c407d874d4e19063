// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/cost_view.h"

#include <gtest/gtest.h>
#include <mrpt/img/CImage.h>

#include <stdexcept>
#include <string>

#include "description_builder.h"
#include "mrpt_terrain/view/top_view_layout.h"
#include "test_files.h"

namespace mrpt_terrain::view {
namespace {

/// 10 m x 10 m of ground whose cells ahead are lethal, whose cells behind on the left cost a half,
/// and of whose cells behind on the right no cost is known. The costs are made by hand.
struct World {
  Description description;
  CellCosts costs;
  RobotParams robot;

  World() {
    test::DescriptionBuilder builder(10.0, 10.0, 0.1);
    for (int l = 10; l < 90; ++l) {
      for (int w = 10; w < 90; ++w) builder.ground({l, w}, 0.0F);
    }
    description = builder.build();
    const GridGeometry& geometry = description.grid.geometry;
    for (const CellId id : description.grid.cell) {
      const Position2 place = geometry.centre_of(geometry.index_of(id));
      const bool known = place.x > 0.0 || place.y > 0.0;
      costs.gradient_x.push_back(0.0F);
      costs.gradient_y.push_back(0.0F);
      costs.roughness.push_back(0.0F);
      costs.step.push_back(place.x > 0.0 ? 1.0F : static_cast<float>(0.5 * robot.max_step));
      costs.status.push_back(known ? FeatureStatus::kOk : FeatureStatus::kTooFewPoints);
    }
  }
};

Rgb pixel_at(const mrpt::img::CImage& image, const MapPanel& panel, Position2 place) {
  const PixelPosition at = panel.pixel_of(place);
  const std::uint8_t* bgr =
      image.ptr<std::uint8_t>(static_cast<unsigned>(at.x), static_cast<unsigned>(at.y));
  return {bgr[2], bgr[1], bgr[0]};
}

mrpt::img::CImage picture_of(const World& world, const TopViewOptions& options) {
  const std::string file = test::empty_test_folder() + "cost.png";
  write_cost_view(file, world.description, world.costs, world.robot, options);
  mrpt::img::CImage image;
  EXPECT_TRUE(image.loadFromFile(file));
  return image;
}

TEST(CostView, CellsHaveTheColoursOfTheirCosts) {
  const World world;
  const TopViewOptions options;
  const mrpt::img::CImage image = picture_of(world, options);
  const TopViewLayout layout =
      top_view_layout(world.description.grid.geometry, options.max_width, options.max_height);
  // Off the lines of the grid, which lie on whole metres.
  EXPECT_EQ(pixel_at(image, layout.classes, {2.5, 2.5}), kLethalColour);
  EXPECT_EQ(pixel_at(image, layout.classes, {-2.5, 2.5}), cost_colour(0.5));
  EXPECT_EQ(pixel_at(image, layout.classes, {-2.5, -2.5}), kUnknownColour);
  EXPECT_EQ(pixel_at(image, layout.classes, {4.5, 4.5}), kUnobservedColour);
}

TEST(CostView, CostsRiseFromGreenToOrange) {
  EXPECT_EQ(colour_of(Cost{CostStatus::kOk, 0.0, {}}), cost_colour(0.0));
  EXPECT_EQ(colour_of(Cost{CostStatus::kLethal, 1.0, {}}), kLethalColour);
  EXPECT_EQ(colour_of(Cost{CostStatus::kOutside, 0.0, {}}), kUnknownColour);
  EXPECT_GT(cost_colour(1.0).r, cost_colour(0.0).r);
  EXPECT_LT(cost_colour(1.0).g, cost_colour(0.0).g);
  EXPECT_EQ(cost_colour(7.0), cost_colour(1.0));
}

TEST(CostView, WhatCannotBeWrittenIsSaid) {
  const World world;
  EXPECT_THROW(
      write_cost_view("/no such folder/cost.png", world.description, world.costs, world.robot, {}),
      std::runtime_error);
}

TEST(CostView, CellsThatWereNotObservedHaveTheColourOfTheReason) {
  World world;
  const GridGeometry& geometry = world.description.grid.geometry;
  world.costs.unseen.assign(static_cast<std::size_t>(geometry.array_size()),
                            UnseenReason::kOccluded);
  const TopViewOptions options;
  const mrpt::img::CImage image = picture_of(world, options);
  const TopViewLayout layout = top_view_layout(geometry, options.max_width, options.max_height);
  EXPECT_EQ(pixel_at(image, layout.classes, {4.5, 4.5}), kOccludedColour);
  EXPECT_EQ(pixel_at(image, layout.classes, {2.5, 2.5}), kLethalColour);
}

TEST(CostView, CellsWithoutGroundAreLethalThoughNothingWasSeenOfThem) {
  World world;
  const GridGeometry& geometry = world.description.grid.geometry;
  CellIndex edge;
  ASSERT_TRUE(geometry.cell_at(4.55, 4.55, edge));
  world.costs.missing = {value_of(geometry.id_of(edge))};
  const TopViewOptions options;
  const mrpt::img::CImage image = picture_of(world, options);
  const TopViewLayout layout = top_view_layout(geometry, options.max_width, options.max_height);
  EXPECT_EQ(pixel_at(image, layout.classes, {4.55, 4.55}), kLethalColour);
  EXPECT_EQ(pixel_at(image, layout.classes, {4.55, 4.25}), kUnobservedColour);
}

TEST(CostView, LayersHaveAMapPerKnownPart) {
  World world;
  const std::string folder = test::empty_test_folder();
  mrpt::img::CImage three, seven;
  write_cost_layers(folder + "grid.png", world.description, world.costs, world.robot, {});
  ASSERT_TRUE(three.loadFromFile(folder + "grid.png"));
  const std::size_t n = world.costs.size();
  world.costs.obstacle.assign(n, 1.0F);
  world.costs.likely.assign(n, 1.0F);
  world.costs.hole.assign(n, -1);
  world.costs.doubt.assign(n, 0.0F);
  world.costs.ground.assign(n, UnseenReason::kSeen);
  write_cost_layers(folder + "field.png", world.description, world.costs, world.robot, {});
  ASSERT_TRUE(seven.loadFromFile(folder + "field.png"));
  EXPECT_EQ(three.getWidth(), seven.getWidth());
  EXPECT_GT(seven.getHeight(), three.getHeight() + 300) << "a second row";
  EXPECT_THROW(write_cost_layers("/no such folder/cost.png", world.description, world.costs,
                                 world.robot, {}),
               std::runtime_error);
}

}  // namespace
}  // namespace mrpt_terrain::view
