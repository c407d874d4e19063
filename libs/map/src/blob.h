// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace mrpt_terrain {

/// Plain values one after the other, little-endian as all machines that Debian's MRPT runs on.
class BlobWriter {
 public:
  template <class Value>
  void put(const Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  template <class Value>
  void put_all(const std::vector<Value>& values) {
    static_assert(std::is_trivially_copyable_v<Value>);
    put(static_cast<std::uint64_t>(values.size()));
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
  }
  void put_text(const std::string& text) {
    put(static_cast<std::uint64_t>(text.size()));
    bytes_ += text;
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Reads what a `BlobWriter` wrote. Throws std::runtime_error where the bytes end too early.
class BlobReader {
 public:
  explicit BlobReader(const std::string& bytes) : bytes_(bytes) {}

  template <class Value>
  [[nodiscard]] Value get() {
    static_assert(std::is_trivially_copyable_v<Value>);
    Value value;
    std::memcpy(&value, take(sizeof(value), 1), sizeof(value));
    return value;
  }
  template <class Value>
  void get_all(std::vector<Value>& values) {
    const auto n = get<std::uint64_t>();
    const char* from = take(n, sizeof(Value));
    values.resize(n);
    if (n != 0) std::memcpy(values.data(), from, n * sizeof(Value));
  }
  [[nodiscard]] std::string get_text() {
    const auto n = get<std::uint64_t>();
    const char* from = take(n, 1);
    return {from, n};
  }
  [[nodiscard]] bool at_end() const { return place_ == bytes_.size(); }

 private:
  const char* take(std::uint64_t n, std::size_t size) {
    if (n > (bytes_.size() - place_) / size) throw std::runtime_error("it is cut off");
    const char* from = bytes_.data() + place_;
    place_ += n * size;
    return from;
  }

  const std::string& bytes_;
  std::size_t place_ = 0;
};

}  // namespace mrpt_terrain
