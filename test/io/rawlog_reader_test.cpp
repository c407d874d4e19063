// SPDX-License-Identifier: BSD-3-Clause
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <sys/resource.h>

#include <algorithm>

#include "mrpt_terrain/io/observation_reader.h"
#include "stored_objects.h"

namespace mrpt_terrain::io {
namespace {

using namespace mrpt_terrain::test;

struct Outcome {
  std::size_t observations = 0;
  std::string error;
  ReadSummary summary;
};

Outcome read_file_to_its_end(const std::string& file) {
  Outcome outcome;
  try {
    const auto reader = open_observations(file);
    ReadObservation read;
    try {
      while (reader->next(read)) ++outcome.observations;
      EXPECT_FALSE(reader->next(read));
    } catch (const ReadError& error) {
      outcome.error = error.what();
    }
    outcome.summary = reader->summary();
  } catch (const ReadError& error) {
    outcome.error = error.what();
  }
  return outcome;
}

TEST(RawlogReader, DeliversFramesAndSinglesInOrder) {
  mrpt::obs::CSensoryFrame frame;
  for (const char* label : {"a", "b"}) {
    auto odometry = mrpt::obs::CObservationOdometry::Create();
    odometry->sensorLabel = label;
    frame.insert(odometry);
  }
  auto scan = mrpt::obs::CObservation2DRangeScan::Create();
  scan->sensorLabel = "c";
  const std::string bytes =
      stored(mrpt::obs::CActionCollection()) + stored(frame) + stored(*scan) + stored(frame);
  const auto reader = open_observations(write_file(fresh_folder() / "a.rawlog", bytes));
  std::string order;
  for (ReadObservation read; reader->next(read);) {
    order += std::to_string(read.entry) + read.observation->sensorLabel + " ";
    EXPECT_FALSE(read.T_map_robot);
  }
  EXPECT_EQ(order, "1a 1b 2c 3a 3b ");
  EXPECT_EQ(reader->summary().entries, 4u);
  EXPECT_EQ(reader->summary().observations,
            (std::map<std::string, std::size_t>{{"mrpt::obs::CObservation2DRangeScan", 1},
                                                {"mrpt::obs::CObservationOdometry", 4}}));
  EXPECT_DOUBLE_EQ(reader->progress(), 1.0);
}

/// All rawlogs that come with MRPT.
std::vector<std::filesystem::path> rawlogs() {
  std::vector<std::filesystem::path> files;
  if (!std::filesystem::exists(mrpt_datasets())) return files;
  for (const auto& entry : std::filesystem::directory_iterator(mrpt_datasets())) {
    if (entry.path().extension() == ".rawlog") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(RawlogReader, OracleReadsAsManyObservationsAsMrpt) {
  const auto files = rawlogs();
  if (files.empty()) GTEST_SKIP() << "MRPT's data sets are not installed";
  for (const auto& file : files) {
    mrpt::obs::CRawlog oracle;
    ASSERT_TRUE(oracle.loadFromRawLogFile(file.string()));
    std::size_t observations = 0;
    for (std::size_t k = 0; k < oracle.size(); ++k) {
      const auto type = oracle.getType(k);
      if (type == mrpt::obs::CRawlog::etObservation) ++observations;
      if (type == mrpt::obs::CRawlog::etSensoryFrame) {
        observations += oracle.getAsObservations(k)->size();
      }
    }
    // MRPT keeps the comment of a rawlog apart.
    const std::size_t comments = oracle.getCommentText().empty() ? 0 : 1;
    const Outcome outcome = read_file_to_its_end(file.string());
    EXPECT_EQ(outcome.error, "") << file;
    EXPECT_EQ(outcome.observations, observations + comments) << file;
    EXPECT_EQ(outcome.summary.entries, oracle.size() + comments) << file;
    EXPECT_TRUE(outcome.summary.unknown_classes.empty()) << file;
  }
}

class RealRawlog : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const auto file = mrpt_datasets() / GetParam();
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "MRPT's data sets are not installed";
    bytes_ = gunzip_file(file);
    whole_ = read_file_to_its_end(file.string());
  }
  std::string bytes_;
  Outcome whole_;
};

TEST_P(RealRawlog, EveryCutIsNoticed) {
  const auto folder = fresh_folder();
  const std::string packed = gzip(bytes_);
  constexpr std::size_t kCuts = 60;
  for (std::size_t k = 0; k < kCuts; ++k) {
    const std::size_t at = packed.size() * k / kCuts + k % 7;
    const Outcome cut = read_file_to_its_end(write_file(folder / "a.rawlog", packed.substr(0, at)));
    EXPECT_NE(cut.error, "") << "gzip cut at " << at;
    EXPECT_LE(cut.observations, whole_.observations);
  }
  std::size_t clean = 0;
  for (std::size_t k = 0; k < kCuts; ++k) {
    const std::size_t at = bytes_.size() * k / kCuts + k % 7;
    const Outcome cut = read_file_to_its_end(write_file(folder / "b.rawlog", bytes_.substr(0, at)));
    if (cut.error.empty()) {
      ++clean;
      EXPECT_EQ(bytes_[at - 1], '\x88') << "no object ends at " << at;
    }
  }
  EXPECT_LT(clean, 3u) << "cuts between objects are rare";
}

/// MRPT allocates what a stored length says, so a damaged one may ask for nearly all memory there
/// is; a bound turns that into the exception that the reader reports.
class MemoryBound {
 public:
  explicit MemoryBound(rlim_t bytes) {
    getrlimit(RLIMIT_AS, &before_);
    const rlimit bound{std::min(bytes, before_.rlim_cur), before_.rlim_max};
    setrlimit(RLIMIT_AS, &bound);
  }
  ~MemoryBound() { setrlimit(RLIMIT_AS, &before_); }

 private:
  rlimit before_{};
};

TEST_P(RealRawlog, FlippedBitsNeverCrashAndNeverHideInGzip) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers need more address space than the bound of this test";
#endif
  const MemoryBound bound(rlim_t{4} << 30);
  const auto folder = fresh_folder();
  const std::string packed = gzip(bytes_);
  std::uint32_t random = 12345;
  constexpr int kFlips = 40;
  for (int k = 0; k < kFlips; ++k) {
    random = random * 1664525u + 1013904223u;
    std::string damaged = packed;
    const std::size_t at = 10 + (random >> 4) % (packed.size() - 10);
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << (random & 7)));
    const Outcome outcome = read_file_to_its_end(write_file(folder / "a.rawlog", damaged));
    EXPECT_NE(outcome.error, "") << "seed 12345, flip " << k << " at " << at;
  }
  std::size_t noticed = 0;
  for (int k = 0; k < kFlips; ++k) {
    random = random * 1664525u + 1013904223u;
    std::string damaged = bytes_;
    // Without checksum a flip in the data cannot be seen; one in the first bytes of an object can.
    const std::size_t at = k < kFlips / 2 ? (random >> 4) % 24 : (random >> 4) % bytes_.size();
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << (random & 7)));
    const Outcome outcome = read_file_to_its_end(write_file(folder / "b.rawlog", damaged));
    noticed += !outcome.error.empty() || !outcome.summary.unknown_classes.empty() ? 1 : 0;
  }
  EXPECT_GT(noticed, kFlips / 4u);
}

INSTANTIATE_TEST_SUITE_P(Mrpt, RealRawlog,
                         testing::Values("test_velodyne_VLP16.rawlog", "localization_demo.rawlog",
                                         "test_rtk_path.rawlog", "rot_scan_2d.rawlog"),
                         [](const auto& test) {
                           std::string name = test.param;
                           return name.substr(0, name.find('.'));
                         });

}  // namespace
}  // namespace mrpt_terrain::io
