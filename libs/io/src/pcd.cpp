// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/io/pcd.h"

#include <algorithm>
#include <optional>

#include "file_bytes.h"

namespace mrpt_terrain::io {
namespace {

struct Field {
  std::string name;
  ScalarType type;
  std::size_t count = 1;   // of elements
  std::size_t offset = 0;  // in bytes, within a point
  std::size_t column = 0;  // of words, within a line
};

struct PcdHeader {
  std::vector<Field> fields;
  std::size_t points = 0;
  std::size_t point_size = 0;  // bytes
  std::size_t columns = 0;     // words of a line
  std::string data;            // ascii, binary, binary_compressed
  std::size_t data_begin = 0;  // byte in the file
  std::size_t lines = 0;       // of the header

  [[nodiscard]] const Field* find(const std::string& name) const {
    const auto found = std::find_if(fields.begin(), fields.end(),
                                    [&](const Field& field) { return field.name == name; });
    return found == fields.end() ? nullptr : &*found;
  }
};

/// Reads the header lines of a PCD file.
class HeaderParser {
 public:
  HeaderParser(const std::string& file, std::string_view text) : file_(file), cursor_(text) {}

  PcdHeader parse() {
    std::string_view line;
    while (header_.data.empty()) {
      if (!cursor_.next_line(line))
        fail("the header ends without a DATA line; is this a PCD file?");
      if (line.substr(0, line.find('#')).find_first_not_of(" \t") == std::string_view::npos)
        continue;
      const std::string key(take_word(line));
      take_line(key, line);
    }
    header_.data_begin = cursor_.position();
    header_.lines = cursor_.line();
    finish();
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    fail_at_line(file_, cursor_.line(), what);
  }

  void take_line(const std::string& key, std::string_view line) {
    if (key == "FIELDS" || key == "COLUMNS") {
      while (!line.empty()) {
        const std::string_view name = take_word(line);
        if (!name.empty()) header_.fields.push_back({std::string(name), {}, 1, 0, 0});
      }
    } else if (key == "SIZE") {
      per_field(line, [&](Field& field, std::string_view word) {
        return parse_number(word, field.type.size) && field.type.size <= 8;
      });
    } else if (key == "TYPE") {
      per_field(line, [](Field& field, std::string_view word) { return take_type(field, word); });
    } else if (key == "COUNT") {
      per_field(line, [](Field& field, std::string_view word) {
        return parse_number(word, field.count) && field.count < 100000;
      });
    } else if (key == "WIDTH") {
      width_ = number(line);
    } else if (key == "HEIGHT") {
      height_ = number(line);
    } else if (key == "POINTS") {
      points_ = number(line);
    } else if (key == "DATA") {
      header_.data = take_word(line);
    } else if (key != "VERSION" && key != "VIEWPOINT") {
      fail("'" + key.substr(0, 40) + "' is no header line of a PCD file");
    }
  }

  static bool take_type(Field& field, std::string_view word) {
    using Kind = ScalarType::Kind;
    if (word != "F" && word != "U" && word != "I") return false;
    field.type.kind = word == "F" ? Kind::kFloat : word == "U" ? Kind::kUnsigned : Kind::kSigned;
    return true;
  }

  template <class Take>
  void per_field(std::string_view line, const Take& take) {
    for (Field& field : header_.fields) {
      const std::string_view word = take_word(line);
      if (!take(field, word)) {
        fail("'" + std::string(word) + "' is no valid value for the field " + field.name);
      }
    }
  }

  std::size_t number(std::string_view line) const {
    std::size_t value = 0;
    const std::string_view word = take_word(line);
    if (!parse_number(word, value)) fail("'" + std::string(word) + "' is no whole number");
    return value;
  }

  void finish() {
    if (points_ && width_ && height_ && *points_ != *width_ * *height_) {
      fail("POINTS " + std::to_string(*points_) + " is not WIDTH * HEIGHT");
    }
    if (!points_ && !width_) fail("the header says neither POINTS nor WIDTH");
    header_.points = points_ ? *points_ : *width_ * height_.value_or(1);
    for (Field& field : header_.fields) {
      const std::size_t size = field.type.size;
      const bool is_float = field.type.kind == ScalarType::Kind::kFloat;
      const bool valid = size == 4 || size == 8 || (!is_float && (size == 1 || size == 2));
      if (!valid) fail("the field " + field.name + " has the size " + std::to_string(size));
      field.offset = header_.point_size;
      field.column = header_.columns;
      header_.point_size += size * field.count;
      header_.columns += field.count;
    }
    for (const char* name : {"x", "y", "z"}) {
      const Field* field = header_.find(name);
      if (field == nullptr || field->count < 1) fail(std::string("there is no field ") + name);
    }
  }

  const std::string& file_;
  TextCursor cursor_;
  PcdHeader header_;
  std::optional<std::size_t> width_, height_, points_;
};

/// Puts the fields of interest into the cloud, whatever the values come from.
class CloudFiller {
 public:
  explicit CloudFiller(const PcdHeader& header)
      : fields{header.find("x"), header.find("y"), header.find("z"), header.find("intensity"),
               header.find("label")} {}

  /// \param value gives the value of a field of the current point
  template <class Value>
  void add(const Value& value, FileCloud& cloud) const {
    cloud.points.push_back(static_cast<float>(value(*fields[0])),
                           static_cast<float>(value(*fields[1])),
                           static_cast<float>(value(*fields[2])));
    if (has(3)) cloud.intensity.push_back(static_cast<float>(value(*fields[3])));
    if (has(4)) cloud.labels.push_back(to_label(value(*fields[4])));
  }

 private:
  [[nodiscard]] bool has(std::size_t k) const {
    return fields[k] != nullptr && fields[k]->count > 0;
  }
  const Field* fields[5];
};

FileCloud read_ascii(const std::string& file, const PcdHeader& header, std::string_view text) {
  FileCloud cloud;
  const CloudFiller filler(header);
  TextCursor cursor(text.substr(header.data_begin));
  std::vector<double> row(header.columns);
  std::string_view line;
  while (cloud.points.size() < header.points) {
    if (!cursor.next_line(line)) {
      fail_at_line(file, header.lines + cursor.line() + 1,
                   "the file ends after " + std::to_string(cloud.points.size()) + " of " +
                       std::to_string(header.points) + " points");
    }
    if (line.find_first_not_of(" \t") == std::string_view::npos) continue;
    for (double& value : row) {
      const std::string_view word = take_word(line);
      if (!parse_number(word, value)) {
        fail_at_line(file, header.lines + cursor.line(),
                     word.empty() ? "too few numbers" : "'" + std::string(word) + "' is no number");
      }
    }
    filler.add([&](const Field& field) { return row[field.column]; }, cloud);
  }
  return cloud;
}

FileCloud read_binary(const std::string& file, const PcdHeader& header,
                      const std::vector<std::uint8_t>& bytes) {
  const std::size_t have = bytes.size() - header.data_begin;
  if (have / header.point_size < header.points) {
    fail_at_byte(file, bytes.size(),
                 "the file ends after " + std::to_string(have / header.point_size) + " of " +
                     std::to_string(header.points) + " points");
  }
  FileCloud cloud;
  const CloudFiller filler(header);
  const std::uint8_t* point = bytes.data() + header.data_begin;
  for (std::size_t k = 0; k < header.points; ++k, point += header.point_size) {
    filler.add([&](const Field& field) { return load_scalar(point + field.offset, field.type); },
               cloud);
  }
  return cloud;
}

/// Compressed data: two uint32 sizes, then LZF over all values of the first field, then all of the
/// second, and so on.
FileCloud read_compressed(const std::string& file, const PcdHeader& header,
                          const std::vector<std::uint8_t>& bytes) {
  const std::uint8_t* data = bytes.data() + header.data_begin;
  const std::size_t have = bytes.size() - header.data_begin;
  const ScalarType size_type{ScalarType::Kind::kUnsigned, 4};
  if (have < 8) fail_at_byte(file, bytes.size(), "the file ends before the compressed data");
  const auto packed = static_cast<std::size_t>(load_scalar(data, size_type));
  const auto size = static_cast<std::size_t>(load_scalar(data + 4, size_type));
  if (have - 8 < packed) {
    fail_at_byte(file, bytes.size(), "the file ends within the compressed data");
  }
  if (size % header.point_size != 0 || size / header.point_size != header.points) {
    fail_at_byte(file, header.data_begin + 4, "the size does not fit the number of points");
  }
  const std::vector<std::uint8_t> plain = decompress_lzf(data + 8, packed, size);
  if (plain.size() != size) {
    fail_at_byte(file, header.data_begin + 8, "the compressed data is damaged");
  }
  FileCloud cloud;
  const CloudFiller filler(header);
  for (std::size_t k = 0; k < header.points; ++k) {
    filler.add(
        [&](const Field& field) {
          const std::size_t stride = field.type.size * field.count;
          return load_scalar(plain.data() + field.offset * header.points + k * stride, field.type);
        },
        cloud);
  }
  return cloud;
}

}  // namespace

std::vector<std::uint8_t> decompress_lzf(const std::uint8_t* data, std::size_t length,
                                         std::size_t size) {
  std::vector<std::uint8_t> plain;
  // No compression can be better than this: a damaged size must not take all memory.
  if (size / 132 > length) return {};
  plain.reserve(size);
  for (std::size_t k = 0; k < length;) {
    const std::size_t control = data[k++];
    if (control < 32) {
      if (control + 1 > length - k || control + 1 > size - plain.size()) return {};
      plain.insert(plain.end(), data + k, data + k + control + 1);
      k += control + 1;
      continue;
    }
    std::size_t count = control >> 5;
    if (count == 7 && k < length) count += data[k++];
    count += 2;
    if (k >= length) return {};
    const std::size_t back = ((control & 31u) << 8) + data[k++] + 1;
    if (back > plain.size() || count > size - plain.size()) return {};
    // The copy may overlap what it writes, so byte by byte.
    for (std::size_t n = 0; n < count; ++n) plain.push_back(plain[plain.size() - back]);
  }
  return plain;
}

FileCloud read_pcd(const std::string& file) {
  const std::vector<std::uint8_t> bytes = read_bytes(file);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const PcdHeader header = HeaderParser(file, text).parse();
  if (header.data == "ascii") return read_ascii(file, header, text);
  if (header.data == "binary") return read_binary(file, header, bytes);
  if (header.data == "binary_compressed") return read_compressed(file, header, bytes);
  fail_at_line(file, header.lines, "DATA '" + header.data + "' is no known encoding");
}

}  // namespace mrpt_terrain::io
