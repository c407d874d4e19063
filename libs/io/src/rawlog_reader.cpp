// SPDX-License-Identifier: BSD-3-Clause
#include <mrpt/obs/CSensoryFrame.h>

#include <deque>

#include "mrpt_terrain/io/object_stream.h"

namespace mrpt_terrain::io {
namespace {

class RawlogReader : public ObservationReader {
 public:
  explicit RawlogReader(std::unique_ptr<ObjectStream> stream) : stream_(std::move(stream)) {}

  bool next(ReadObservation& result) override {
    while (waiting_.empty()) {
      StoredObject stored;
      const bool more = read(stored);
      if (!more) return false;
      take(stored);
    }
    result.observation = std::move(waiting_.front());
    result.entry = entry_;
    result.T_map_robot.reset();
    waiting_.pop_front();
    ++summary_.observations[result.observation->GetRuntimeClass()->className];
    return true;
  }
  [[nodiscard]] const ReadSummary& summary() const override { return summary_; }
  [[nodiscard]] double progress() const override { return stream_->progress(); }

 private:
  bool read(StoredObject& stored) {
    struct KeepCounts {
      RawlogReader& reader;
      ~KeepCounts() { reader.copy_counts(); }
    } keep{*this};
    return stream_->next(stored);
  }

  void copy_counts() {
    const ReadSummary& counts = stream_->summary();
    summary_.entries = counts.entries;
    summary_.skipped_bytes = counts.skipped_bytes;
    if (summary_.unknown_classes != counts.unknown_classes) {
      summary_.unknown_classes = counts.unknown_classes;
    }
  }

  void take(const StoredObject& stored) {
    entry_ = stored.entry;
    if (const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(stored.object)) {
      for (const auto& observation : *frame) {
        if (observation) waiting_.push_back(observation);
      }
    } else if (auto single = std::dynamic_pointer_cast<mrpt::obs::CObservation>(stored.object)) {
      waiting_.push_back(std::move(single));
    }
  }

  std::unique_ptr<ObjectStream> stream_;
  ReadSummary summary_;
  std::size_t entry_ = 0;
  std::deque<mrpt::obs::CObservation::Ptr> waiting_;
};

}  // namespace

std::unique_ptr<ObservationReader> make_rawlog_reader(std::unique_ptr<ObjectStream> stream) {
  return std::make_unique<RawlogReader>(std::move(stream));
}

}  // namespace mrpt_terrain::io
