// SPDX-License-Identifier: BSD-3-Clause
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDF.h>

#include "mrpt_terrain/io/object_stream.h"

namespace mrpt_terrain::io {
namespace {

/// A simple map is one object, so it is read whole.
class SimpleMapReader : public ObservationReader {
 public:
  explicit SimpleMapReader(ObjectStream& stream) {
    StoredObject stored;
    if (stream.next(stored))
      map_ = std::dynamic_pointer_cast<mrpt::maps::CSimpleMap>(stored.object);
    if (!map_) {
      std::string classes;
      for (const auto& [name, count] : stream.summary().unknown_classes) classes += " " + name;
      throw ReadError(stream.file() +
                      ": the simple map holds objects of classes unknown here:" + classes);
    }
    // A gzip file shows only at its end whether it is sound.
    stream.next(stored);
  }

  bool next(ReadObservation& result) override {
    while (keyframe_ < map_->size()) {
      const auto& [pose, frame] = map_->get(keyframe_);
      if (frame && within_ < frame->size()) {
        result.observation = frame->getObservationByIndex(within_++);
        if (!result.observation) continue;
        result.entry = keyframe_;
        if (pose) result.T_map_robot = pose->getMeanVal();
        summary_.entries = keyframe_ + 1;
        ++summary_.observations[result.observation->GetRuntimeClass()->className];
        return true;
      }
      ++keyframe_;
      within_ = 0;
    }
    summary_.entries = map_->size();
    return false;
  }
  [[nodiscard]] const ReadSummary& summary() const override { return summary_; }
  [[nodiscard]] double progress() const override {
    if (map_->empty()) return 1.0;
    return static_cast<double>(keyframe_) / static_cast<double>(map_->size());
  }

 private:
  mrpt::maps::CSimpleMap::Ptr map_;
  std::size_t keyframe_ = 0, within_ = 0;
  ReadSummary summary_;
};

}  // namespace

std::unique_ptr<ObservationReader> make_simplemap_reader(std::unique_ptr<ObjectStream> stream) {
  return std::make_unique<SimpleMapReader>(*stream);
}

}  // namespace mrpt_terrain::io
