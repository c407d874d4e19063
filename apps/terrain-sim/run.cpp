// SPDX-License-Identifier: BSD-3-Clause
// terrain-sim: from scene, sensor, path and seed to a rawlog with its truth.
#include <cmath>
#include <filesystem>
#include <memory>

#include "exit_code.h"
#include "mrpt_terrain/io/rawlog_writer.h"
#include "mrpt_terrain/view/text.h"
#include "options.h"
#include "poses_file.h"
#include "preview.h"
#include "simulation.h"
#include "stop_signal.h"
#include "truth_output.h"

using namespace mrpt_terrain;

namespace {

std::string beside(const std::string& rawlog, const std::string& ending) {
  return std::filesystem::path(rawlog).replace_extension().string() + ending;
}

std::unique_ptr<TruthOutput> make_truth(const SimOptions& options, const Simulation& simulation) {
  if (!options.truth) return nullptr;
  auto truth = std::make_unique<TruthOutput>(beside(options.output, "_truth"), options.cell_size);
  truth->add_scene(simulation);
  return truth;
}

/// Writes one run; its files appear with `commit`.
class Recorder {
 public:
  Recorder(const SimOptions& options, const Simulation& simulation)
      : options_(options),
        simulation_(simulation),
        rawlog_(options.output),
        poses_(beside(options.output, ".tum")),
        truth_(make_truth(options, simulation)),
        odometry_(simulation.params.odometry, options.seed,
                  simulation.motion.at(simulation.starts.front())),
        next_odometry_(simulation.starts.front()) {}

  /// Simulates and writes the k-th sweep and the odometry up to its end.
  void record(std::size_t k) {
    const double start = simulation_.starts[k];
    const double end = start + simulation_.sweep_time();
    write_odometry(start);
    const auto stream = static_cast<std::uint64_t>(std::llround(start / simulation_.sweep_time()));
    sim::simulate_sweep(*simulation_.caster, simulation_.sensor, simulation_.motion, start,
                        options_.seed, stream, workspace_, sweep_);
    if (options_.deskewed) undo_motion(simulation_.sensor, simulation_.motion, sweep_);
    rawlog_.write(*make_observation(simulation_.form, simulation_.sensor, sweep_, options_.label));
    poses_.add(simulation_.motion, start, end);
    if (truth_) truth_->add_sweep(simulation_, sweep_);
    points_ += sweep_.slot.size();
    if (k + 1 == simulation_.starts.size()) write_odometry(end);
  }

  /// The rawlog last, so that it is there only with what belongs to it.
  void commit() {
    if (truth_) truth_->commit();
    poses_.commit();
    rawlog_.commit();
  }

  [[nodiscard]] std::size_t points() const { return points_; }
  [[nodiscard]] const std::string& poses_file() const { return poses_.name(); }

 private:
  /// Readings up to and including a time.
  void write_odometry(double time) {
    constexpr double kSlack = 1e-7;  // seconds
    while (next_odometry_ <= time + kSlack) {
      const PlanarPose pose = odometry_.move_to(simulation_.motion.at(next_odometry_));
      rawlog_.write(*make_odometry(next_odometry_, pose));
      ++readings_;
      next_odometry_ = simulation_.starts.front() +
                       static_cast<double>(readings_) / simulation_.params.odometry.rate;
    }
  }

  const SimOptions& options_;
  const Simulation& simulation_;
  io::RawlogWriter rawlog_;
  PosesFile poses_;
  std::unique_ptr<TruthOutput> truth_;  ///< null: not wanted
  Odometry odometry_;
  double next_odometry_;
  std::size_t readings_ = 0;
  std::size_t points_ = 0;
  sim::SweepWorkspace workspace_;
  sim::Sweep sweep_;
};

std::string summary_of(const SimOptions& options, const Simulation& simulation,
                       const Recorder& recorder) {
  const std::size_t sweeps = simulation.starts.size();
  std::string text =
      options.output + ": " + view::grouped(sweeps) + (sweeps == 1 ? " sweep of " : " sweeps of ") +
      simulation.sensor.model.name + ", " + view::grouped(recorder.points()) + " points, " +
      view::fixed(simulation.starts.back() - simulation.starts.front() + simulation.sweep_time(),
                  1) +
      " s\n";
  text += "poses: " + recorder.poses_file() + "\n";
  return options.truth ? text + "truth: " + beside(options.output, "_truth") + "\n" : text;
}

int record_run(const SimOptions& options, const Simulation& simulation, Messages& messages) {
  Recorder recorder(options, simulation);
  const std::size_t sweeps = simulation.starts.size();
  for (std::size_t k = 0; k < sweeps; ++k) {
    if (stop_requested()) {
      messages.warn("interrupted; nothing was written");
      return kExitInterrupted;
    }
    messages.bar().show(static_cast<double>(k) / static_cast<double>(sweeps),
                        std::to_string(k) + " of " + std::to_string(sweeps) + " sweeps");
    recorder.record(k);
  }
  recorder.commit();
  messages.info(summary_of(options, simulation, recorder));
  return kExitOk;
}

int write_all(const SimOptions& options, const Simulation& simulation, Messages& messages) {
  if (!simulation.shortfall.empty()) messages.warn(simulation.shortfall);
  if (!options.preview.empty()) {
    write_preview(options.preview, simulation);
    messages.info("preview: " + options.preview + "\n");
  }
  int code = kExitOk;
  if (!options.output.empty()) code = record_run(options, simulation, messages);
  return code == kExitOk && !simulation.shortfall.empty() ? kExitIncomplete : code;
}

}  // namespace

int run_simulation(const SimOptions& options) {
  Messages messages(options.verbosity);
  std::unique_ptr<Simulation> simulation;
  try {
    simulation = make_simulation(options);
  } catch (const std::exception& error) {
    messages.error(error.what());
    return kExitUsage;
  }
  try {
    return write_all(options, *simulation, messages);
  } catch (const std::exception& error) {
    messages.error(error.what());
    return kExitOutput;
  }
}
