// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/io/pcd.h"

#include <cmath>
#include <cstring>

#include "mrpt_terrain/io/observation_reader.h"
#include "stored_objects.h"

namespace mrpt_terrain::io {
namespace {

using namespace mrpt_terrain::test;

template <class T>
std::string raw(T value) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}

std::string header(const std::string& fields, const std::string& points, const std::string& data) {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n" + fields + "WIDTH " + points +
         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA " + data + "\n";
}

const std::string kXyz = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";

std::string error_of(const std::string& content) {
  const std::string file = write_file(fresh_folder() / "a.pcd", content);
  const std::string message = message_of<ReadError>([&] { (void)read_pcd(file); });
  EXPECT_EQ(message.substr(0, file.size()), file);
  return message.substr(std::min(file.size(), message.size()));
}

TEST(Pcd, ReadsAsciiWithNanAndOtherFields) {
  const std::string file =
      write_file(fresh_folder() / "a.pcd",
                 header("FIELDS normal x y z intensity label\nSIZE 4 4 4 8 1 4\nTYPE F F F F U U\n"
                        "COUNT 2 1 1 1 1 1\n",
                        "3", "ascii") +
                     "9 9 1.5 -2 3e1 7 40\n9 9 nan nan nan 0 0\r\n\n9 9 0 0 0 255 4294967295\n");
  const FileCloud cloud = read_pcd(file);
  ASSERT_EQ(cloud.points.size(), 3u);
  EXPECT_EQ(cloud.points.x[0], 1.5f);
  EXPECT_EQ(cloud.points.y[0], -2.0f);
  EXPECT_EQ(cloud.points.z[0], 30.0f);
  EXPECT_TRUE(std::isnan(cloud.points.y[1]));
  EXPECT_EQ(cloud.intensity, (std::vector<float>{7, 0, 255}));
  EXPECT_EQ(cloud.labels, (std::vector<std::uint32_t>{40, 0, 4294967295u}));
}

TEST(Pcd, ReadsBinaryOfAllTypes) {
  const std::string content =
      header("FIELDS x y z a intensity\nSIZE 8 4 2 1 2\nTYPE F F I U U\nCOUNT 1 1 1 3 1\n", "2",
             "binary") +
      raw(1.25) + raw(2.5f) + raw(std::int16_t{-3}) + "abc" + raw(std::uint16_t{500}) + raw(-1.25) +
      raw(NAN) + raw(std::int16_t{4}) + "\n\n\n" + raw(std::uint16_t{65535});
  const FileCloud cloud = read_pcd(write_file(fresh_folder() / "a.pcd", content));
  ASSERT_EQ(cloud.points.size(), 2u);
  EXPECT_EQ(cloud.points.x, (std::vector<float>{1.25f, -1.25f}));
  EXPECT_EQ(cloud.points.y[0], 2.5f);
  EXPECT_TRUE(std::isnan(cloud.points.y[1]));
  EXPECT_EQ(cloud.points.z, (std::vector<float>{-3, 4}));
  EXPECT_EQ(cloud.intensity, (std::vector<float>{500, 65535}));
  EXPECT_TRUE(cloud.labels.empty());
}

TEST(Pcd, ReadsCompressedFieldByField) {
  // x = 1, 1, 1; y = 2, 3, 4; z = 0, 0, 0: four literal bytes of x, a copy of eight from four back,
  // the literal bytes of y, one zero and a copy of eleven from one back.
  std::string packed;
  packed += char{3} + raw(1.0f);
  packed += std::string("\xC0\x03", 2);
  packed += char{11} + raw(2.0f) + raw(3.0f) + raw(4.0f);
  packed += std::string("\x00\x00\xE0\x02\x00", 5);
  const std::string content = header(kXyz, "3", "binary_compressed") +
                              raw(static_cast<std::uint32_t>(packed.size())) +
                              raw(std::uint32_t{36}) + packed;
  const auto path = fresh_folder() / "a.pcd";
  const FileCloud cloud = read_pcd(write_file(path, content));
  EXPECT_EQ(cloud.points.x, (std::vector<float>{1, 1, 1}));
  EXPECT_EQ(cloud.points.y, (std::vector<float>{2, 3, 4}));
  EXPECT_EQ(cloud.points.z, (std::vector<float>{0, 0, 0}));
  for (std::size_t n = 0; n < content.size(); ++n) {
    write_file(path, content.substr(0, n));
    EXPECT_THROW((void)read_pcd(path.string()), ReadError) << "cut at " << n;
  }
}

TEST(Pcd, DamagedLzfGivesNothing) {
  const std::uint8_t before_start[] = {0x20, 0x00};
  EXPECT_TRUE(decompress_lzf(before_start, 2, 3).empty());
  const std::uint8_t too_long[] = {0x01, 0x61, 0x62};
  EXPECT_TRUE(decompress_lzf(too_long, 3, 1).empty());
  const std::uint8_t cut[] = {0x05, 0x61};
  EXPECT_TRUE(decompress_lzf(cut, 2, 6).empty());
  EXPECT_TRUE(decompress_lzf(cut, 2, std::size_t{1} << 31).empty());
}

TEST(Pcd, ErrorsNameLineOrByte) {
  EXPECT_EQ(error_of("hello\n"), ":1: 'hello' is no header line of a PCD file");
  EXPECT_EQ(error_of("VERSION 0.7\n"),
            ":1: the header ends without a DATA line; is this a PCD file?");
  EXPECT_EQ(error_of(header("FIELDS x y\nSIZE 4 4\nTYPE F F\nCOUNT 1 1\n", "1", "ascii")),
            ":11: there is no field z");
  EXPECT_EQ(error_of(header("FIELDS x y z\nSIZE 4 4 3\nTYPE F F F\n", "1", "ascii")),
            ":10: the field z has the size 3");
  EXPECT_EQ(error_of(header(kXyz, "1", "zip")), ":11: DATA 'zip' is no known encoding");
  EXPECT_EQ(error_of(header(kXyz, "2", "ascii") + "1 2 3\n1 x 3\n"), ":13: 'x' is no number");
  EXPECT_EQ(error_of(header(kXyz, "2", "ascii") + "1 2 3\n1 2\n"), ":13: too few numbers");
  EXPECT_EQ(error_of(header(kXyz, "2", "ascii") + "1 2 3\n"),
            ":13: the file ends after 1 of 2 points");
  const std::string binary = header(kXyz, "2", "binary") + std::string(23, '\0');
  EXPECT_EQ(error_of(binary),
            ": byte " + std::to_string(binary.size()) + ": the file ends after 1 of 2 points");
}

}  // namespace
}  // namespace mrpt_terrain::io
