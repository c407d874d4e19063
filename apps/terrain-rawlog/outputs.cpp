// SPDX-License-Identifier: BSD-3-Clause
#include "outputs.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <stdexcept>

#include "mrpt_terrain/files/atomic_file.h"
#include "mrpt_terrain/params/ini.h"
#include "mrpt_terrain/view/csv.h"
#include "mrpt_terrain/view/palette.h"
#include "mrpt_terrain/view/scene.h"
#include "mrpt_terrain/view/top_view.h"
#include "output_place.h"

namespace {

using namespace mrpt_terrain;

std::string scan_name(std::size_t index) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "scan_%06zu", index);
  return name.data();
}

}  // namespace

io::PointPalette label_colours() {
  return [](Support support, TerrainClass terrain_class) {
    const view::Rgb colour = view::colour_of(terrain_class, support);
    return io::PointColor{colour.r, colour.g, colour.b};
  };
}

Outputs::Outputs(std::string folder, const AppParams& params)
    : folder_(made_folder(std::move(folder))),
      params_(params.description),
      clusters_(folder_ + "/clusters.csv"),
      scans_(folder_ + "/scans.csv") {
  view::write_clusters_csv_header(clusters_.stream());
  view::write_scans_csv_header(scans_.stream());
  if (params_.description.mode == DescriptionMode::kField) {
    holes_ = std::make_unique<files::WholeFile>(folder_ + "/holes.csv");
    view::write_holes_csv_header(holes_->stream());
  }
  files::write_atomically(folder_ + "/params.ini", params::dump_ini(params));
}

void Outputs::add_rows(const view::ScanRecord& record, const Description& description) {
  view::write_clusters_csv(clusters_.stream(), record, description);
  view::write_scans_csv(scans_.stream(), record);
  if (holes_) view::write_holes_csv(holes_->stream(), record, description);
  const bool holes_fail = holes_ && !holes_->stream().flush();
  if (!clusters_.stream().flush() || !scans_.stream().flush() || holes_fail) {
    throw std::runtime_error(folder_ + ": the tables cannot be written (is the disk full?)");
  }
}

void Outputs::write_views(const view::ScanRecord& record, const Points& points,
                          const Description& description, const std::vector<UnseenReason>& unseen,
                          const std::string& why) {
  const std::string stem = folder_ + "/" + scan_name(record.index);
  for (View& view : views_) {
    if (view.picture != stem + ".png") continue;
    view.why += " and " + why;
    return;
  }
  views_.push_back({why, stem + ".png"});
  view::TopViewOptions options;
  options.source = record.file;
  options.scan_index = record.index;
  options.stamp = record.stamp;
  options.params = params_;
  options.unseen = &unseen;
  view::write_top_view(stem + ".png", description, options);
  view::write_scene(stem + ".3Dscene", description, points.view());
  io::write_labelled_ply(stem + ".ply", points.view(), description.labels, label_colours());
}

void Outputs::finish(const view::RunSummary& summary) {
  clusters_.commit();
  scans_.commit();
  if (holes_) holes_->commit();
  files::write_atomically(folder_ + "/summary.json", view::summary_json(summary));
}
