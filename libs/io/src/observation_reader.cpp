// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/io/observation_reader.h"

#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>

#include "mrpt_terrain/io/object_stream.h"

namespace mrpt_terrain::io {

std::unique_ptr<ObservationReader> open_observations(const std::string& file) {
  auto stream = std::make_unique<ObjectStream>(file);
  const auto* id = mrpt::rtti::findRegisteredClass(stream->first_class());
  // An unknown class may well be an observation of somebody's own.
  if (id == nullptr) return make_rawlog_reader(std::move(stream));
  if (id->derivedFrom(CLASS_ID(mrpt::maps::CSimpleMap))) {
    return make_simplemap_reader(std::move(stream));
  }
  const bool in_rawlogs = id->derivedFrom(CLASS_ID(mrpt::obs::CObservation)) ||
                          id->derivedFrom(CLASS_ID(mrpt::obs::CActionCollection)) ||
                          id->derivedFrom(CLASS_ID(mrpt::obs::CSensoryFrame)) ||
                          id->derivedFrom(CLASS_ID(mrpt::obs::CRawlog));
  if (in_rawlogs) return make_rawlog_reader(std::move(stream));
  throw ReadError(file + ": is neither a rawlog nor a simple map: it holds a " +
                  stream->first_class());
}

}  // namespace mrpt_terrain::io
