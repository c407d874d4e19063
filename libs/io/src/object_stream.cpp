// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/io/object_stream.h"

#include <mrpt/maps/registerAllClasses.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/obs/registerAllClasses.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <cstring>
#include <optional>

#include "mrpt_terrain/io/byte_stream.h"

namespace mrpt_terrain::io {
namespace {

using mrpt::rtti::TRuntimeClassId;

// How MRPT stores an object: a byte 0x80 | length of the class name, the name, a version byte, the
// data, and a byte that ends it. Before 2008 (old): the length as uint32, the name, the version as
// int32, the data, no end. Null objects have the name "nullptr" and no version.
constexpr std::uint8_t kEndFlag = 0x88;
constexpr std::size_t kMaxName = 120;
constexpr std::size_t kMaxHeader = 4 + kMaxName + 4;
const std::string kNull = "nullptr";

struct Header {
  std::string name;
  bool old = false;
  [[nodiscard]] std::size_t size() const {
    if (old) return 4 + name.size() + 4;
    return 1 + name.size() + (name == kNull ? 0 : 1);
  }
};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

bool is_class_name(const char* name, std::size_t length) {
  if (length < 2 || length > kMaxName || !is_letter(name[0])) return false;
  return std::all_of(name, name + length, [](char c) {
    return is_letter(c) || (c >= '0' && c <= '9') || std::strchr(":<>, *", c) != nullptr;
  });
}

/// Whether a name is like those of MRPT's classes: perhaps namespaces, then `C` and a capital.
bool follows_convention(const std::string& name) {
  const std::size_t colon = name.rfind(':');
  const std::size_t start = colon == std::string::npos ? 0 : colon + 1;
  return name.size() >= start + 4 && name[start] == 'C' && name[start + 1] >= 'A' &&
         name[start + 1] <= 'Z';
}

/// The header that begins at `data`, if one does.
std::optional<Header> parse_header(const std::uint8_t* data, std::size_t available) {
  if (available == 0) return std::nullopt;
  const std::size_t length = data[0] & 0x7Fu;
  const bool old = (data[0] & 0x80u) == 0;
  const std::size_t start = old ? 4 : 1;
  if (start + length > available) return std::nullopt;
  if (old && (data[1] != 0 || data[2] != 0 || data[3] != 0)) return std::nullopt;
  const char* name = reinterpret_cast<const char*>(data) + start;
  if (!is_class_name(name, length)) return std::nullopt;
  Header header{std::string(name, length), old};
  if (header.size() > available) return std::nullopt;
  return header;
}

bool is_a(const TRuntimeClassId* id, const TRuntimeClassId* base) {
  return id != nullptr && id->derivedFrom(base);
}

bool is_observation(const TRuntimeClassId* id) {
  return is_a(id, CLASS_ID(mrpt::obs::CObservation));
}

/// Of the classes that stand in rawlogs only as top-level objects.
bool is_only_top_level(const TRuntimeClassId* id) {
  return is_a(id, CLASS_ID(mrpt::obs::CActionCollection)) ||
         is_a(id, CLASS_ID(mrpt::obs::CSensoryFrame)) ||
         is_a(id, CLASS_ID(mrpt::obs::CObservationComment));
}

void register_classes() {
  static const bool once = [] {
    mrpt::obs::registerAllClasses_mrpt_obs();
    mrpt::maps::registerAllClasses_mrpt_maps();
    return true;
  }();
  static_cast<void>(once);
}

/// No std::exception, so that MRPT does not wrap it into call stacks, which takes 0.1 s.
struct DataEnds {};

/// Feeds MRPT from a ByteStream and remembers what the words of MRPT's exceptions do not tell
/// reliably: whether the bytes ran out, and whether the last thing read was an object header.
class WatchingArchive : public mrpt::serialization::CArchive {
 public:
  explicit WatchingArchive(ByteStream& bytes) : bytes_(bytes) {}

  void restart() {
    ran_out_ = false;
    expect_ = Expect::kLength;
  }
  [[nodiscard]] bool ran_out() const { return ran_out_; }
  /// The header that was just read, if the last reads were one.
  [[nodiscard]] const Header* last_header() const {
    return expect_ == Expect::kNothing ? &header_ : nullptr;
  }
  std::string getArchiveDescription() const override { return bytes_.file(); }

 private:
  enum class Expect { kLength, kZeros, kName, kVersion, kNothing };

  std::size_t read(void* to, std::size_t n) override {
    const std::size_t count = bytes_.read(to, n);
    if (count < n) {
      ran_out_ = true;
      throw DataEnds{};
    }
    watch(static_cast<const std::uint8_t*>(to), n);
    return n;
  }
  std::size_t write(const void*, std::size_t) override { throw std::logic_error("read only"); }

  void watch(const std::uint8_t* data, std::size_t n) {
    if (expect_ == Expect::kZeros && n == 3 && data[0] == 0 && data[1] == 0 && data[2] == 0) {
      expect_ = Expect::kName;
    } else if (expect_ == Expect::kName && n == length_) {
      header_.name.assign(reinterpret_cast<const char*>(data), n);
      expect_ = header_.name == kNull ? Expect::kLength : Expect::kVersion;
    } else if (expect_ == Expect::kVersion && n == (header_.old ? 4u : 1u)) {
      expect_ = Expect::kNothing;
    } else if (n == 1 && (data[0] & 0x7Fu) > 1) {
      length_ = data[0] & 0x7Fu;
      header_.old = (data[0] & 0x80u) == 0;
      expect_ = header_.old ? Expect::kZeros : Expect::kName;
    } else {
      expect_ = Expect::kLength;
    }
  }

  ByteStream& bytes_;
  bool ran_out_ = false;
  Expect expect_ = Expect::kLength;
  std::size_t length_ = 0;
  Header header_;
};

/// The innermost message of an MRPT exception, which wraps it into places and call stacks.
std::string innermost_message(const std::string& what) {
  static const std::string kMark = "Message:";
  const std::size_t mark = what.rfind(kMark);
  std::size_t begin = mark == std::string::npos ? 0 : mark + kMark.size();
  begin = std::min(what.find_first_not_of(' ', begin), what.size());
  return what.substr(begin, what.find('\n', begin) - begin);
}

}  // namespace

struct ObjectStream::Impl {
  explicit Impl(const std::string& file) : bytes(file), archive(bytes) {
    register_classes();
    const std::optional<Header> header = peek_header();
    if (!header) fail_at_start();
    first_class = header->name;
    if (is_a(mrpt::rtti::findRegisteredClass(header->name), CLASS_ID(mrpt::obs::CRawlog))) {
      open_container(*header);
    }
  }

  [[noreturn]] void fail_at_start() {
    const std::uint8_t* data = nullptr;
    const bool nothing = bytes.peek(1, data) == 0;
    if (!bytes.failure().empty()) throw ReadError(bytes.file() + ": " + bytes.failure());
    if (nothing) throw ReadError(bytes.file() + ": is empty (nothing but a gzip header)");
    throw ReadError(
        bytes.file() +
        ": is neither a rawlog nor a simple map: it does not begin with an MRPT object");
  }

  std::optional<Header> peek_header() {
    const std::uint8_t* data = nullptr;
    const std::size_t available = bytes.peek(kMaxHeader, data);
    return parse_header(data, available);
  }

  /// Steps into a stored CRawlog: a count, that many objects, a comment.
  void open_container(const Header& header) {
    bytes.skip(header.size());
    std::uint8_t count[4] = {};
    if (bytes.read(count, sizeof(count)) != sizeof(count)) fail("mrpt::obs::CRawlog", 0, ends());
    container_left = 1;
    for (std::size_t k = 0; k < 4; ++k) container_left += std::uint64_t{count[k]} << (8 * k);
    container_ends = !header.old;
  }

  bool next(StoredObject& result) {
    if (!error.empty()) throw ReadError(error);
    while (true) {
      if (frame_open || container_ends) skip_end_flag();
      const std::optional<Header> header = peek_header();
      if (!header) return end_or_fail();
      if (header->name != kNull && mrpt::rtti::findRegisteredClass(header->name) == nullptr) {
        if (!frame_open) take_entry();
        bytes.skip(header->size());
        step_over(*header, header->size());
        continue;
      }
      if (read_object(*header, result)) return true;
    }
  }

  /// Takes the byte that ends the sensory frame or CRawlog whose objects came one by one.
  void skip_end_flag() {
    const std::uint8_t* data = nullptr;
    if (bytes.peek(1, data) == 0 || data[0] != kEndFlag || peek_header()) return;
    if (frame_open) {
      frame_open = false;
      bytes.skip(1);
      if (container_ends) skip_end_flag();
    } else if (container_left == 0) {
      container_ends = false;
      bytes.skip(1);
    }
  }

  std::size_t take_entry() {
    if (container_left > 0) --container_left;
    return counts.entries++;
  }

  /// Nothing that looks like an object follows: returns false at a proper end, else throws.
  bool end_or_fail() {
    const std::uint8_t* data = nullptr;
    const std::size_t available = bytes.peek(kMaxHeader, data);
    const bool at_end = available == 0 && bytes.failure().empty();
    if (at_end && !frame_open && !container_ends && container_left == 0) return false;
    const bool inside_header = available < kMaxHeader;
    if (inside_header && (available == 0 || may_be_cut_header(data, available))) {
      bytes.skip(available);
      fail("", bytes.position() - available, ends());
    }
    fail("", bytes.position(), "damaged: no object begins here");
  }

  static bool may_be_cut_header(const std::uint8_t* data, std::size_t available) {
    const std::size_t start = (data[0] & 0x80u) != 0 ? 1 : 4;
    return available <= start || available < start + (data[0] & 0x7Fu) + 1;
  }

  /// \return false if it held an unknown class and was stepped over
  bool read_object(const Header& header, StoredObject& result) {
    const TRuntimeClassId* id = mrpt::rtti::findRegisteredClass(header.name);
    frame_open = frame_open && is_observation(id) && !is_only_top_level(id);
    result.entry = frame_open ? counts.entries - 1 : take_entry();
    const std::uint64_t start = bytes.position();
    archive.restart();
    std::string problem;
    try {
      result.object = archive.ReadObject();
      if (!archive.ran_out()) return true;
    } catch (const std::bad_alloc&) {
      problem = "asks for more memory than there is";
    } catch (const DataEnds&) {
      fail(header.name, start, ends());
    } catch (const std::exception& e) {
      problem = innermost_message(e.what());
    }
    if (archive.ran_out()) fail(header.name, start, ends());
    const Header* last = archive.last_header();
    if (last == nullptr || !is_class_name(last->name.data(), last->name.size()) ||
        mrpt::rtti::findRegisteredClass(last->name) != nullptr) {
      fail(header.name, start, "damaged: " + problem);
    }
    frame_open = frame_open || is_a(id, CLASS_ID(mrpt::obs::CSensoryFrame));
    step_over(*last, bytes.position() - start);
    return false;
  }

  /// Counts an object of an unknown class and goes to the next header of a known one.
  /// \param taken bytes of the object that were read so far
  void step_over(const Header& unknown, std::uint64_t taken) {
    ++counts.unknown_classes[unknown.name];
    const std::uint64_t start = bytes.position();
    std::uint8_t last = 0;
    while (true) {
      const std::uint8_t* data = nullptr;
      const std::size_t available = bytes.peek(kMaxHeader, data);
      if (available == 0) break;
      const std::size_t steps = available < kMaxHeader ? available : available - kMaxHeader + 1;
      std::size_t k = 0;
      while (k < steps && !can_resume(data + k, available - k, unknown.old, last)) last = data[k++];
      bytes.skip(k);
      if (k < steps) break;
    }
    counts.skipped_bytes += taken + (bytes.position() - start);
    const std::uint8_t* data = nullptr;
    if (bytes.peek(1, data) > 0) return;
    // Whether the file ends with this object or inside of it, only its last byte can tell.
    const bool whole = bytes.failure().empty() && (unknown.old || last == kEndFlag);
    if (!whole) fail(unknown.name + ", a class unknown here", start - taken, ends());
    frame_open = container_ends = false;
    container_left = 0;
  }

  /// Old headers look like any stored string, so they count only behind objects of that format;
  /// headers of unknown classes count only behind the end of an object.
  static bool can_resume(const std::uint8_t* data, std::size_t available, bool old,
                         std::uint8_t before) {
    if ((data[0] & 0x80u) == 0 && !old) return false;
    const std::optional<Header> header = parse_header(data, available);
    if (!header) return false;
    const TRuntimeClassId* id = mrpt::rtti::findRegisteredClass(header->name);
    if (id == nullptr)
      return before == kEndFlag && !header->old && follows_convention(header->name);
    return is_observation(id) || is_only_top_level(id);
  }

  std::string ends() {
    if (!bytes.failure().empty()) return bytes.failure();
    return "the file ends inside of an object (cut off or damaged)";
  }

  [[noreturn]] void fail(const std::string& class_name, std::uint64_t start,
                         const std::string& problem) {
    const std::size_t entry = class_name.empty() ? counts.entries : counts.entries - 1;
    error = bytes.file() + ": entry " + std::to_string(entry) +
            (class_name.empty() ? std::string() : " (" + class_name + ")") + " at byte " +
            std::to_string(start) + ", read up to byte " + std::to_string(bytes.position()) + ": " +
            problem;
    throw ReadError(error);
  }

  ByteStream bytes;
  WatchingArchive archive;
  ReadSummary counts;
  std::string first_class, error;
  bool frame_open = false;           // objects of a sensory frame come one by one
  bool container_ends = false;       // an end flag of a CRawlog is to come
  std::uint64_t container_left = 0;  // objects to come of a CRawlog
};

ObjectStream::ObjectStream(const std::string& file) : impl_(std::make_unique<Impl>(file)) {}
ObjectStream::~ObjectStream() = default;
const std::string& ObjectStream::file() const { return impl_->bytes.file(); }
const std::string& ObjectStream::first_class() const { return impl_->first_class; }
bool ObjectStream::next(StoredObject& result) { return impl_->next(result); }
const ReadSummary& ObjectStream::summary() const { return impl_->counts; }
double ObjectStream::progress() const { return impl_->bytes.progress(); }

}  // namespace mrpt_terrain::io
