// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Inserts scans into an octree and prints what each insertion took. scripts/bench-octree.sh lets
/// this library and OctoMap take turns, a process each, because memory that one of them gives back
/// is tidied up at the expense of whoever allocates next.
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/serialization/CArchive.h>

#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "mrpt_terrain/io/scan.h"
#include "octree_scans.h"

namespace mrpt_terrain::bench {
namespace {

using octomap::OcTree;
using test::OctreeScan;

constexpr const char* kUsage =
    R"(usage: octree_insertion WHO SCANS COUNT RESOLUTION MAX_RANGE DISCRETIZE

WHO         own, octomap, or check: both, and the trees are compared after every scan
SCANS       a folder of the real data, such as kitti_raw_0001, or a rawlog, whose first scan is used
COUNT       scans to insert, at most
RESOLUTION  metres
MAX_RANGE   metres; negative: no limit
DISCRETIZE  0 or 1

Prints a line per scan: number, milliseconds of processor time.
)";

std::vector<OctreeScan> first_scan_of(const std::string& rawlog) {
  mrpt::io::CFileGZInputStream stream(rawlog);
  auto archive = mrpt::serialization::archiveFrom(stream);
  const auto observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(archive.ReadObject());
  io::SensorPoints points;
  if (!observation ||
      io::convert_observation(*observation, {}, {}, points).status != io::ConversionStatus::kOk) {
    throw std::runtime_error(rawlog + " does not begin with a scan");
  }
  OctreeScan scan;
  scan.x = points.points.x;
  scan.y = points.points.y;
  scan.z = points.points.z;
  return {scan};
}

std::vector<OctreeScan> read_scans(const std::string& name, std::size_t count) {
  if (std::filesystem::path(name).extension() == ".rawlog") return first_scan_of(name);
  auto scans = test::kitti_scans(name, count);
  if (scans.empty()) throw std::runtime_error((test::data_folder() / name).string() + ": no scans");
  return scans;
}

double processor_milliseconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

double insert_own(const OctreeScan& scan, const octree::InsertionOptions& options,
                  octree::InsertionWorkspace& workspace, OcTree& tree) {
  const double start = processor_milliseconds();
  (void)octree::insert_scan(scan.ends(), scan.starts(), options, workspace, tree);
  return processor_milliseconds() - start;
}

double insert_octomap(const OctreeScan& scan, const octree::InsertionOptions& options,
                      OcTree& tree) {
  const octomap::Pointcloud cloud = test::cloud_of(scan, options, tree);
  const double start = processor_milliseconds();
  tree.insertPointCloud(cloud, scan.origin(0), options.max_range, false, options.discretize);
  return processor_milliseconds() - start;
}

int run(const std::vector<std::string>& arguments) {
  if (arguments.size() != 6) {
    std::cerr << kUsage;
    return 2;
  }
  const std::string& who = arguments[0];
  const auto scans = read_scans(arguments[1], std::stoul(arguments[2]));
  const octree::InsertionOptions options{std::stod(arguments[4]), arguments[5] == "1"};
  OcTree own(std::stod(arguments[3])), octomap(std::stod(arguments[3]));
  octree::InsertionWorkspace workspace;
  for (std::size_t k = 0; k < scans.size(); ++k) {
    double time = 0.0;
    if (who != "octomap") time = insert_own(scans[k], options, workspace, own);
    if (who != "own") time = insert_octomap(scans[k], options, octomap);
    std::cout << k + 1 << ' ' << time << '\n';
    if (who == "check" && !(own == octomap)) throw std::runtime_error("the trees differ");
  }
  if (who == "check" && !test::same_tree(own, octomap)) throw std::runtime_error("bytes differ");
  return 0;
}

}  // namespace
}  // namespace mrpt_terrain::bench

int main(int argc, char** argv) {
  try {
    return mrpt_terrain::bench::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::cerr << "octree_insertion: " << error.what() << '\n';
    return 1;
  }
}
