// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/io/object_stream.h"

#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>

#include "stored_objects.h"

namespace mrpt_terrain::io {
namespace {

using namespace mrpt_terrain::test;
using mrpt::obs::CObservationIMU;
using mrpt::obs::CObservationOdometry;

mrpt::obs::CObservationOdometry odometry(const std::string& label) {
  CObservationOdometry result;
  result.sensorLabel = label;
  return result;
}

/// Gives the class of an object, and of what it holds, a name that nobody knows.
std::string rename_class(std::string bytes, const std::string& name, const std::string& new_name) {
  EXPECT_EQ(name.size(), new_name.size());
  const std::size_t at = bytes.find(name);
  EXPECT_NE(at, std::string::npos);
  return bytes.replace(at, name.size(), new_name);
}

std::string unknown_object() {
  mrpt::obs::CObservationIMU imu;
  imu.sensorLabel = "imu";
  return rename_class(stored(imu), "CObservationIMU", "CObservationXYZ");
}

struct Read {
  std::vector<std::string> objects;  ///< "entry label-or-class"
  ReadSummary summary;
  std::string error;
};

Read read_stream(const std::string& bytes) {
  Read read;
  ObjectStream stream(write_file(fresh_folder() / "a.rawlog", bytes));
  try {
    StoredObject object;
    while (stream.next(object)) {
      const auto* observation = dynamic_cast<mrpt::obs::CObservation*>(object.object.get());
      read.objects.push_back(std::to_string(object.entry) + " " +
                             (observation != nullptr ? observation->sensorLabel
                              : object.object        ? object.object->GetRuntimeClass()->className
                                                     : "null"));
    }
  } catch (const ReadError& error) {
    read.error = error.what();
    EXPECT_EQ(message_of<ReadError>([&] {
                StoredObject object;
                stream.next(object);
              }),
              read.error)
        << "an error must not turn into an end";
  }
  read.summary = stream.summary();
  return read;
}

using List = std::vector<std::string>;

TEST(ObjectStream, CountsEntriesAsTopLevelObjects) {
  mrpt::obs::CActionCollection actions;
  mrpt::obs::CSensoryFrame frame;
  frame.insert(CObservationOdometry::Create(odometry("in frame")));
  const Read read = read_stream(stored(actions) + stored(frame) + stored(odometry("single")));
  EXPECT_EQ(read.objects,
            (List{"0 mrpt::obs::CActionCollection", "1 mrpt::obs::CSensoryFrame", "2 single"}));
  EXPECT_EQ(read.error, "");
  EXPECT_EQ(read.summary.entries, 3u);
  EXPECT_EQ(read.summary.skipped_bytes, 0u);
}

TEST(ObjectStream, StepsIntoAStoredRawlog) {
  mrpt::obs::CRawlog rawlog;
  rawlog.insert(CObservationOdometry::Create(odometry("a")));
  rawlog.insert(CObservationOdometry::Create(odometry("b")));
  rawlog.setCommentText("hello");
  const std::string bytes = stored(rawlog);
  const Read read = read_stream(bytes);
  EXPECT_EQ(read.objects, (List{"0 a", "1 b", "2 "}));
  EXPECT_EQ(read.error, "");
  for (std::size_t n = 30; n < bytes.size(); n += 3) {
    EXPECT_NE(read_stream(bytes.substr(0, n)).error, "") << "cut at " << n;
  }
}

TEST(ObjectStream, StepsOverAnUnknownClass) {
  const std::string unknown = unknown_object();
  const Read read = read_stream(stored(odometry("a")) + unknown + unknown + stored(odometry("b")));
  EXPECT_EQ(read.objects, (List{"0 a", "3 b"}));
  EXPECT_EQ(read.summary.unknown_classes,
            (std::map<std::string, std::size_t>{{"mrpt::obs::CObservationXYZ", 2}}));
  EXPECT_EQ(read.summary.skipped_bytes, 2 * unknown.size());
  EXPECT_EQ(read.summary.entries, 4u);
  EXPECT_EQ(read.error, "");
}

TEST(ObjectStream, AnUnknownClassMayBeginOrEndTheFile) {
  const std::string unknown = unknown_object();
  EXPECT_EQ(read_stream(unknown + stored(odometry("a"))).objects, (List{"1 a"}));
  const Read at_end = read_stream(stored(odometry("a")) + unknown);
  EXPECT_EQ(at_end.objects, (List{"0 a"}));
  EXPECT_EQ(at_end.error, "");
  const Read only = read_stream(unknown);
  EXPECT_EQ(only.objects, List{});
  EXPECT_EQ(only.summary.unknown_classes.size(), 1u);
  // Cut off within the unknown object (a byte of its data that is no end flag is the last one).
  const Read cut = read_stream(stored(odometry("a")) + unknown.substr(0, unknown.size() - 1));
  EXPECT_TRUE(contains(cut.error, "CObservationXYZ")) << cut.error;
  EXPECT_TRUE(contains(cut.error, "cut off")) << cut.error;
}

TEST(ObjectStream, AStringThatNamesAClassIsNoObject) {
  mrpt::obs::CObservationIMU imu;
  imu.sensorLabel = "mrpt::obs::CObservationIMU";
  std::string unknown = stored(imu);
  unknown.replace(1, imu.sensorLabel.size(), "mrpt::obs::CObservationXYZ");
  EXPECT_EQ(read_stream(unknown + stored(odometry("a"))).objects, (List{"1 a"}));
}

TEST(ObjectStream, AnUnknownClassInAFrameLosesOnlyItself) {
  const auto frame_with = [](int place) {
    mrpt::obs::CSensoryFrame frame;
    for (int k = 0; k < 3; ++k) {
      if (k == place) {
        frame.insert(CObservationIMU::Create());
      } else {
        frame.insert(CObservationOdometry::Create(odometry(std::to_string(k))));
      }
    }
    return rename_class(stored(frame), "CObservationIMU", "CObservationXYZ");
  };
  const std::string actions = stored(mrpt::obs::CActionCollection());
  const std::string after = actions + stored(mrpt::obs::CSensoryFrame());
  const List tail{"2 mrpt::obs::CActionCollection", "3 mrpt::obs::CSensoryFrame"};
  // What stands before the unknown observation goes down with the frame, which MRPT reads whole.
  const List lists[] = {{"1 1", "1 2"}, {"1 2"}, {}};
  for (int place = 0; place < 3; ++place) {
    const Read read = read_stream(actions + frame_with(place) + after);
    List expected{"0 mrpt::obs::CActionCollection"};
    expected.insert(expected.end(), lists[place].begin(), lists[place].end());
    expected.insert(expected.end(), tail.begin(), tail.end());
    EXPECT_EQ(read.objects, expected) << "place " << place;
    EXPECT_EQ(read.error, "");
    EXPECT_EQ(read.summary.entries, 4u);
    EXPECT_EQ(read.summary.unknown_classes.count("mrpt::obs::CObservationXYZ"), 1u);
    // The frame may also be the last object of the file.
    EXPECT_EQ(read_stream(actions + frame_with(place)).error, "") << "place " << place;
  }
}

TEST(ObjectStream, AnUnknownMapInACloudLosesThatCloud) {
  mrpt::obs::CObservationPointCloud cloud;
  auto map = mrpt::maps::CSimplePointsMap::Create();
  for (int k = 0; k < 5000; ++k) map->insertPoint(static_cast<float>(k), 0, 0);
  cloud.pointcloud = map;
  const std::string bytes = rename_class(stored(cloud), "CSimplePointsMap", "CSomeoneElsesMap");
  const Read read = read_stream(stored(odometry("a")) + bytes + stored(odometry("b")));
  EXPECT_EQ(read.objects, (List{"0 a", "2 b"}));
  EXPECT_EQ(read.summary.unknown_classes.begin()->first, "mrpt::maps::CSomeoneElsesMap");
  EXPECT_EQ(read.summary.skipped_bytes, bytes.size());
}

TEST(ObjectStream, DamageInAKnownObjectIsAnErrorWithItsPlace) {
  const std::string a = stored(odometry("a"));
  std::string b = stored(odometry("b"));
  b.back() = 'x';  // instead of the end flag
  const Read read = read_stream(a + b + a);
  EXPECT_EQ(read.objects, (List{"0 a"}));
  EXPECT_TRUE(contains(read.error, "a.rawlog: entry 1 (mrpt::obs::CObservationOdometry) at byte " +
                                       std::to_string(a.size()) + ", read up to byte " +
                                       std::to_string(a.size() + b.size()) + ": damaged: "))
      << read.error;
}

TEST(ObjectStream, RubbishBetweenObjectsIsAnError) {
  const std::string a = stored(odometry("a"));
  const Read read = read_stream(a + std::string(300, '#') + a);
  EXPECT_EQ(read.objects, (List{"0 a"}));
  EXPECT_TRUE(contains(read.error, "entry 1 at byte " + std::to_string(a.size()))) << read.error;
  EXPECT_TRUE(contains(read.error, "no object begins here")) << read.error;
}

TEST(ObjectStream, ReadsTheFormatBeforeEndFlags) {
  // Length as uint32, name, version as int32, data, no end flag.
  const std::string a = stored(odometry("a"));
  const std::string name = "mrpt::obs::CObservationOdometry";
  const char version = a[1 + name.size()];
  std::string old{static_cast<char>(name.size()), 0, 0, 0};
  old += name + std::string{version, 0, 0, 0};
  old += a.substr(2 + name.size(), a.size() - 3 - name.size());
  EXPECT_EQ(read_stream(old + old).objects, (List{"0 a", "1 a"}));
  EXPECT_NE(read_stream(old.substr(0, old.size() - 1)).error, "");
}

TEST(ObjectStream, EveryCutIsAnErrorExceptBetweenObjects) {
  const std::string a = stored(odometry("some label")), b = unknown_object();
  const std::string bytes = a + b + a;
  for (std::size_t n = 40; n < bytes.size(); ++n) {
    const Read read = read_stream(bytes.substr(0, n));
    const bool between = n == a.size() || n == a.size() + b.size();
    // Within an unknown object only the last byte tells: it may look like an end flag.
    const bool looks_whole = n > a.size() + 20 && n < a.size() + b.size() && bytes[n - 1] == '\x88';
    if (!looks_whole) {
      EXPECT_EQ(read.error.empty(), between) << "cut at " << n << ": " << read.error;
    }
  }
}

}  // namespace
}  // namespace mrpt_terrain::io
