// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/serialization/CSerializable.h>

#include <cstddef>
#include <memory>
#include <string>

#include "mrpt_terrain/io/observation_reader.h"

namespace mrpt_terrain::io {

/// One object of a rawlog: an action collection, a sensory frame or an observation.
struct StoredObject {
  mrpt::serialization::CSerializable::Ptr object;  ///< may be null
  /// Index of the top-level object. The observations of a sensory frame that could not be read as
  /// a whole (it held an unknown class) come one by one, all with the index of the frame.
  std::size_t entry = 0;
};

/// Streams the MRPT objects of a file, also those inside one stored mrpt::obs::CRawlog.
///
/// MRPT stores no lengths, so an object of an unknown class cannot be stepped over: the stream
/// then looks for the next header of an observation, sensory frame or action collection.
class ObjectStream {
 public:
  /// Throws ReadError if the file is missing, a folder, empty, or does not begin with an object.
  explicit ObjectStream(const std::string& file);
  ~ObjectStream();

  [[nodiscard]] const std::string& file() const;
  /// Class name of the first object as it stands in the file.
  [[nodiscard]] const std::string& first_class() const;
  /// Next object. False at the proper end of the file. Throws ReadError where the file is cut off
  /// or damaged, and again at every later call.
  bool next(StoredObject& result);
  /// Entries, unknown classes and skipped bytes so far; `observations` stays empty.
  [[nodiscard]] const ReadSummary& summary() const;
  /// How much of the file was read, 0 to 1.
  [[nodiscard]] double progress() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The two kinds of readers behind `open_observations`; `stream` stands at the first object.
[[nodiscard]] std::unique_ptr<ObservationReader> make_rawlog_reader(
    std::unique_ptr<ObjectStream> stream);
[[nodiscard]] std::unique_ptr<ObservationReader> make_simplemap_reader(
    std::unique_ptr<ObjectStream> stream);

}  // namespace mrpt_terrain::io
