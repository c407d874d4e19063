// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/io/rawlog_writer.h"

#include <mrpt/serialization/CArchive.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "mrpt_terrain/files/whole_file.h"

namespace mrpt_terrain::io {
namespace {

/// MRPT's own gzip stream does not tell when the last block could not be written.
class GzipArchive : public mrpt::serialization::CArchive {
 public:
  GzipArchive(const std::string& path, std::string name) : name_(std::move(name)) {
    errno = 0;
    // Fast: coordinates as float hardly shrink further at higher levels.
    gz_ = gzopen(path.c_str(), "wb2");
    if (gz_ == nullptr) fail();
  }
  ~GzipArchive() override {
    if (gz_ != nullptr) gzclose(gz_);
  }

  void close() {
    errno = 0;
    if (gzclose(std::exchange(gz_, nullptr)) != Z_OK) fail();
  }
  [[nodiscard]] bool failed() const { return failed_; }
  [[noreturn]] void fail() const {
    throw std::runtime_error(name_ + ": cannot be written: " + std::strerror(errno));
  }

 private:
  std::size_t read(void*, std::size_t) override { throw std::logic_error("write only"); }
  std::size_t write(const void* from, std::size_t n) override {
    constexpr std::size_t kMost = std::size_t{1} << 30;  // zlib counts in unsigned int
    std::size_t done = 0;
    while (done < n && !failed_) {
      const auto count = static_cast<unsigned>(std::min(n - done, kMost));
      const int written = gzwrite(gz_, static_cast<const char*>(from) + done, count);
      failed_ = written <= 0;
      if (!failed_) done += static_cast<std::size_t>(written);
    }
    return done;
  }

  std::string name_;
  gzFile gz_ = nullptr;
  bool failed_ = false;
};

}  // namespace

struct RawlogWriter::Impl {
  explicit Impl(const std::string& file) : whole(file), archive(whole.part(), file) {}
  files::WholeFile whole;
  GzipArchive archive;
};

RawlogWriter::RawlogWriter(const std::string& file) : impl_(std::make_unique<Impl>(file)) {}
RawlogWriter::~RawlogWriter() = default;

void RawlogWriter::write(const mrpt::serialization::CSerializable& object) {
  try {
    impl_->archive.WriteObject(object);
  } catch (const std::exception&) {
    if (impl_->archive.failed()) impl_->archive.fail();
    throw;
  }
}

void RawlogWriter::commit() {
  impl_->archive.close();
  impl_->whole.commit();
}

}  // namespace mrpt_terrain::io
