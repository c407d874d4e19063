// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/io/ply.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "mrpt_terrain/io/observation_reader.h"
#include "stored_objects.h"

namespace mrpt_terrain::io {
namespace {

using namespace mrpt_terrain::test;

template <class T>
std::string raw(T value, bool big_endian = false) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  if (big_endian) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

std::string error_of(const std::string& content) {
  const std::string file = write_file(fresh_folder() / "a.ply", content);
  const std::string message = message_of<ReadError>([&] { (void)read_ply(file); });
  EXPECT_EQ(message.substr(0, file.size()), file);
  return message.substr(std::min(file.size(), message.size()));
}

const std::string kVertex =
    "element vertex 2\nproperty double x\nproperty float y\nproperty short z\n"
    "property list uchar int extra\nproperty uchar intensity\nproperty uint label\n";
const std::string kCamera = "element camera 1\nproperty int view\nproperty list ushort float a\n";
const std::string kFace = "element face 1\nproperty list uchar int vertex_indices\n";

void expect_the_two_points(const FileCloud& cloud) {
  ASSERT_EQ(cloud.points.size(), 2u);
  EXPECT_EQ(cloud.points.x, (std::vector<float>{1.5f, -1.5f}));
  EXPECT_EQ(cloud.points.y[0], 2.25f);
  EXPECT_TRUE(std::isnan(cloud.points.y[1]));
  EXPECT_EQ(cloud.points.z, (std::vector<float>{-3, 700}));
  EXPECT_EQ(cloud.intensity, (std::vector<float>{200, 0}));
  EXPECT_EQ(cloud.labels, (std::vector<std::uint32_t>{40, 4000000000u}));
}

TEST(Ply, ReadsAscii) {
  const std::string content = "ply\r\nformat ascii 1.0\ncomment made by hand\n" + kCamera +
                              kVertex + kFace +
                              "end_header\n5 2 0.5 0.5\n1.5 2.25 -3 2 8 9 200 40\n"
                              "-1.5 nan 700 0 0 4000000000\n3 0 1 1\n";
  expect_the_two_points(read_ply(write_file(fresh_folder() / "a.ply", content)));
}

TEST(Ply, ReadsBinaryOfBothByteOrders) {
  const auto path = fresh_folder() / "a.ply";
  for (const bool big : {false, true}) {
    std::string content = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                          "_endian 1.0\n" + kCamera + kVertex + kFace + "end_header\n";
    const std::size_t header_size = content.size();
    content += raw(5, big) + raw(std::uint16_t{2}, big) + raw(0.5f, big) + raw(0.5f, big);
    content += raw(1.5, big) + raw(2.25f, big) + raw(std::int16_t{-3}, big) + char{2} +
               raw(8, big) + raw(9, big) + char(200) + raw(std::uint32_t{40}, big);
    content += raw(-1.5, big) + raw(NAN, big) + raw(std::int16_t{700}, big) + char{0} + char{0} +
               raw(std::uint32_t{4000000000u}, big);
    expect_the_two_points(read_ply(write_file(path, content)));
    for (std::size_t n = 0; n < content.size(); ++n) {
      write_file(path, content.substr(0, n));
      const std::string message = message_of<ReadError>([&] { (void)read_ply(path.string()); });
      if (n >= header_size) {
        EXPECT_TRUE(contains(message, "byte " + std::to_string(n))) << message;
      }
    }
  }
}

TEST(Ply, ErrorsNameTheLine) {
  EXPECT_EQ(error_of("plx\n"), ":1: is no PLY file: the first line is not 'ply'");
  EXPECT_EQ(error_of("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"),
            ":4: the header ends without 'end_header'");
  EXPECT_EQ(error_of("ply\nformat text 1.0\n"), ":2: 'text' is no known format");
  EXPECT_EQ(error_of("ply\nformat ascii 1.0\nelement vertex -1\n"),
            ":3: the element vertex has no valid count");
  EXPECT_EQ(error_of("ply\nformat ascii 1.0\nelement vertex 1\nproperty real x\n"),
            ":4: 'real' is no type of a PLY file");
  EXPECT_EQ(error_of("ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nend_header\n1\n"),
            ":5: the vertices have no property y");
  EXPECT_EQ(error_of("ply\nformat ascii 1.0\n" + kFace + "end_header\n"),
            ":5: there is no element 'vertex'");
  const std::string ascii = "ply\nformat ascii 1.0\n" + kVertex + "end_header\n";
  EXPECT_EQ(error_of(ascii + "1 2 3 0 5 0\n1 2 3 0 z 0\n"), ":12: 'z' is no number");
  EXPECT_EQ(error_of(ascii + "1 2 3 4 5 0\n"), ":11: too few numbers");
  EXPECT_EQ(error_of(ascii + "1 2 3 0 5 0\n"), ":11: the file ends within the elements 'vertex'");
}

TEST(Ply, LabelledPlyIsLiteral) {
  const auto path = fresh_folder() / "out.ply";
  const float x[] = {1, 2}, y[] = {3, 4}, z[] = {5, NAN};
  PointLabels labels;
  labels.support = {Support::kAbove, Support::kUnknown};
  labels.reason = {UnknownReason::kNone, UnknownReason::kNotFinite};
  labels.terrain_class = {TerrainClass::kObstacle, TerrainClass::kNone};
  labels.cluster = {7, kNoCluster};
  write_labelled_ply(path.string(), {x, y, z, 2}, labels, [](Support, TerrainClass terrain_class) {
    return terrain_class == TerrainClass::kObstacle ? PointColor{10, 20, 30} : PointColor{1, 2, 3};
  });
  const std::string bytes = read_file(path);
  const std::string expected = raw(1.0f) + raw(3.0f) + raw(5.0f) + "\x02\x03" + raw(7) +
                               "\x0A\x14\x1E" + raw(2.0f) + raw(4.0f) + raw(NAN) +
                               std::string("\x00\x00", 2) + raw(-1) + "\x01\x02\x03";
  ASSERT_GT(bytes.size(), expected.size());
  EXPECT_EQ(bytes.substr(bytes.size() - expected.size()), expected);
  const FileCloud cloud = read_ply(path.string());
  EXPECT_EQ(cloud.points.x, (std::vector<float>{1, 2}));
  EXPECT_EQ(cloud.points.z[0], 5.0f);
}

}  // namespace
}  // namespace mrpt_terrain::io
