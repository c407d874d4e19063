// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace mrpt_terrain::io {

/// Whether a file may be compressed.
enum class Compression : std::uint8_t {
  kByContent,  ///< a file that begins as gzip files do is one
  kNone,       ///< it is not, however it begins
};

/// Reads the bytes of a file front to back, gzip decompressed, in constant memory. Unlike
/// `gzread` it tells a proper end from a cut-off or damaged one.
class ByteStream {
 public:
  /// Most bytes that `peek` can show ahead.
  static constexpr std::size_t kMaxPeek = 4096;

  /// Opens a file. Throws ReadError if it is missing, a folder, empty or unreadable.
  explicit ByteStream(const std::string& file, Compression compression = Compression::kByContent);
  ~ByteStream();
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;

  /// Copies up to n bytes; fewer only at the end or where the file is damaged, see `failure`.
  std::size_t read(void* to, std::size_t n);
  /// Shows at least n (<= kMaxPeek) bytes without taking them, fewer only at the end.
  /// \param[out] data valid until the next call
  /// \return how many bytes can be seen
  std::size_t peek(std::size_t n, const std::uint8_t*& data);
  /// Takes n bytes that `peek` has shown.
  void skip(std::size_t n);

  /// Why there are no more bytes; empty at a proper end and before any end.
  [[nodiscard]] const std::string& failure() const;
  /// Number of (uncompressed) bytes taken so far.
  [[nodiscard]] std::uint64_t position() const;
  /// How much of the file was read, 0 to 1.
  [[nodiscard]] double progress() const;
  [[nodiscard]] const std::string& file() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace mrpt_terrain::io
