// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/csv.h"

#include <string>
#include <string_view>

#include "mrpt_terrain/view/cluster_order.h"
#include "mrpt_terrain/view/text.h"

namespace mrpt_terrain::view {
namespace {

constexpr double kDegrees = 180.0 / 3.14159265358979323846;

/// One line of the file; writes itself, whole, at `end`.
class Line {
 public:
  explicit Line(std::ostream& out) : out_(out) {}

  Line& text(std::string_view value) {
    separate();
    if (value.find_first_of(",\"\r\n") == std::string_view::npos) {
      line_ += value;
      return *this;
    }
    line_ += '"';
    for (const char c : value) line_.append(c == '"' ? 2 : 1, c);
    line_ += '"';
    return *this;
  }
  Line& number(double value) { return text(shortest(value)); }
  Line& number(float value) { return text(shortest(value)); }
  Line& count(std::size_t value) { return text(std::to_string(value)); }
  Line& count(std::int32_t value) { return text(std::to_string(value)); }
  Line& empty(int fields) {
    for (; fields > 0; --fields) text({});
    return *this;
  }
  void end() {
    line_ += '\n';
    out_.write(line_.data(), static_cast<std::streamsize>(line_.size()));
  }

 private:
  void separate() {
    if (!first_) line_ += ',';
    first_ = false;
  }

  std::ostream& out_;
  std::string line_;
  bool first_ = true;
};

void add_roughness(Line& line, const Roughness& roughness) {
  line.text(name_of(roughness.status));
  if (roughness.status != FeatureStatus::kOk) {
    line.empty(4);
    return;
  }
  line.count(roughness.rough ? 1 : 0);
  for (const double lambda : roughness.lambda) line.number(lambda);
}

/// What method `beam` adds; other methods know no standard deviation.
void add_uncertainty(Line& line, const Slope& slope) {
  if (!(slope.angle_sigma > 0.0)) {
    line.empty(6);
    return;
  }
  line.number(slope.angle_sigma * kDegrees).number(slope.direction_sigma * kDegrees);
  line.number(slope.range_sigma);
  line.text(name_of(slope.to_ground.status));
  if (slope.to_ground.status != FeatureStatus::kOk) {
    line.empty(2);
    return;
  }
  line.number(slope.to_ground.angle * kDegrees).number(slope.to_ground.angle_sigma * kDegrees);
}

void add_slope(Line& line, const Slope& slope) {
  line.text(name_of(slope.status));
  if (slope.status != FeatureStatus::kOk) {
    line.empty(13);
    return;
  }
  line.number(slope.angle * kDegrees);
  for (int axis = 0; axis < 3; ++axis) line.number(slope.normal[axis]);
  line.count(slope.inliers).count(slope.iterations);
  line.number(slope.direction * kDegrees);
  add_uncertainty(line, slope);
}

/// What only field mode measures.
void add_field_features(Line& line, const ClusterDescription& thing) {
  if (!(thing.confidence > 0.0)) {
    line.empty(11);
    return;
  }
  line.count(thing.raised).number(thing.scatter).number(thing.lowest_step);
  line.number(thing.highest_step).number(thing.confidence);
  line.number(thing.box.centre.x).number(thing.box.centre.y).number(thing.box.yaw * kDegrees);
  line.number(thing.box.length).number(thing.box.width);
  line.text(thing.identity == 0 ? std::string() : std::to_string(thing.identity));
}

void add_cluster(Line& line, const ClusterDescription& thing) {
  line.text(name_of(thing.terrain_class)).number(thing.centroid.x).number(thing.centroid.y);
  line.number(thing.min_corner.x).number(thing.min_corner.y);
  line.number(thing.max_corner.x).number(thing.max_corner.y);
  line.count(thing.cells).count(thing.points);
  line.number(thing.height.h_d).number(thing.height.h_m).number(thing.height.h_f);
  line.number(thing.h_min).number(thing.h_max);
  add_roughness(line, thing.roughness);
  add_slope(line, thing.slope);
  add_field_features(line, thing);
}

}  // namespace

void write_clusters_csv_header(std::ostream& out) {
  constexpr std::string_view kHeader =
      "scan,stamp,cluster,class,x,y,min_x,min_y,max_x,max_y,cells,points,h_d,h_m,h_f,h_min,h_max,"
      "roughness_status,rough,lambda_0,lambda_1,lambda_2,slope_status,angle_deg,normal_x,normal_y,"
      "normal_z,inliers,iterations,direction_deg,angle_sigma_deg,direction_sigma_deg,range_sigma,"
      "to_ground_status,to_ground_deg,to_ground_sigma_deg,raised,scatter,lowest_step,highest_step,"
      "confidence,box_x,box_y,box_yaw_deg,box_length,box_width,identity\n";
  out.write(kHeader.data(), static_cast<std::streamsize>(kHeader.size()));
}

void write_clusters_csv(std::ostream& out, const ScanRecord& scan, const Description& description) {
  for (std::size_t k = 0; k < description.things.size(); ++k) {
    Line line(out);
    line.count(scan.index).number(scan.stamp).count(k);
    add_cluster(line, description.things[k]);
    line.end();
  }
}

void write_holes_csv_header(std::ostream& out) {
  constexpr std::string_view kHeader =
      "scan,stamp,hole,kind,cluster,x,y,length,width,depth,points,rings,confidence\n";
  out.write(kHeader.data(), static_cast<std::streamsize>(kHeader.size()));
}

void write_holes_csv(std::ostream& out, const ScanRecord& scan, const Description& description) {
  for (std::size_t k = 0; k < description.holes.size(); ++k) {
    const HoleDescription& hole = description.holes[k];
    const std::int32_t cluster = cluster_of(description, hole);
    Line line(out);
    line.count(scan.index).number(scan.stamp).count(k).text(std::string(name_of(hole.kind)));
    line.text(cluster == kNoCluster ? std::string() : std::to_string(cluster));
    line.number(hole.centre.x).number(hole.centre.y).number(hole.length).number(hole.width);
    line.number(hole.depth).count(hole.points).count(hole.rings).number(hole.confidence).end();
  }
}

void write_scans_csv_header(std::ostream& out) {
  Line line(out);
  for (const auto* name : {"file", "entry", "scan", "stamp", "sensor_label", "left_out_no_return",
                           "left_out_not_finite", "left_out_out_of_range", "points"}) {
    line.text(name);
  }
  for (const auto& entry : enum_names(UnknownReason{})) {
    if (entry.value != UnknownReason::kNone) line.text(std::string("points_") + entry.name);
  }
  for (const auto& entry : enum_names(Support{})) line.text(std::string("points_") + entry.name);
  line.text("cells_observed").text("cells_ground").text("cells_non_ground");
  for (const auto& entry : enum_names(TerrainClass{})) {
    if (entry.value != TerrainClass::kNone) line.text(std::string("clusters_") + entry.name);
  }
  line.text("groups_dropped").text("ms_io").text("ms_transform");
  for (const auto& entry : enum_names(Stage{})) line.text(std::string("ms_") + entry.name);
  line.text("ms_total").end();
}

void write_scans_csv(std::ostream& out, const ScanRecord& scan) {
  Line line(out);
  line.text(scan.file).count(scan.entry).count(scan.index).number(scan.stamp);
  line.text(scan.sensor_label).count(scan.left_out.no_return).count(scan.left_out.not_finite);
  line.count(scan.left_out.out_of_range).count(scan.counts.points);
  for (std::size_t reason = 1; reason < kReasonCount; ++reason) {
    line.count(scan.counts.per_reason[reason]);
  }
  for (const std::size_t points : scan.counts.per_support) line.count(points);
  line.count(scan.counts.observed_cells).count(scan.counts.ground_cells);
  line.count(scan.counts.non_ground_cells);
  for (std::size_t kind = 1; kind < kClassCount; ++kind) line.count(scan.counts.clusters[kind]);
  line.count(scan.counts.dropped_groups);
  line.number(scan.milliseconds.io).number(scan.milliseconds.transform);
  for (const double milliseconds : scan.milliseconds.stage) line.number(milliseconds);
  line.number(scan.milliseconds.total).end();
}

}  // namespace mrpt_terrain::view
