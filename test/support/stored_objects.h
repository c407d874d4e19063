// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/CSerializable.h>
#include <zlib.h>

#include <Eigen/Dense>
#include <filesystem>
#include <string>
#include <vector>

#include "test_files.h"

namespace mrpt_terrain::test {

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

/// Norm of the difference of two poses as matrices.
inline double difference(const mrpt::poses::CPose3D& a, const mrpt::poses::CPose3D& b) {
  const auto matrix = [](const mrpt::poses::CPose3D& pose) {
    return Eigen::Matrix4d(pose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen());
  };
  return (matrix(a) - matrix(b)).norm();
}

}  // namespace mrpt_terrain::test
