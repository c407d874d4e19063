// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/io/ply.h"

#include <algorithm>
#include <cassert>
#include <optional>

#include "file_bytes.h"
#include "mrpt_terrain/files/whole_file.h"

namespace mrpt_terrain::io {
namespace {

/// What a property of a vertex is for.
enum class Role : std::uint8_t { kOther, kX, kY, kZ, kIntensity, kLabel };
constexpr std::size_t kRoles = 6;

struct Property {
  Role role = Role::kOther;
  ScalarType type;
  std::optional<ScalarType> list_count;  ///< type of the number of entries, for lists
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

enum class Encoding : std::uint8_t { kAscii, kLittleEndian, kBigEndian };

struct PlyHeader {
  Encoding encoding = Encoding::kAscii;
  std::vector<Element> elements;
  std::size_t data_begin = 0;  // byte in the file
  std::size_t lines = 0;       // of the header
};

Role role_of(std::string_view name) {
  if (name == "x") return Role::kX;
  if (name == "y") return Role::kY;
  if (name == "z") return Role::kZ;
  if (name == "intensity" || name == "scalar_Intensity" || name == "scalar_intensity") {
    return Role::kIntensity;
  }
  if (name == "label" || name == "scalar_Label" || name == "scalar_label") return Role::kLabel;
  return Role::kOther;
}

/// Reads the header lines of a PLY file.
class HeaderParser {
 public:
  HeaderParser(const std::string& file, std::string_view text) : file_(file), cursor_(text) {}

  PlyHeader parse() {
    std::string_view line;
    if (!cursor_.next_line(line) || line != "ply") {
      fail("is no PLY file: the first line is not 'ply'");
    }
    while (true) {
      if (!cursor_.next_line(line)) fail("the header ends without 'end_header'");
      const std::string_view key = take_word(line);
      if (key == "end_header") break;
      if (key == "format") {
        take_format(take_word(line));
      } else if (key == "element") {
        take_element(line);
      } else if (key == "property") {
        take_property(line);
      } else if (key != "comment" && key != "obj_info" && !key.empty()) {
        fail("'" + std::string(key.substr(0, 40)) + "' is no header line of a PLY file");
      }
    }
    if (!has_format_) fail("the header has no 'format' line");
    header_.data_begin = cursor_.position();
    header_.lines = cursor_.line();
    check_vertex();
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    fail_at_line(file_, cursor_.line(), what);
  }

  void take_format(std::string_view name) {
    has_format_ = true;
    if (name == "ascii") {
      header_.encoding = Encoding::kAscii;
    } else if (name == "binary_little_endian") {
      header_.encoding = Encoding::kLittleEndian;
    } else if (name == "binary_big_endian") {
      header_.encoding = Encoding::kBigEndian;
    } else {
      fail("'" + std::string(name) + "' is no known format");
    }
  }

  void take_element(std::string_view line) {
    Element element;
    element.name = take_word(line);
    if (!parse_number(take_word(line), element.count)) {
      fail("the element " + element.name + " has no valid count");
    }
    header_.elements.push_back(std::move(element));
  }

  void take_property(std::string_view line) {
    if (header_.elements.empty()) fail("a property before the first element");
    Property property;
    std::string_view word = take_word(line);
    if (word == "list") {
      property.list_count = type_of(take_word(line));
      word = take_word(line);
    }
    property.type = type_of(word);
    const std::string_view name = take_word(line);
    if (!property.list_count) property.role = role_of(name);
    header_.elements.back().properties.push_back(property);
  }

  [[nodiscard]] ScalarType type_of(std::string_view name) const {
    using Kind = ScalarType::Kind;
    if (name == "char" || name == "int8") return {Kind::kSigned, 1};
    if (name == "uchar" || name == "uint8") return {Kind::kUnsigned, 1};
    if (name == "short" || name == "int16") return {Kind::kSigned, 2};
    if (name == "ushort" || name == "uint16") return {Kind::kUnsigned, 2};
    if (name == "int" || name == "int32") return {Kind::kSigned, 4};
    if (name == "uint" || name == "uint32") return {Kind::kUnsigned, 4};
    if (name == "float" || name == "float32") return {Kind::kFloat, 4};
    if (name == "double" || name == "float64") return {Kind::kFloat, 8};
    fail("'" + std::string(name) + "' is no type of a PLY file");
  }

  void check_vertex() const {
    for (const Element& element : header_.elements) {
      if (element.name != "vertex") continue;
      for (const Role role : {Role::kX, Role::kY, Role::kZ}) {
        const auto& all = element.properties;
        if (std::none_of(all.begin(), all.end(), [&](auto& p) { return p.role == role; })) {
          fail(std::string("the vertices have no property ") + "?xyz"[static_cast<int>(role)]);
        }
      }
      return;
    }
    fail("there is no element 'vertex'");
  }

  const std::string& file_;
  TextCursor cursor_;
  PlyHeader header_;
  bool has_format_ = false;
};

/// Numbers of an ascii body: one element a line.
class AsciiBody {
 public:
  AsciiBody(const std::string& file, const PlyHeader& header, std::string_view text)
      : file_(file), header_lines_(header.lines), cursor_(text.substr(header.data_begin)) {}

  void begin_element(const std::string& name) {
    do {
      if (!cursor_.next_line(line_)) fail("the file ends within the elements '" + name + "'");
    } while (line_.find_first_not_of(" \t") == std::string_view::npos);
  }
  double next(ScalarType /*type*/) {
    const std::string_view word = take_word(line_);
    double value = 0.0;
    if (word.empty()) fail("too few numbers");
    if (!parse_number(word, value)) fail("'" + std::string(word) + "' is no number");
    return value;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    fail_at_line(file_, header_lines_ + cursor_.line(), what);
  }
  const std::string& file_;
  std::size_t header_lines_;
  TextCursor cursor_;
  std::string_view line_;
};

/// Numbers of a binary body.
class BinaryBody {
 public:
  BinaryBody(const std::string& file, const PlyHeader& header,
             const std::vector<std::uint8_t>& bytes)
      : file_(file),
        bytes_(bytes),
        position_(header.data_begin),
        swapped_(header.encoding == Encoding::kBigEndian) {}

  void begin_element(const std::string& name) { element_ = &name; }
  double next(ScalarType type) {
    if (bytes_.size() - position_ < type.size) {
      fail_at_byte(file_, bytes_.size(), "the file ends within the elements '" + *element_ + "'");
    }
    const double value = load_scalar(bytes_.data() + position_, type, swapped_);
    position_ += type.size;
    return value;
  }

 private:
  const std::string& file_;
  const std::vector<std::uint8_t>& bytes_;
  std::size_t position_;
  bool swapped_;
  const std::string* element_ = nullptr;
};

template <class Body>
void read_element(const Element& element, Body& body, double* values) {
  body.begin_element(element.name);
  for (const Property& property : element.properties) {
    if (property.list_count) {
      const double entries = body.next(*property.list_count);
      for (double k = 0; k < entries; ++k) body.next(property.type);
    } else {
      values[static_cast<std::size_t>(property.role)] = body.next(property.type);
    }
  }
}

bool has(const Element& element, Role role) {
  return std::any_of(element.properties.begin(), element.properties.end(),
                     [&](const Property& property) { return property.role == role; });
}

template <class Body>
FileCloud read_body(const PlyHeader& header, Body body) {
  FileCloud cloud;
  for (const Element& element : header.elements) {
    const bool is_vertex = element.name == "vertex";
    const bool has_intensity = has(element, Role::kIntensity);
    const bool has_label = has(element, Role::kLabel);
    double values[kRoles] = {};
    for (std::size_t k = 0; k < element.count && !element.properties.empty(); ++k) {
      read_element(element, body, values);
      if (!is_vertex) continue;
      const auto value = [&](Role role) { return values[static_cast<std::size_t>(role)]; };
      cloud.points.push_back(static_cast<float>(value(Role::kX)),
                             static_cast<float>(value(Role::kY)),
                             static_cast<float>(value(Role::kZ)));
      if (has_intensity) cloud.intensity.push_back(static_cast<float>(value(Role::kIntensity)));
      if (has_label) cloud.labels.push_back(to_label(value(Role::kLabel)));
    }
    if (is_vertex) break;  // what follows are faces and the like
  }
  return cloud;
}

template <class T>
void append(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

std::string labelled_header(std::size_t points) {
  return "ply\nformat binary_little_endian 1.0\n"
         "comment support: 0 unknown, 1 ground, 2 above, 3 below\n"
         "comment class: 0 none, 1 slope, 2 pothole, 3 obstacle, 4 other\n"
         "comment cluster: -1 none\n"
         "element vertex " +
         std::to_string(points) +
         "\nproperty float x\nproperty float y\nproperty float z\n"
         "property uchar support\nproperty uchar class\nproperty int cluster\n"
         "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n";
}

}  // namespace

FileCloud read_ply(const std::string& file) {
  const std::vector<std::uint8_t> bytes = read_bytes(file);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const PlyHeader header = HeaderParser(file, text).parse();
  if (header.encoding == Encoding::kAscii) return read_body(header, AsciiBody(file, header, text));
  return read_body(header, BinaryBody(file, header, bytes));
}

void write_labelled_ply(const std::string& file, PointsView points, const PointLabels& labels,
                        const PointPalette& palette) {
  assert(labels.support.size() == points.size && labels.terrain_class.size() == points.size &&
         labels.cluster.size() == points.size);
  std::string bytes = labelled_header(points.size);
  constexpr std::size_t kPointBytes = 21;
  bytes.reserve(bytes.size() + kPointBytes * points.size);
  for (std::size_t k = 0; k < points.size; ++k) {
    append(bytes, points.x[k]);
    append(bytes, points.y[k]);
    append(bytes, points.z[k]);
    append(bytes, static_cast<std::uint8_t>(labels.support[k]));
    append(bytes, static_cast<std::uint8_t>(labels.terrain_class[k]));
    append(bytes, labels.cluster[k]);
    const PointColor color = palette(labels.support[k], labels.terrain_class[k]);
    append(bytes, color.red);
    append(bytes, color.green);
    append(bytes, color.blue);
  }
  files::WholeFile whole(file);
  whole.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  whole.commit();
}

}  // namespace mrpt_terrain::io
