// SPDX-License-Identifier: BSD-3-Clause
#include "input_support.h"

#include <mrpt/core/bits_math.h>
#include <mrpt/img/CImage.h>
#include <mrpt/io/lazy_load_path.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "mrpt_terrain/io/kitti_scan.h"
#include "mrpt_terrain/params/data_files.h"
#include "mrpt_terrain/view/text.h"

using mrpt::poses::CPose3D;

CPose3D parse_pose(const std::string& text) {
  std::string plain = text;
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return c == '[' || c == ']' || c == ','; }, ' ');
  std::istringstream stream(plain);
  std::vector<double> v;
  for (double number = 0; stream >> number;) v.push_back(number);
  const bool finite = std::all_of(v.begin(), v.end(), [](double d) { return std::isfinite(d); });
  if (!stream.eof() || !finite || (v.size() != 3 && v.size() != 6)) {
    throw std::invalid_argument("--sensor-pose: \"" + text +
                                "\" is no pose: give \"x y z\" or \"x y z yaw pitch roll\" in "
                                "metres and degrees");
  }
  v.resize(6, 0.0);
  return {v[0], v[1], v[2], mrpt::DEG2RAD(v[3]), mrpt::DEG2RAD(v[4]), mrpt::DEG2RAD(v[5])};
}

std::string pose_text(const CPose3D& pose) {
  std::string text;
  for (const double metres : {pose.x(), pose.y(), pose.z()}) {
    text += mrpt_terrain::view::fixed(metres, 3) + " ";
  }
  for (const double angle : {pose.yaw(), pose.pitch(), pose.roll()}) {
    text += mrpt_terrain::view::fixed(mrpt::RAD2DEG(angle), 2) + " ";
  }
  text.pop_back();
  return text;
}

std::string lower_extension(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

void refuse_pipe(const std::string& file) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(file, ignored);
  if (std::filesystem::is_other(status)) {
    throw mrpt_terrain::io::ReadError(file + ": is a pipe or a device, not a file");
  }
}

std::unique_ptr<mrpt_terrain::io::ObservationReader> open_input(const std::string& file,
                                                                bool scan_file) {
  refuse_pipe(file);
  if (scan_file) return mrpt_terrain::io::open_kitti_scan(file);
  return mrpt_terrain::io::open_observations(file);
}

std::string externals_dir_of(const std::string& rawlog) {
  const std::filesystem::path file(rawlog);
  std::filesystem::path own = file;
  own.replace_filename(file.stem().string() + "_Images");
  std::error_code ignored;
  if (std::filesystem::is_directory(own, ignored)) return own.string();
  const std::filesystem::path shared = file.parent_path() / "Images";
  return std::filesystem::is_directory(shared, ignored) ? shared.string() : own.string();
}

void set_externals_dir(const std::string& given, const std::string& rawlog) {
  const std::string folder = given.empty() ? externals_dir_of(rawlog) : given;
  mrpt::io::setLazyLoadPathBase(folder);
  mrpt::img::CImage::setImagesPathBase(folder);
}

mrpt_terrain::sensors::SensorModels load_sensor_models() {
  const auto folder = mrpt_terrain::params::find_data_folder() / "params" / "sensors";
  return mrpt_terrain::sensors::SensorModels::from_folder(folder.string());
}
