// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/io/byte_stream.h"

#include <zlib.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <vector>

#include "mrpt_terrain/io/observation_reader.h"

namespace mrpt_terrain::io {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 16;

struct CloseFile {
  void operator()(std::FILE* f) const { std::fclose(f); }
};

std::unique_ptr<std::FILE, CloseFile> open_file(const std::string& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw ReadError(file + ": no such file");
  if (std::filesystem::is_directory(status)) throw ReadError(file + ": is a folder, not a file");
  std::unique_ptr<std::FILE, CloseFile> handle(std::fopen(file.c_str(), "rb"));
  if (!handle) throw ReadError(file + ": cannot be opened: " + std::strerror(errno));
  return handle;
}

}  // namespace

struct ByteStream::Impl {
  Impl(const std::string& name, Compression compression) : file(name), handle(open_file(name)) {
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(name, error);
    if (!error) file_size = static_cast<double>(bytes);
    refill_source();
    if (source_end == 0) {
      throw ReadError(name + ": " + (failure.empty() ? std::string("is empty") : failure));
    }
    gzip = compression == Compression::kByContent && source_end >= 2 && source[0] == 0x1F &&
           source[1] == 0x8B;
    constexpr int kGzipOnly = 15 + 16;
    if (gzip && inflateInit2(&inflater, kGzipOnly) != Z_OK) throw std::bad_alloc();
  }
  ~Impl() {
    if (gzip) inflateEnd(&inflater);
  }

  /// Reads the next block of the file; leaves the source empty at the end.
  void refill_source() {
    source_begin = 0;
    source_end = std::fread(source.data(), 1, source.size(), handle.get());
    source_taken += source_end;
    if (source_end == 0 && std::ferror(handle.get()) != 0) {
      failure = std::string("cannot be read: ") + std::strerror(errno);
    }
  }

  /// Produces up to n bytes; 0 at the end.
  std::size_t decode(std::uint8_t* to, std::size_t n) {
    if (gzip) return decompress(to, n);
    if (source_begin == source_end) refill_source();
    const std::size_t count = std::min(n, source_end - source_begin);
    std::memcpy(to, source.data() + source_begin, count);
    source_begin += count;
    return count;
  }

  std::size_t decompress(std::uint8_t* to, std::size_t n) {
    inflater.next_out = to;
    inflater.avail_out = static_cast<uInt>(n);
    while (inflater.avail_out == n && failure.empty()) {
      if (source_begin == source_end) refill_source();
      if (source_begin == source_end) {
        if (!between_members && failure.empty()) failure = "the gzip data is cut off";
        break;
      }
      inflater.next_in = source.data() + source_begin;
      inflater.avail_in = static_cast<uInt>(source_end - source_begin);
      const int code = inflate(&inflater, Z_NO_FLUSH);
      source_begin = source_end - inflater.avail_in;
      judge(code);
    }
    return n - inflater.avail_out;
  }

  void judge(int code) {
    if (code == Z_STREAM_END) {
      between_members = true;
      inflateReset(&inflater);
    } else if (code == Z_OK) {
      between_members = false;
    } else {
      failure = std::string("the gzip data is damaged") +
                (inflater.msg != nullptr ? std::string(": ") + inflater.msg : std::string());
    }
  }

  void refill_window() {
    std::memmove(window.data(), window.data() + begin, end - begin);
    end -= begin;
    begin = 0;
    if (!failure.empty()) return;
    end += decode(window.data() + end, window.size() - end);
  }

  std::string file, failure;
  std::unique_ptr<std::FILE, CloseFile> handle;
  double file_size = 0.0;
  bool gzip = false;
  bool between_members = false;  // of gzip: the file may end here
  z_stream inflater{};
  std::vector<std::uint8_t> source = std::vector<std::uint8_t>(kBlock);  // as in the file
  std::size_t source_begin = 0, source_end = 0;
  std::uint64_t source_taken = 0;
  std::vector<std::uint8_t> window = std::vector<std::uint8_t>(kBlock + kMaxPeek);  // decompressed
  std::size_t begin = 0, end = 0;
  std::uint64_t position = 0;
};

ByteStream::ByteStream(const std::string& file, Compression compression)
    : impl_(std::make_unique<Impl>(file, compression)) {}
ByteStream::~ByteStream() = default;

std::size_t ByteStream::peek(std::size_t n, const std::uint8_t*& data) {
  assert(n <= kMaxPeek);
  std::size_t before = impl_->end + 1;
  while (impl_->end - impl_->begin < n && before != impl_->end - impl_->begin) {
    before = impl_->end - impl_->begin;
    impl_->refill_window();
  }
  data = impl_->window.data() + impl_->begin;
  return impl_->end - impl_->begin;
}

void ByteStream::skip(std::size_t n) {
  assert(n <= impl_->end - impl_->begin);
  impl_->begin += n;
  impl_->position += n;
}

std::size_t ByteStream::read(void* to, std::size_t n) {
  std::size_t done = 0;
  while (done < n) {
    const std::uint8_t* data = nullptr;
    const std::size_t count = std::min(peek(1, data), n - done);
    if (count == 0) break;
    std::memcpy(static_cast<std::uint8_t*>(to) + done, data, count);
    skip(count);
    done += count;
  }
  return done;
}

const std::string& ByteStream::failure() const {
  static const std::string none;
  return impl_->begin == impl_->end ? impl_->failure : none;
}
std::uint64_t ByteStream::position() const { return impl_->position; }
const std::string& ByteStream::file() const { return impl_->file; }

double ByteStream::progress() const {
  if (impl_->file_size <= 0.0) return 0.0;
  const auto left = static_cast<double>(impl_->source_end - impl_->source_begin);
  return std::min(1.0, (static_cast<double>(impl_->source_taken) - left) / impl_->file_size);
}

}  // namespace mrpt_terrain::io
