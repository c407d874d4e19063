// SPDX-License-Identifier: BSD-3-Clause
// terrain-rawlog export: the forms of a stored terrain map that other programs read.
#include <stdexcept>
#include <string>

#include "exit_code.h"
#include "input_support.h"
#include "map_settings.h"
#include "map_text.h"
#include "mrpt_terrain/io/observation_reader.h"
#include "mrpt_terrain/io/ply.h"
#include "mrpt_terrain/map/map_file.h"
#include "options.h"
#include "output_place.h"
#include "outputs.h"
#include "scan_reading.h"

namespace {

using namespace mrpt_terrain;

Points points_in_map(const TerrainSnapshot& snapshot) {
  Points points;
  for (std::size_t k = 0; k < snapshot.points.size(); ++k) {
    const Eigen::Vector3f robot(snapshot.points.x[k], snapshot.points.y[k], snapshot.points.z[k]);
    const Eigen::Vector3f p = (snapshot.T_map_robot * robot.cast<double>()).cast<float>();
    points.push_back(p.x(), p.y(), p.z());
  }
  return points;
}

void write_points(const CTerrainMap& map, const std::string& file) {
  const TerrainSnapshotPtr now = map.snapshot();
  io::write_labelled_ply(file, points_in_map(*now).view(), now->description.labels,
                         label_colours());
}

int export_map(const CTerrainMap& map, const ExportOptions& options, Messages& messages) {
  const std::string prefix = map_prefix(options.output);
  check_writable(prefix);
  map.saveMetricMapRepresentationToFile(prefix);
  if (!options.points.empty()) write_points(map, options.points);
  messages.info(map_text(map) + files_text(map, prefix, ""));
  if (!options.points.empty()) messages.info("points of the last scan: " + options.points + "\n");
  return kExitOk;
}

}  // namespace

int run_export(const ExportOptions& options) {
  Messages messages(options.verbosity);
  const auto prepare = [&] {
    MapParams unused;
    change_render_settings(options.settings, unused);
    if (options.output.empty()) throw std::invalid_argument("--output: needs a name");
  };
  return run_command(messages, "map", prepare, [&]() -> int {
    try {
      refuse_pipe(options.input);
      CTerrainMap map = load_map_file(options.input);
      MapParams params = map.params();
      change_render_settings(options.settings, params);
      map.set_render_params(params.render);
      return export_map(map, options, messages);
    } catch (const io::ReadError& error) {
      messages.error(error.what());
      return kExitInput;
    }
  });
}
