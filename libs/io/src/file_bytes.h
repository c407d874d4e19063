// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "mrpt_terrain/io/byte_stream.h"
#include "mrpt_terrain/io/observation_reader.h"

namespace mrpt_terrain::io {

/// Whole content of a file. Throws ReadError.
inline std::vector<std::uint8_t> read_bytes(const std::string& file,
                                            Compression compression = Compression::kByContent) {
  ByteStream stream(file, compression);
  std::vector<std::uint8_t> bytes;
  const std::uint8_t* data = nullptr;
  while (const std::size_t count = stream.peek(1, data)) {
    bytes.insert(bytes.end(), data, data + count);
    stream.skip(count);
  }
  if (!stream.failure().empty()) throw ReadError(file + ": " + stream.failure());
  return bytes;
}

/// Walks through the lines and words of a text, counting lines.
class TextCursor {
 public:
  explicit TextCursor(std::string_view text) : text_(text) {}

  /// Next line without its end; false after the last one.
  bool next_line(std::string_view& line) {
    if (position_ >= text_.size()) return false;
    std::size_t end = text_.find('\n', position_);
    if (end == std::string_view::npos) end = text_.size();
    line = text_.substr(position_, end - position_);
    position_ = end + 1;
    ++line_;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return true;
  }
  [[nodiscard]] std::size_t line() const { return line_; }  ///< of the last line, from 1
  /// Where the next line begins.
  [[nodiscard]] std::size_t position() const {
    return position_ < text_.size() ? position_ : text_.size();
  }

 private:
  std::string_view text_;
  std::size_t position_ = 0, line_ = 0;
};

/// Next word of a line, removed from it; empty at its end.
inline std::string_view take_word(std::string_view& line) {
  const std::size_t begin = line.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return line = {};
  std::size_t end = line.find_first_of(" \t", begin);
  if (end == std::string_view::npos) end = line.size();
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

/// The number that a word is (also nan, inf); false if it is none.
inline bool parse_number(std::string_view word, double& value) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size() && !word.empty();
}
inline bool parse_number(std::string_view word, std::size_t& value) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size() && !word.empty();
}

[[noreturn]] inline void fail_at_line(const std::string& file, std::size_t line,
                                      const std::string& what) {
  throw ReadError(file + ":" + std::to_string(line) + ": " + what);
}
[[noreturn]] inline void fail_at_byte(const std::string& file, std::size_t byte,
                                      const std::string& what) {
  throw ReadError(file + ": byte " + std::to_string(byte) + ": " + what);
}

/// Type of a stored number: its kind and its size in bytes.
struct ScalarType {
  enum class Kind : std::uint8_t { kSigned, kUnsigned, kFloat };
  Kind kind = Kind::kFloat;
  std::size_t size = 0;  ///< 1, 2, 4 or 8; for floats 4 or 8
};

namespace detail {
template <class T>
double load(const std::uint8_t* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return static_cast<double>(value);
}
}  // namespace detail

/// Value of a stored number in the byte order of this machine, or of the other one if `swapped`.
inline double load_scalar(const std::uint8_t* bytes, ScalarType type, bool swapped = false) {
  std::uint8_t ordered[8] = {};
  for (std::size_t k = 0; k < type.size; ++k) {
    ordered[k] = bytes[swapped ? type.size - 1 - k : k];
  }
  const bool is_signed = type.kind == ScalarType::Kind::kSigned;
  if (type.kind == ScalarType::Kind::kFloat) {
    return type.size == 4 ? detail::load<float>(ordered) : detail::load<double>(ordered);
  }
  switch (type.size) {
    case 1:
      return is_signed ? detail::load<std::int8_t>(ordered) : detail::load<std::uint8_t>(ordered);
    case 2:
      return is_signed ? detail::load<std::int16_t>(ordered) : detail::load<std::uint16_t>(ordered);
    case 4:
      return is_signed ? detail::load<std::int32_t>(ordered) : detail::load<std::uint32_t>(ordered);
    default:
      return is_signed ? detail::load<std::int64_t>(ordered) : detail::load<std::uint64_t>(ordered);
  }
}

/// A number as a label; what is no whole number in range is 0, unlabelled.
inline std::uint32_t to_label(double value) {
  const bool fits = value >= 0.0 && value <= std::numeric_limits<std::uint32_t>::max();
  return fits ? static_cast<std::uint32_t>(value) : 0u;
}

}  // namespace mrpt_terrain::io
