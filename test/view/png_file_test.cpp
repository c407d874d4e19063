// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/png_file.h"

#include <gtest/gtest.h>
#include <mrpt/img/CImage.h>

#include <fstream>

#include "test_files.h"

namespace mrpt_terrain::view {
namespace {

TEST(PngFile, AnotherReaderGetsEveryPixelBack) {
  Raster<std::uint32_t> pixels(7, 5);
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 7; ++column) {
      pixels.at(column, row) =
          static_cast<std::uint32_t>((30 * column << 16) | (50 * row << 8) | (column * row + 200));
    }
  }
  const std::string file = test::empty_test_folder() + "picture.png";
  std::ofstream(file, std::ios::binary) << png_bytes(pixels);
  mrpt::img::CImage image;
  ASSERT_TRUE(image.loadFromFile(file));
  ASSERT_EQ(image.getWidth(), 7U);
  ASSERT_EQ(image.getHeight(), 5U);
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 7; ++column) {
      const std::uint8_t* bgr =
          image.ptr<std::uint8_t>(static_cast<unsigned>(column), static_cast<unsigned>(row));
      EXPECT_EQ(bgr[2], 30 * column);
      EXPECT_EQ(bgr[1], 50 * row);
      EXPECT_EQ(bgr[0], column * row + 200);
    }
  }
}

}  // namespace
}  // namespace mrpt_terrain::view
