// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/io/label_file.h"

#include "mrpt_terrain/io/observation_reader.h"
#include "stored_objects.h"

namespace mrpt_terrain::io {
namespace {

using namespace mrpt_terrain::test;

TEST(LabelFile, ReadsLittleEndianWords) {
  const std::string file =
      write_file(fresh_folder() / "a.label", std::string("\x28\x00\x00\x00\x0A\x01\x02\x80", 8));
  const auto labels = read_labels(file);
  ASSERT_EQ(labels.size(), 2u);
  EXPECT_EQ(labels[0], 40u);
  EXPECT_EQ(label_class(labels[1]), 0x010A);
  EXPECT_EQ(label_instance(labels[1]), 0x8002);
  EXPECT_EQ(make_label(0x010A, 0x8002), labels[1]);
}

TEST(LabelFile, WritesWhatItReads) {
  const auto path = fresh_folder() / "a.label";
  const std::vector<std::uint32_t> labels{1, 0xFFFFFFFFu, make_label(7, 9)};
  write_labels(path.string(), labels);
  EXPECT_EQ(std::filesystem::file_size(path), 12u);
  EXPECT_EQ(read_labels(path.string(), 3), labels);
}

TEST(LabelFile, RefusesAWrongSize) {
  const auto folder = fresh_folder();
  const std::string cut = write_file(folder / "cut.label", std::string(7, '\0'));
  EXPECT_EQ(message_of<ReadError>([&] { (void)read_labels(cut); }),
            cut + ": byte 4: cut off: 7 bytes are no whole number of labels of 4 bytes");
  const std::string other = write_file(folder / "other.label", std::string(8, '\0'));
  EXPECT_EQ(message_of<ReadError>([&] { (void)read_labels(other, 3); }),
            other + ": holds 2 labels for a scan of 3 points");
}

}  // namespace
}  // namespace mrpt_terrain::io
