// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/io/byte_stream.h"

#include <algorithm>

#include "mrpt_terrain/io/observation_reader.h"
#include "stored_objects.h"

namespace mrpt_terrain::io {
namespace {

using namespace mrpt_terrain::test;

std::string read_all(ByteStream& stream, std::size_t chunk = 1000) {
  std::string all, block(chunk, '\0');
  while (const std::size_t n = stream.read(block.data(), chunk)) all.append(block, 0, n);
  return all;
}

std::string patterned(std::size_t n) {
  std::string bytes(n, '\0');
  std::uint32_t state = 1;
  for (char& c : bytes) c = static_cast<char>((state = state * 1664525u + 1013904223u) >> 24);
  return bytes;
}

TEST(ByteStream, GivesPlainAndCompressedBytesUnchanged) {
  const auto folder = fresh_folder();
  const std::string bytes = patterned(300001);
  for (const std::string& content : {bytes, gzip(bytes)}) {
    ByteStream stream(write_file(folder / "f", content));
    EXPECT_EQ(read_all(stream, 7777), bytes);
    EXPECT_EQ(stream.failure(), "");
    EXPECT_EQ(stream.position(), bytes.size());
    EXPECT_DOUBLE_EQ(stream.progress(), 1.0);
  }
}

TEST(ByteStream, JoinsGzipMembers) {
  ByteStream stream(write_file(fresh_folder() / "f", gzip("abc") + gzip("defg")));
  EXPECT_EQ(read_all(stream), "abcdefg");
  EXPECT_EQ(stream.failure(), "");
}

TEST(ByteStream, PeeksAcrossItsBlocks) {
  const std::string bytes = patterned(200000);
  ByteStream stream(write_file(fresh_folder() / "f", gzip(bytes)));
  const std::uint8_t* data = nullptr;
  std::size_t position = 0;
  while (position < bytes.size()) {
    const std::size_t seen = stream.peek(100, data);
    ASSERT_GE(seen, std::min<std::size_t>(100, bytes.size() - position));
    ASSERT_EQ(std::string(reinterpret_cast<const char*>(data), 1), bytes.substr(position, 1));
    const std::size_t step = std::min<std::size_t>(seen, 997);
    stream.skip(step);
    position += step;
    ASSERT_EQ(stream.position(), position);
  }
}

TEST(ByteStream, EveryCutOfAGzipFileIsNoticed) {
  const auto folder = fresh_folder();
  const std::string whole = gzip(patterned(500));
  for (std::size_t n = 2; n < whole.size(); ++n) {
    ByteStream stream(write_file(folder / "f", whole.substr(0, n)));
    read_all(stream);
    EXPECT_EQ(stream.failure(), "the gzip data is cut off") << "cut at " << n;
  }
}

TEST(ByteStream, EveryFlippedBitBehindTheGzipHeaderIsNoticed) {
  const auto folder = fresh_folder();
  const std::string whole = gzip(patterned(300));
  for (std::size_t n = 10; n < whole.size(); ++n) {
    std::string damaged = whole;
    damaged[n] = static_cast<char>(damaged[n] ^ (1 << (n % 8)));
    ByteStream stream(write_file(folder / "f", damaged));
    read_all(stream);
    EXPECT_NE(stream.failure(), "") << "byte " << n;
  }
}

TEST(ByteStream, RubbishBehindTheGzipDataIsNoticed) {
  ByteStream stream(write_file(fresh_folder() / "f", gzip("abc") + "rubbish"));
  EXPECT_EQ(read_all(stream), "abc");
  EXPECT_TRUE(contains(stream.failure(), "damaged")) << stream.failure();
}

TEST(ByteStream, RefusesWhatCannotBeRead) {
  const auto folder = fresh_folder();
  const auto open = [](const std::string& file) {
    return message_of<ReadError>([&] { ByteStream stream(file); });
  };
  EXPECT_EQ(open((folder / "none").string()), (folder / "none").string() + ": no such file");
  EXPECT_EQ(open(folder.string()), folder.string() + ": is a folder, not a file");
  const std::string empty = write_file(folder / "empty", "");
  EXPECT_EQ(open(empty), empty + ": is empty");
}

}  // namespace
}  // namespace mrpt_terrain::io
