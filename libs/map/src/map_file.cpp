// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/map/map_file.h"

#include <mrpt/serialization/CArchive.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <stdexcept>
#include <string_view>

#include "mrpt_terrain/files/atomic_file.h"
#include "mrpt_terrain/io/byte_stream.h"
#include "mrpt_terrain/io/observation_reader.h"

namespace mrpt_terrain {
namespace {

// How MRPT stores an object: a byte 0x80 | length of the class name, the name, the rest.
const std::string kClass = "mrpt_terrain::CTerrainMap";

struct CloseGzip {
  void operator()(gzFile file) const { gzclose(file); }
};

/// Writes a gzip file. Unlike CFileGZOutputStream it tells whether all bytes arrived. What goes
/// wrong is kept until `close`: MRPT would bury an exception under a call stack.
class GzipArchive : public mrpt::serialization::CArchive {
 public:
  explicit GzipArchive(const std::string& file) : file_(gzopen(file.c_str(), "wb6")) {
    if (!file_) throw std::runtime_error(std::strerror(errno));
  }
  void close() {
    errno = 0;
    const bool closed = gzclose(file_.release()) == Z_OK;
    if (!closed && error_ == 0) error_ = errno == 0 ? EIO : errno;
    if (error_ != 0) throw std::runtime_error(std::strerror(error_));
  }
  std::string getArchiveDescription() const override { return "a map's file"; }

 private:
  std::size_t read(void*, std::size_t) override { throw std::logic_error("write only"); }
  std::size_t write(const void* from, std::size_t n) override {
    constexpr std::size_t kPiece = 1U << 30U;
    const auto* bytes = static_cast<const std::uint8_t*>(from);
    for (std::size_t begin = 0; begin < n && error_ == 0; begin += kPiece) {
      const auto piece = static_cast<unsigned>(std::min(kPiece, n - begin));
      errno = 0;
      if (gzwrite(file_.get(), bytes + begin, piece) != static_cast<int>(piece)) {
        error_ = errno == 0 ? EIO : errno;
      }
    }
    return n;
  }

  std::unique_ptr<gzFile_s, CloseGzip> file_;
  int error_ = 0;
};

/// No std::exception, so that MRPT does not wrap it into a call stack.
struct DataEnds {};

class ReadingArchive : public mrpt::serialization::CArchive {
 public:
  explicit ReadingArchive(io::ByteStream& bytes) : bytes_(bytes) {}
  std::string getArchiveDescription() const override { return bytes_.file(); }

 private:
  std::size_t read(void* to, std::size_t n) override {
    if (bytes_.read(to, n) < n) throw DataEnds{};
    return n;
  }
  std::size_t write(const void*, std::size_t) override { throw std::logic_error("read only"); }

  io::ByteStream& bytes_;
};

/// Name of the class of the first object, empty if there is none.
std::string first_class(io::ByteStream& bytes) {
  constexpr std::size_t kMostLetters = 0x7F;
  const std::uint8_t* data = nullptr;
  const std::size_t seen = bytes.peek(1 + kMostLetters, data);
  if (seen == 0 || (data[0] & 0x80U) == 0) return {};
  const std::size_t letters = data[0] & kMostLetters;
  if (seen < 1 + letters) return {};
  const std::string name(reinterpret_cast<const char*>(data) + 1, letters);
  const bool plausible =
      std::all_of(name.begin(), name.end(), [](unsigned char c) { return c > ' ' && c < 0x7F; });
  return plausible ? name : std::string();
}

/// What an exception says below the layers that MRPT put around it.
std::string reason_of(std::string_view what) {
  for (const std::string_view mark : {"Original exception:\n", "Message:"}) {
    const std::size_t at = what.rfind(mark);
    if (at != std::string_view::npos) what.remove_prefix(at + mark.size());
  }
  what = what.substr(0, what.find('\n'));
  for (const std::string_view beginning : {"  ", " ", "terrain map: "}) {
    if (what.substr(0, beginning.size()) == beginning) what.remove_prefix(beginning.size());
  }
  return std::string(what);
}

std::string why_it_ends(const io::ByteStream& bytes) {
  return bytes.failure().empty() ? "the map in it is cut off" : bytes.failure();
}

/// \return what is wrong; empty if nothing is
std::string read_map(io::ByteStream& bytes, CTerrainMap& map) {
  const std::string name = first_class(bytes);
  if (name.empty()) {
    return bytes.failure().empty() ? "is no terrain map: it does not begin with an MRPT object"
                                   : bytes.failure();
  }
  if (name != kClass) return "is no terrain map: it holds a " + name;
  try {
    ReadingArchive archive(bytes);
    archive >> map;
  } catch (const DataEnds&) {
    return why_it_ends(bytes);
  } catch (const std::bad_alloc&) {
    return "asks for more memory than there is";
  } catch (const std::exception& error) {
    return reason_of(error.what());
  }
  const std::uint8_t* data = nullptr;
  if (bytes.peek(1, data) != 0) return "there is more in it than a map";
  return bytes.failure();  // the end of gzip data checks all of it
}

}  // namespace

void save_map_file(const CTerrainMap& map, const std::string& file) {
  files::write_atomically(file, [&map](const std::string& part_file) {
    GzipArchive archive(part_file);
    archive << map;
    archive.close();
  });
}

CTerrainMap load_map_file(const std::string& file) {
  io::ByteStream bytes(file);
  CTerrainMap map;
  const std::string problem = read_map(bytes, map);
  if (!problem.empty()) throw io::ReadError(file + ": " + problem);
  return map;
}

bool is_map_file(const std::string& file) {
  io::ByteStream bytes(file);
  return first_class(bytes) == kClass;
}

}  // namespace mrpt_terrain
