// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/png_file.h"

#include <zlib.h>

#include <cstddef>
#include <stdexcept>
#include <string_view>

namespace mrpt_terrain::view {
namespace {

constexpr int kCompression = 3;  // the last of zlib's quick levels

void append_u32(std::string& bytes, std::uint32_t value) {
  for (const unsigned shift : {24U, 16U, 8U, 0U}) {
    bytes += static_cast<char>((value >> shift) & 0xFFU);
  }
}

void append_chunk(std::string& png, std::string_view type, std::string_view data) {
  append_u32(png, static_cast<std::uint32_t>(data.size()));
  const std::size_t start = png.size();
  png += type;
  png += data;
  const auto* bytes = reinterpret_cast<const Bytef*>(png.data() + start);
  append_u32(png,
             static_cast<std::uint32_t>(crc32(0, bytes, static_cast<uInt>(png.size() - start))));
}

std::string header(const Raster<std::uint32_t>& pixels) {
  std::string data;
  append_u32(data, static_cast<std::uint32_t>(pixels.width));
  append_u32(data, static_cast<std::uint32_t>(pixels.height));
  // Bit depth 8, colour type RGB, deflate, standard filters, not interlaced.
  data += std::string_view("\x08\x02\x00\x00\x00", 5);
  return data;
}

std::string unfiltered_rows(const Raster<std::uint32_t>& pixels) {
  const auto width = static_cast<std::size_t>(pixels.width);
  const auto height = static_cast<std::size_t>(pixels.height);
  std::string rows((3 * width + 1) * height, '\0');  // each row starts with filter type 0
  char* out = rows.data();
  const std::uint32_t* pixel = pixels.values.data();
  for (std::size_t row = 0; row < height; ++row) {
    ++out;
    for (std::size_t column = 0; column < width; ++column, ++pixel) {
      *out++ = static_cast<char>((*pixel >> 16U) & 0xFFU);
      *out++ = static_cast<char>((*pixel >> 8U) & 0xFFU);
      *out++ = static_cast<char>(*pixel & 0xFFU);
    }
  }
  return rows;
}

std::string compressed(const std::string& data) {
  uLongf size = compressBound(static_cast<uLong>(data.size()));
  std::string result(size, '\0');
  const int status = compress2(reinterpret_cast<Bytef*>(result.data()), &size,
                               reinterpret_cast<const Bytef*>(data.data()),
                               static_cast<uLong>(data.size()), kCompression);
  if (status != Z_OK) throw std::runtime_error("the picture could not be compressed");
  result.resize(size);
  return result;
}

}  // namespace

std::string png_bytes(const Raster<std::uint32_t>& pixels) {
  std::string png = "\x89PNG\r\n\x1A\n";
  append_chunk(png, "IHDR", header(pixels));
  append_chunk(png, "IDAT", compressed(unfiltered_rows(pixels)));
  append_chunk(png, "IEND", {});
  return png;
}

}  // namespace mrpt_terrain::view
