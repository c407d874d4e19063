// SPDX-License-Identifier: BSD-3-Clause
#include "experiments.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "catalog.h"
#include "mrpt_terrain/params/data_files.h"
#include "mrpt_terrain/params/ini.h"
#ifdef MRPT_TERRAIN_HAS_PEERS
#include "mrpt_terrain/peers/pcl_estimators.h"
#endif

namespace {

namespace eval = mrpt_terrain::eval;

constexpr double kMillimetre = 1e-3;
constexpr double kRadian = 0.017453292519943295;  // per degree
constexpr double kFigureNoiseMm = 5.0;

/// One scene under one condition.
struct Job {
  const CatalogEntry* entry = nullptr;
  eval::TrialConditions conditions;
  bool for_figures = false;
};

bool wanted(const Options& options, int table) {
  return std::find(options.tables.begin(), options.tables.end(), table) != options.tables.end();
}

// The noise of a table's figures: 5 mm if it is among the levels, else the first of them.
double figure_noise_mm(const std::vector<double>& levels) {
  const bool usual = std::find(levels.begin(), levels.end(), kFigureNoiseMm) != levels.end();
  return usual ? kFigureNoiseMm : levels.front();
}

std::vector<Job> jobs_of(const Options& options) {
  std::vector<Job> jobs;
  for (const CatalogEntry& entry : catalog()) {
    if (!wanted(options, entry.table)) continue;
    const std::vector<double> levels =
        options.noise_mm.empty() ? usual_noise_mm(entry.table) : options.noise_mm;
    const bool with_tilt = entry.table >= 4 && options.tilt_deg > 0.0;
    for (const double tilt : {0.0, options.tilt_deg * kRadian}) {
      if (tilt > 0.0 && !with_tilt) continue;
      for (const double level : levels) {
        jobs.push_back(
            {&entry, {level * kMillimetre, tilt}, tilt == 0.0 && level == figure_noise_mm(levels)});
      }
      if (!with_tilt) break;
    }
  }
  return jobs;
}

// A trial of the slope comparisons costs many times one of the others, most of it LMEDS.
double cost_of(const Job& job) { return job.entry->table >= 4 ? 5.0 : 1.0; }

std::string text_of(const Job& job) {
  std::string text = "Table " + std::to_string(job.entry->table);
  text += job.entry->targets.size() == 1 ? ", slope " + job.entry->targets.front().name : "";
  text += ", " + std::to_string(static_cast<int>(job.conditions.range_sigma * 1e3 + 0.5)) + " mm";
  return job.conditions.tilt_sigma > 0.0 ? text + ", tilted" : text;
}

eval::TrialPlan plan_of(const Options& options, const Job& job,
                        const mrpt_terrain::DescriptionParams& params) {
  eval::TrialPlan plan;
  plan.params = params;
  plan.params.slope.inlier_distance = options.inlier_distance;
  // Figures 9 and 10 show features of clusters whose class does not need them.
  plan.params.classes.all_features = job.entry->table == 3;
  // To the letter: also walls are fitted along z, which makes the angle of cluster 2 fluctuate.
  if (job.entry->table == 3) plan.params.slope.vertical_from = 90.0 * kRadian;
  plan.with_beam = job.entry->table >= 4;
  plan.conditions = job.conditions;
  plan.trials = options.trials;
  plan.seed = options.seed;
  plan.threads = options.threads;
  plan.threshold = options.inlier_distance;
  if (options.lmeds_trials > 0) plan.limits["lmeds"] = options.lmeds_trials;
  return plan;
}

std::size_t split_trials(const std::vector<eval::Trial>& trials, std::size_t target) {
  const auto count = std::count_if(trials.begin(), trials.end(), [target](const auto& trial) {
    return trial[target].clusters > 1;
  });
  return static_cast<std::size_t>(count);
}

/// Turns the trials of one job after the other into results.
class Collector {
 public:
  Collector(const Options& options, std::vector<std::string> methods)
      : bootstrap_{options.resamples, options.seed} {
    results_.methods = std::move(methods);
    results_.trials = options.trials;
  }

  void add(const Job& job, const eval::PaperScene& scene, const eval::TrialPlan& plan,
           const std::vector<eval::Trial>& trials) {
    for (std::size_t k = 0; k < scene.targets.size(); ++k) {
      if (job.entry->table == 2) add_errors(job, scene, k, trials);
      if (job.entry->table == 3 && scene.targets[k].name == "cluster 3") {
        add_errors(job, scene, k, trials);
      }
      if (job.entry->table >= 4) {
        results_.slopes.push_back(
            {job.entry->table,
             eval::slope_result(scene, k, plan, results_.methods, trials, bootstrap_),
             split_trials(trials, k)});
      }
    }
    if (job.for_figures) add_figures(scene, plan, trials);
  }

  Results take() { return std::move(results_); }

 private:
  void add_errors(const Job& job, const eval::PaperScene& scene, std::size_t target,
                  const std::vector<eval::Trial>& trials) {
    ErrorRow row;
    row.table = job.entry->table;
    row.target = scene.targets[target].name;
    row.range_sigma = job.conditions.range_sigma;
    const bool heights = row.table == 2;
    row.truth =
        heights ? 100.0 * scene.targets[target].height : scene.targets[target].slope / kRadian;
    row.summary = eval::summarize(
        heights ? eval::height_indices(trials, target) : eval::described_angles(trials, target),
        trials.size(), row.truth, bootstrap_);
    row.split = split_trials(trials, target);
    results_.errors.push_back(std::move(row));
  }

  void add_figures(const eval::PaperScene& scene, const eval::TrialPlan& plan,
                   const std::vector<eval::Trial>& trials) {
    results_.figure_sigma = plan.conditions.range_sigma;
    SceneCloud cloud{scene.name, {}, eval::scan_picture(scene, plan)};
    for (std::size_t k = 0; k < scene.targets.size(); ++k) {
      const eval::Target& target = scene.targets[k];
      cloud.targets.push_back(target.name);
      results_.series.push_back({target.name, 100.0 * target.height, target.slope / kRadian,
                                 eval::height_indices(trials, k), eval::roughness_flags(trials, k),
                                 eval::described_angles(trials, k)});
    }
    results_.clouds.push_back(std::move(cloud));
  }

  eval::BootstrapParams bootstrap_;
  Results results_;
};

std::vector<std::string> names_of(const eval::PlaneEstimators& estimators) {
  std::vector<std::string> names;
  for (const auto& estimator : estimators) names.push_back(estimator->name());
  return names;
}

mrpt_terrain::DescriptionParams paper_params(const std::string& data_folder) {
  mrpt_terrain::DescriptionParams params;
  mrpt_terrain::params::load_ini(data_folder + "/params/paper.ini", params);
  return params;
}

}  // namespace

eval::PlaneEstimators built_in_estimators([[maybe_unused]] const Options& options) {
  const std::string folder = mrpt_terrain::params::find_data_folder().string();
  eval::PlaneEstimators list;
#ifdef MRPT_TERRAIN_HAS_PEERS
  list = mrpt_terrain::peers::pcl_estimators({options.refine});
#endif
  list.push_back(eval::pca_estimator());
  list.push_back(eval::least_squares_estimator());
  list.push_back(eval::paper_estimator(paper_params(folder).slope));
  return list;
}

std::string missing_estimators_text() {
#ifdef MRPT_TERRAIN_HAS_PEERS
  return {};
#else
  return "ransac, lmeds, msac, rransac, mlesac and prosac are missing: this program was built "
         "without PCL (packages-paper.apt)";
#endif
}

Results run_experiments(const Options& options, const RunProgress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const std::string folder = mrpt_terrain::params::find_data_folder().string();
  const mrpt_terrain::DescriptionParams params = paper_params(folder);
  const eval::PlaneEstimators estimators = built_in_estimators(options);
  const eval::PlaneEstimators none;
  const std::vector<Job> jobs = jobs_of(options);
  Collector collector(options, names_of(estimators));
  double total = 0.0;
  for (const Job& job : jobs) total += cost_of(job);
  double before = 0.0;
  for (const Job& job : jobs) {
    const eval::PaperScene scene =
        eval::load_paper_scene(folder + "/params/scenes/" + job.entry->scene + ".yaml",
                               folder + "/params/sensors", job.entry->targets);
    const eval::TrialPlan plan = plan_of(options, job, params);
    const auto report = [&](std::size_t done) {
      const double share = static_cast<double>(done) / static_cast<double>(plan.trials);
      return progress((before + share * cost_of(job)) / total, text_of(job));
    };
    const std::vector<eval::Trial> trials =
        eval::run_trials(scene, job.entry->table >= 4 ? estimators : none, plan, report);
    if (trials.empty()) return {};
    collector.add(job, scene, plan, trials);
    before += cost_of(job);
  }
  Results results = collector.take();
  results.complete = true;
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  results.seconds = elapsed.count();
  return results;
}
