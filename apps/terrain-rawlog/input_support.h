// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/poses/CPose3D.h>

#include <memory>
#include <string>

#include "mrpt_terrain/io/observation_reader.h"
#include "mrpt_terrain/sensors/sensor_model.h"

/// Pose from "x y z yaw pitch roll" (metres, degrees; commas and MRPT's brackets allowed; "x y z"
/// alone is a pose without rotation). Throws std::invalid_argument with the option --sensor-pose
/// and the form it wants.
[[nodiscard]] mrpt::poses::CPose3D parse_pose(const std::string& text);

/// The same form, for messages.
[[nodiscard]] std::string pose_text(const mrpt::poses::CPose3D& pose);

/// Extension of a file's name in lower case, such as ".ply".
[[nodiscard]] std::string lower_extension(const std::string& file);

/// Refuses files that cannot be read more than once, instead of waiting for them. Throws ReadError
/// for pipes and devices.
void refuse_pipe(const std::string& file);

/// `io::open_observations`, or `io::open_kitti_scan` for files of one scan, for files that can be
/// read more than once, as the programs do: pipes and devices are refused with a ReadError instead
/// of waited for.
[[nodiscard]] std::unique_ptr<mrpt_terrain::io::ObservationReader> open_input(
    const std::string& file, bool scan_file = false);

/// Where rawlog tools keep the externally stored data of `drive.rawlog`: `drive_Images` beside it,
/// else `Images` beside it. (`CRawlog::detectImagesDirectory` of MRPT 2.5.8 loses the separator
/// behind the folder.)
[[nodiscard]] std::string externals_dir_of(const std::string& rawlog);

/// Tells MRPT where the externally stored data of a rawlog are: the given folder, or the one that
/// rawlog tools use for that file.
void set_externals_dir(const std::string& given, const std::string& rawlog);

/// The beam tables that come with the project.
[[nodiscard]] mrpt_terrain::sensors::SensorModels load_sensor_models();
