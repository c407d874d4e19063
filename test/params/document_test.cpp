// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/params/document.h"

#include <gtest/gtest.h>

#include <string>

#include "example_params.h"
#include "mrpt_terrain/params/parameter_error.h"
#include "support_params.h"

namespace mrpt_terrain::params {
namespace {

using test_params::Drawing;

std::string refusal_of(const Document& document) {
  Drawing drawing;
  return message_of<ParameterError>([&] { assign_all(document, sections_of(drawing)); });
}

TEST(DocumentTest, AssignsWhatIsGivenAndKeepsTheRest) {
  Drawing drawing;
  assign_all({"x.ini", {{"shape", {{"count", "7"}}}, {"paper", {{"weight", "90"}}}}},
             sections_of(drawing));
  EXPECT_EQ(drawing.shape.count, 7);
  EXPECT_EQ(drawing.paper.weight, 90.0);
  EXPECT_EQ(drawing.shape.size, 0.5);
}

TEST(DocumentTest, IgnoresCaseOfSectionsAndKeys) {
  Drawing drawing;
  assign_all({"x.ini", {{"Shape", {{"COUNT", "7"}}}}}, sections_of(drawing));
  EXPECT_EQ(drawing.shape.count, 7);
}

TEST(DocumentTest, UnknownKeySuggestsTheNearest) {
  EXPECT_EQ(refusal_of({"x.ini", {{"shape", {{"cuont", "7"}}}}}),
            "x.ini: [shape] cuont = 7: unknown key; did you mean `count`?");
  EXPECT_EQ(refusal_of({"x.ini", {{"shape", {{"angle", "7"}}}}}),
            "x.ini: [shape] angle = 7: unknown key; did you mean `angle_deg`?");
}

TEST(DocumentTest, UnknownKeyOfAnotherSectionSaysWhich) {
  EXPECT_EQ(refusal_of({"x.ini", {{"paper", {{"size", "7"}}}}}),
            "x.ini: [paper] size = 7: unknown key; did you mean `size` of [shape]?");
}

TEST(DocumentTest, UnknownKeyWithoutNeighbourListsAll) {
  EXPECT_EQ(refusal_of({"x.ini", {{"shape", {{"voltage", "7"}}}}}),
            "x.ini: [shape] voltage = 7: unknown key; there are size, angle_deg, count, seed, "
            "filled, colour");
}

TEST(DocumentTest, UnknownSectionSuggestsTheNearestOrListsAll) {
  EXPECT_EQ(refusal_of({"x.ini", {{"shapes", {}}}}),
            "x.ini: [shapes]: unknown section; did you mean [shape]?");
  EXPECT_EQ(refusal_of({"x.ini", {{"camera", {}}}}),
            "x.ini: [camera]: unknown section; there are [shape], [paper]");
}

TEST(DocumentTest, KeysOutsideOfSectionsAreRefused) {
  EXPECT_EQ(refusal_of({"x.ini", {{"", {{"size", "1"}}}}}),
            "x.ini: size = 1: stands outside of any [section]");
}

TEST(DocumentTest, KeysGivenTwiceAreRefusedAlsoAcrossSectionsOfOneName) {
  EXPECT_EQ(refusal_of({"x.ini", {{"shape", {{"size", "1"}}}, {"SHAPE", {{"Size", "2"}}}}}),
            "x.ini: [shape] Size = 2: is given twice");
}

TEST(DocumentTest, AllProblemsAreToldAtOnceInTheOrderOfTheFile) {
  EXPECT_EQ(refusal_of({"x.ini", {{"shape", {{"size", "11"}, {"cont", "1"}}}, {"grid", {}}}}),
            "x.ini: [shape] size = 11: must be within [0.25, 10] m (edge of the shape)\n"
            "x.ini: [shape] cont = 1: unknown key; did you mean `count`?\n"
            "x.ini: [grid]: unknown section; there are [shape], [paper]");
}

TEST(DocumentTest, FilesThatCannotBeReadAreNamed) {
  const std::string folder = fresh_folder().string();
  EXPECT_EQ(message_of<ParameterError>([&] { (void)read_text_file(folder + "/none.ini"); }),
            folder + "/none.ini: cannot be read: No such file or directory");
  EXPECT_EQ(message_of<ParameterError>([&] { (void)read_text_file(folder); }),
            folder + ": cannot be read: is a folder");
}

TEST(DocumentTest, ReadsTheBytesOfAFile) {
  EXPECT_EQ(read_text_file(write_file("a.txt", "a\r\nb")), "a\r\nb");
}

}  // namespace
}  // namespace mrpt_terrain::params
