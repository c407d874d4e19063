// SPDX-License-Identifier: BSD-3-Clause
// terrain-eval worlds: describes scans of simulated worlds and compares with the truth.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <filesystem>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "dump.h"
#include "eval_params.h"
#include "exit_code.h"
#include "mrpt_terrain/core/field_costs.h"
#include "mrpt_terrain/eval/world_score.h"
#include "mrpt_terrain/files/atomic_file.h"
#include "mrpt_terrain/params/data_files.h"
#include "plan.h"
#include "report.h"
#include "stop_signal.h"

using namespace mrpt_terrain;

namespace {

/// Describes with the method that the parameters ask for; owns the memory that it reuses.
class Describer {
 public:
  explicit Describer(const DescriptionParams& params) : params_(params) {}
  void operator()(const ScanView& scan, Description& description) {
    describe(scan, params_, workspace_, description);
  }
  /// Of the scan described last.
  /// \param of_grid slope, step and roughness of the grid alone
  void measure_costs(const ScanView& scan, const Description& description, const RobotParams& robot,
                     bool of_grid, CellCosts& costs) {
    if (of_grid) {
      compute_cell_costs(description.grid, robot, cost_workspace_, costs);
      return;
    }
    compute_cell_costs(description, described_points(scan.points, workspace_), robot,
                       cost_workspace_, costs);
  }

 private:
  const DescriptionParams& params_;
  DescriptionWorkspace workspace_;
  CostWorkspace cost_workspace_;
};

/// Worlds that several threads take from one counter; scores are kept by number.
class WorldQueue {
 public:
  WorldQueue(const Plan& plan, const WorldsOptions& options)
      : plan_(plan), options_(options), scores_(plan.worlds()) {}

  void work() {
    try {
      Describer describer(plan_.description);
      const eval::Describe describe = std::ref(describer);
      while (!stop_ && !stop_requested()) {
        const std::size_t number = next_++;
        if (number >= scores_.size()) break;
        scores_[number] = score(number, describe, costs_by(describer));
        ++done_;
      }
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!error_) error_ = std::current_exception();
      stop_ = true;
    }
    ++finished_;
  }
  [[nodiscard]] std::size_t done() const { return done_; }
  [[nodiscard]] std::size_t finished() const { return finished_; }
  /// Throws what a world threw.
  [[nodiscard]] const std::vector<eval::WorldScore>& scores() const {
    if (error_) std::rethrow_exception(error_);
    return scores_;
  }

 private:
  [[nodiscard]] eval::MeasureCosts costs_by(Describer& describer) const {
    if (options_.costs.empty()) return {};
    return
        [this, &describer](const ScanView& scan, const Description& description, CellCosts& costs) {
          describer.measure_costs(scan, description, plan_.rules.costs.robot, options_.grid_costs,
                                  costs);
        };
  }
  [[nodiscard]] eval::WorldScore score(std::size_t number, const eval::Describe& describe,
                                       eval::MeasureCosts costs) const {
    const std::size_t family = number / plan_.worlds_per_family();
    const std::uint64_t seed = plan_.seeds.first + number % plan_.worlds_per_family();
    eval::ScoredScanListener listener;
    const std::string& folder = options_.common.dump;
    if (!folder.empty()) {
      listener = [&folder](const eval::ScoredScan& scored) { dump_scan(folder, scored); };
    }
    return eval::score_world({plan_.families[family], seed, options_.scans, options_.approach,
                              !options_.things.empty(), options_.follow, TrackingParams{},
                              plan_.scans, plan_.rules, describe, listener, std::move(costs)});
  }

  const Plan& plan_;
  const WorldsOptions& options_;
  std::vector<eval::WorldScore> scores_;
  std::atomic<std::size_t> next_{0}, done_{0}, finished_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::exception_ptr error_;
};

void run_queue(const Plan& plan, const WorldsOptions& options, WorldQueue& queue,
               ProgressBar& bar) {
  std::vector<std::thread> threads;
  const std::size_t workers = std::min(options.threads, plan.worlds());
  for (std::size_t k = 0; k < workers; ++k) threads.emplace_back([&queue] { queue.work(); });
  while (queue.finished() < workers) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    bar.show(static_cast<double>(queue.done()) / static_cast<double>(plan.worlds()),
             std::to_string(queue.done()) + " of " + std::to_string(plan.worlds()) + " worlds");
  }
  for (std::thread& thread : threads) thread.join();
  bar.clear();
}

// In the order of families and seeds, whatever thread was first.
std::vector<NamedScore> sum(const Plan& plan, const std::vector<eval::WorldScore>& worlds) {
  std::vector<NamedScore> scores;
  NamedScore pooled{"pooled", {}};
  for (std::size_t f = 0; f < plan.families.size(); ++f) {
    NamedScore family{plan.families[f].name, {}};
    for (std::size_t k = 0; k < plan.worlds_per_family(); ++k) {
      family.score.add(worlds[f * plan.worlds_per_family() + k]);
    }
    pooled.score.add(family.score);
    scores.push_back(std::move(family));
  }
  scores.push_back(std::move(pooled));
  return scores;
}

void write(const std::string& file, const std::string& content) {
  if (!file.empty()) files::write_atomically(file, std::string_view(content));
}

void report(const std::vector<NamedScore>& scores, const WorldsOptions& options,
            Messages& messages) {
  std::string text;
  for (const TextTable& table : world_tables(scores, options.common.details)) {
    text += as_text(table) + "\n";
  }
  messages.info(text);
  write(options.common.csv, world_csv(scores));
  write(options.false_potholes, false_potholes_csv(scores.back().score));
  write(options.things, things_csv(scores.back().score));
}

}  // namespace

int run_worlds(const WorldsOptions& options) {
  Messages messages(options.common.verbosity);
  Plan plan;
  try {
    plan = make_plan(options);
  } catch (const std::exception& error) {
    messages.error(error.what());
    return kExitUsage;
  }
  if (plan.seeds.first >= sim::kJudgingSeeds.first) {
    messages.warn("these seeds are for judging: nothing may be developed or tuned on what follows");
  }
  WorldQueue queue(plan, options);
  run_queue(plan, options, queue, messages.bar());
  const std::vector<eval::WorldScore>* worlds = nullptr;
  try {
    worlds = &queue.scores();
  } catch (const std::exception& error) {
    messages.error(error.what());
    return kExitUsage;
  }
  if (stop_requested()) {
    messages.warn("interrupted; nothing was written");
    return kExitInterrupted;
  }
  report(sum(plan, *worlds), options, messages);
  return kExitOk;
}
