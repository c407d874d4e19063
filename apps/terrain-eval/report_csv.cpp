// SPDX-License-Identifier: BSD-3-Clause
// The same numbers for programs.
#include "mrpt_terrain/view/text.h"
#include "report.h"
#include "report_text.h"

using namespace mrpt_terrain;

namespace {

/// Lines "name,metric,group,value,count".
class Lines {
 public:
  explicit Lines(std::string name) : name_(std::move(name)) {}
  void add(const std::string& metric, const std::string& group, double value, std::size_t count) {
    text_ += name_ + "," + metric + "," + group + "," + view::shortest(value) + "," +
             std::to_string(count) + "\n";
  }
  void add(const std::string& metric, const std::string& group, const eval::Share& share) {
    add(metric, group, share.value(), share.total);
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string name_, text_;
};

void add_counts(const std::string& group, const eval::SupportCounts& counts, Lines& lines) {
  const std::size_t ground = counts.true_ground + counts.missed_ground;
  const std::size_t obstacles = counts.true_obstacle + counts.missed_obstacle;
  lines.add("ground_iou", group, counts.iou(), ground);
  lines.add("ground_precision", group, counts.precision(), ground);
  lines.add("ground_recall", group, counts.recall(), ground);
  lines.add("ground_f1", group, counts.f1(), ground);
  lines.add("obstacle_tpr", group, counts.obstacle_tpr(), obstacles);
}

void add_support(const eval::SupportScore& score, Lines& lines) {
  add_counts("all", score.all, lines);
  const std::vector<std::string> distances = distance_names(), heights = height_names();
  for (std::size_t k = 0; k < distances.size(); ++k) {
    add_counts(distances[k] + " m", score.by_distance[k], lines);
  }
  for (std::size_t k = 0; k < heights.size(); ++k) {
    lines.add("obstacle_tpr_by_height", heights[k] + " m", score.obstacles_by_height[k]);
  }
}

void add_clusters(const eval::ClusterScore& score, Lines& lines) {
  lines.add("cluster_recall", "all", score.found);
  lines.add("cluster_precision", "all", score.right);
  lines.add("things_split", "all", score.split);
  lines.add("clusters_merged", "all", score.merged);
  lines.add("clusters_not_counted", "all", static_cast<double>(score.not_counted),
            score.not_counted + score.right.total);
  const std::vector<std::string> names = class_names(), distances = distance_names();
  for (std::size_t k = 1; k < names.size(); ++k) {
    lines.add("cluster_recall", names[k], score.found_of_class[k]);
  }
  for (std::size_t k = 0; k < distances.size(); ++k) {
    lines.add("cluster_recall", distances[k] + " m", score.found_at[k]);
  }
  for (std::size_t r = 0; r < names.size(); ++r) {
    std::size_t all = 0;
    for (const std::size_t n : score.confusion[r]) all += n;
    for (std::size_t c = 0; c < names.size(); ++c) {
      lines.add("confusion", names[r] + ">" + names[c], static_cast<double>(score.confusion[r][c]),
                all);
    }
  }
}

void add_errors(const std::string& metric, const eval::ErrorSummary& errors, Lines& lines) {
  lines.add(metric, "bias_rad", errors.bias, errors.samples);
  lines.add(metric, "rmse_rad", errors.rmse, errors.samples);
  lines.add(metric, "p95_rad", errors.p95, errors.samples);
  lines.add(metric, "max_rad", errors.greatest, errors.samples);
  lines.add(metric, "in_two_sigma", errors.in_two_sigma);
}

void add_potholes(const eval::PotholeScore& score, Lines& lines) {
  lines.add("pothole_recall", "due", score.found);
  lines.add("pothole_recall", "right size", score.found_small);
  lines.add("pothole_recall", "other size", score.found_other);
  const std::vector<std::string> names = hole_distance_names();
  for (std::size_t k = 0; k < names.size(); ++k) {
    lines.add("pothole_recall_due", names[k] + " m", score.due_at[k]);
    lines.add("pothole_recall_right_size", names[k] + " m", score.small_at[k]);
  }
  lines.add("false_potholes", "all", static_cast<double>(score.wrong.size()), score.wrong.size());
  lines.add("false_potholes", "per 1000 m2", score.wrong_per_1000(), score.wrong.size());
  lines.add("observed_ground", "m2", score.ground, 1);
  lines.add("pothole_in_time", "on path", score.ahead);
}

void add_gaps(const eval::GapScore& score, double ground, Lines& lines) {
  for (std::size_t kind = 1; kind < score.described.size(); ++kind) {
    lines.add("gaps", name_of(static_cast<HoleKind>(kind)),
              static_cast<double>(score.described[kind]), score.described[kind]);
  }
  const auto wrong = static_cast<double>(score.wrong.size());
  lines.add("false_gaps", "all", wrong, score.wrong.size());
  lines.add("false_gaps", "per 1000 m2", 1000.0 * wrong / ground, score.wrong.size());
}

void add_identities(const eval::IdentityScore& score, Lines& lines) {
  lines.add("identity_kept", "seen", score.kept);
  lines.add("identity_kept", "found", score.kept_where_found);
}

void add_costs(const eval::CostScore& score, Lines& lines) {
  if (score.blocked.total == 0) return;
  lines.add("cost_lethal", "traversable", score.blocked);
  lines.add("cost_lethal", "traversable alone", score.blocked_free);
  for (const auto& entry : enum_names(eval::TrueCell{})) {
    if (entry.value <= eval::TrueCell::kTraversable) continue;
    const auto k = static_cast<std::size_t>(entry.value);
    lines.add("cost_not_lethal", entry.name, score.open[k]);
    lines.add("cost_unknown", entry.name, score.unknown[k]);
    lines.add("cost_nothing_lethal_beside", entry.name, score.all_open[k]);
  }
}

const char* const kHeader = "name,metric,group,value,count\n";

}  // namespace

std::string world_csv(const std::vector<NamedScore>& scores) {
  std::string text = kHeader;
  for (const NamedScore& entry : scores) {
    Lines lines(entry.name);
    const eval::WorldScore& score = entry.score;
    lines.add("scans", "all", static_cast<double>(score.scans), score.worlds);
    lines.add("points", "all", static_cast<double>(score.points), score.scans);
    add_support(score.support, lines);
    add_clusters(score.clusters, lines);
    lines.add("ramps", "no angle", static_cast<double>(score.slopes.no_angle), score.slopes.ramps);
    lines.add("ramps", "several faces", static_cast<double>(score.slopes.several),
              score.slopes.ramps);
    add_errors("slope_angle", eval::angle_summary(score.slopes), lines);
    add_errors("slope_direction", eval::direction_summary(score.slopes), lines);
    add_potholes(score.potholes, lines);
    add_gaps(score.gaps, score.potholes.ground, lines);
    add_identities(score.identities, lines);
    add_costs(score.costs, lines);
    text += lines.text();
  }
  return text;
}

std::string support_csv(const std::vector<NamedSupport>& scores) {
  std::string text = kHeader;
  for (const NamedSupport& entry : scores) {
    Lines lines(entry.name);
    add_support(entry.score, lines);
    text += lines.text();
  }
  return text;
}

std::string false_potholes_csv(const eval::WorldScore& score) {
  std::string text = "family,seed,sweep,x,y,distance,cells,points,h_min,h_max,what_is_there\n";
  for (const eval::FalsePothole& entry : score.potholes.wrong) {
    text += entry.family + "," + std::to_string(entry.seed) + "," + std::to_string(entry.sweep);
    for (const double value : {entry.x, entry.y, entry.distance}) {
      text += "," + view::fixed(value, 3);
    }
    text += "," + std::to_string(entry.cells) + "," + std::to_string(entry.points) + "," +
            view::fixed(entry.h_min, 3) + "," + view::fixed(entry.h_max, 3) + "," + entry.at + "\n";
  }
  return text;
}

std::string things_csv(const eval::WorldScore& score) {
  std::string text =
      "family,seed,sweep,what,object,type,class,cluster,described,x,y,of_object,of_cluster,shared,"
      "iou,called_ground,in_no_cluster,parts,swallowed,points,cells,raised,confidence\n";
  for (const eval::ThingRecord& entry : score.things) {
    text += entry.family + "," + std::to_string(entry.seed) + "," + std::to_string(entry.sweep) +
            (entry.is_false ? ",cluster," : ",object,") + std::to_string(entry.thing) + "," +
            entry.type + "," + name_of(entry.truth) + "," + std::to_string(entry.cluster) + "," +
            name_of(entry.described) + "," + view::fixed(entry.x, 2) + "," +
            view::fixed(entry.y, 2);
    for (const std::size_t n : {entry.of_thing, entry.of_cluster, entry.shared}) {
      text += "," + std::to_string(n);
    }
    text += "," + view::fixed(entry.iou(), 3);
    for (const std::size_t n : {entry.loose, entry.dropped, entry.parts, entry.swallowed}) {
      text += "," + std::to_string(n);
    }
    for (const std::int32_t n : {entry.points, entry.cells, entry.raised}) {
      text += "," + std::to_string(n);
    }
    text += "," + view::fixed(entry.confidence, 3) + "\n";
  }
  return text;
}
