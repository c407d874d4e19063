// SPDX-License-Identifier: BSD-3-Clause
// Writes what the tests of MRPT's own programs read, out of a rawlog of single observations:
// FOLDER/pairs.rawlog, its scans as pairs of actions and sensory frames, and
// FOLDER/with_map.rawlog, a terrain map in front of the observations.
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>

#include "mrpt_terrain/map/terrain_map.h"

namespace {

using mrpt::obs::CObservation;
using mrpt::obs::CObservationOdometry;
using mrpt::obs::CRawlog;

void open(mrpt::io::CFileGZOutputStream& file, const std::string& name) {
  if (!file.open(name)) throw std::runtime_error(name + ": could not be opened");
}

void write_pairs(const CRawlog& rawlog, const std::string& name) {
  mrpt::io::CFileGZOutputStream file;
  open(file, name);
  auto archive = mrpt::serialization::archiveFrom(file);
  mrpt::poses::CPose2D now, at_last_scan;
  for (std::size_t k = 0; k < rawlog.size(); ++k) {
    const CObservation::Ptr observation = rawlog.getAsObservation(k);
    if (const auto odometry = std::dynamic_pointer_cast<CObservationOdometry>(observation)) {
      now = odometry->odometry;
      continue;
    }
    mrpt::obs::CActionRobotMovement2D movement;
    movement.timestamp = observation->timestamp;
    movement.computeFromOdometry(now - at_last_scan, {});
    at_last_scan = now;
    mrpt::obs::CActionCollection actions;
    actions.insert(movement);
    mrpt::obs::CSensoryFrame frame;
    frame.insert(observation);
    archive << actions << frame;
  }
}

void write_with_map(const CRawlog& rawlog, const std::string& name) {
  mrpt::io::CFileGZOutputStream file;
  open(file, name);
  auto archive = mrpt::serialization::archiveFrom(file);
  archive << mrpt_terrain::CTerrainMap();
  for (std::size_t k = 0; k < rawlog.size(); ++k) archive << *rawlog.getAsObservation(k);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc != 3) throw std::runtime_error("usage: stock_inputs IN.rawlog FOLDER");
    CRawlog rawlog;
    if (!rawlog.loadFromRawLogFile(argv[1])) throw std::runtime_error("the rawlog is unreadable");
    const std::string folder = argv[2];
    write_pairs(rawlog, folder + "/pairs.rawlog");
    write_with_map(rawlog, folder + "/with_map.rawlog");
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "Error: %s\n", error.what());
    return 1;
  }
}
