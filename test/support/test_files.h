// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/CSerializable.h>
#include <zlib.h>

#include <Eigen/Dense>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace mrpt_terrain::test {

/// A fresh folder for the running test.
inline std::filesystem::path fresh_folder() {
  const auto* info = testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string(info->test_suite_name()) + "." + info->name();
  for (char& c : name) {
    if (c == '/') c = '_';
  }
  const auto folder = std::filesystem::path(testing::TempDir()) / "mrpt_terrain_io" / name;
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

inline std::string write_file(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
  return path.string();
}

inline std::string read_file(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline std::string gzip(const std::string& bytes) {
  z_stream z{};
  deflateInit2(&z, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&z, bytes.size()) + 64, '\0');
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  z.avail_in = static_cast<uInt>(bytes.size());
  z.next_out = reinterpret_cast<Bytef*>(out.data());
  z.avail_out = static_cast<uInt>(out.size());
  deflate(&z, Z_FINISH);
  out.resize(z.total_out);
  deflateEnd(&z);
  return out;
}

inline std::string gunzip_file(const std::filesystem::path& path) {
  std::string out;
  const gzFile gz = gzopen(path.c_str(), "rb");
  std::vector<char> block(1 << 16);
  for (int n = 0; (n = gzread(gz, block.data(), static_cast<unsigned>(block.size()))) > 0;) {
    out.append(block.data(), static_cast<std::size_t>(n));
  }
  gzclose(gz);
  return out;
}

/// The bytes that MRPT stores an object as.
inline std::string stored(const mrpt::serialization::CSerializable& object) {
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << object;
  return {static_cast<const char*>(stream.getRawBufferData()),
          static_cast<std::size_t>(stream.getPosition())};
}

inline std::filesystem::path data_folder() {
  const char* folder = std::getenv("TERRAIN_DATA_DIR");
  return folder != nullptr ? folder : MRPT_TERRAIN_SOURCE_DIR "/../shared/data";
}

inline std::filesystem::path mrpt_datasets() { return "/usr/share/mrpt/datasets"; }

/// Text of the exception of type `Error` that `call` throws; fails the test if it throws none.
template <class Error, class Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

/// Norm of the difference of two poses as matrices.
inline double difference(const mrpt::poses::CPose3D& a, const mrpt::poses::CPose3D& b) {
  const auto matrix = [](const mrpt::poses::CPose3D& pose) {
    return Eigen::Matrix4d(pose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen());
  };
  return (matrix(a) - matrix(b)).norm();
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace mrpt_terrain::test
