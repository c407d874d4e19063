// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/paper_experiments.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <filesystem>
#include <mutex>
#include <thread>

#include "mrpt_terrain/core/random.h"
#include "mrpt_terrain/sim/scene_file.h"

namespace mrpt_terrain::eval {
namespace {

constexpr double kTwoPi = 6.283185307179586;

const sim::WorldSolid& solid_with(const sim::World& world, int id, const std::string& file) {
  const auto found = std::find_if(world.solids.begin(), world.solids.end(),
                                  [id](const sim::WorldSolid& solid) { return solid.id == id; });
  if (found == world.solids.end()) {
    throw sim::SceneError(file + ": solids: id = " + std::to_string(id) +
                          ": must be in the scene, it is measured");
  }
  return *found;
}

/// Draws of one trial that are not the sensor's.
struct TrialDraws {
  double azimuth = 0.0;  ///< of the first firing: a turn starts anywhere
  double roll = 0.0, pitch = 0.0;
  std::uint64_t sweep_seed = 0;
  std::uint64_t estimator_seed = 0;
};

double normal_deviate(RandomGenerator& random) {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - random.uniform()));
  return radius * std::cos(kTwoPi * random.uniform());
}

std::uint64_t next64(RandomGenerator& random) {
  const std::uint64_t high = random.next();
  return high << 32U | random.next();
}

// Of one seed, every scene and every estimator draws its own numbers; different conditions share
// them.
std::uint64_t seed_of(const std::string& name, std::uint64_t seed) {
  std::uint64_t hash = 14695981039346656037ULL ^ seed;  // FNV-1a
  for (const char letter : name) {
    hash = (hash ^ static_cast<unsigned char>(letter)) * 1099511628211ULL;
  }
  return hash;
}

TrialDraws draw(const PaperScene& scene, const TrialPlan& plan, std::size_t trial) {
  RandomGenerator random(seed_of(scene.name, plan.seed), trial);
  TrialDraws result;
  result.azimuth = kTwoPi * random.uniform();
  result.roll = plan.conditions.tilt_sigma * normal_deviate(random);
  result.pitch = plan.conditions.tilt_sigma * normal_deviate(random);
  result.sweep_seed = next64(random);
  result.estimator_seed = next64(random);
  return result;
}

/// Scratch memory of a thread.
struct Scratch {
  sim::SweepWorkspace sweep_workspace;
  sim::Sweep sweep;
  Points points;
  DescriptionWorkspace workspace;
  Description description;
  Description beam_description;
  std::vector<std::int32_t> members;
};

void scan(const PaperScene& scene, const TrialConditions& conditions, const TrialDraws& draws,
          Scratch& scratch) {
  sim::MountedSensor sensor = scene.sensor;
  sensor.model.noise = {};
  sensor.model.noise.range_sigma = conditions.range_sigma;
  sensor.T_robot_sensor.rotate(Eigen::AngleAxisd(draws.azimuth, Eigen::Vector3d::UnitZ()));
  Eigen::Isometry3d T_map_robot = Eigen::Isometry3d::Identity();
  T_map_robot.rotate(Eigen::AngleAxisd(draws.pitch, Eigen::Vector3d::UnitY()));
  T_map_robot.rotate(Eigen::AngleAxisd(draws.roll, Eigen::Vector3d::UnitX()));
  sim::simulate_sweep(*scene.caster, sensor, sim::Motion(T_map_robot), 0.0, draws.sweep_seed, 0,
                      scratch.sweep_workspace, scratch.sweep);

  const Points& in_sensor = scratch.sweep.points;
  scratch.points.resize(in_sensor.size());
  const Eigen::Isometry3f T = sensor.T_robot_sensor.cast<float>();
  for (std::size_t i = 0; i < in_sensor.size(); ++i) {
    const Eigen::Vector3f p = T * Eigen::Vector3f(in_sensor.x[i], in_sensor.y[i], in_sensor.z[i]);
    scratch.points.x[i] = p.x();
    scratch.points.y[i] = p.y();
    scratch.points.z[i] = p.z();
  }
}

bool belongs_to(const Target& target, const sim::World& world, std::int32_t solid) {
  if (solid < 0) return false;
  const int id = world.solids[static_cast<std::size_t>(solid)].id;
  return std::find(target.solids.begin(), target.solids.end(), id) != target.solids.end();
}

/// Which cluster a target is.
struct Match {
  std::int32_t cluster = kNoCluster;
  int clusters = 0;  ///< that hold returns of the target
};

Match match(const Target& target, const sim::World& world, const Scratch& scratch) {
  std::vector<int> returns(scratch.description.things.size(), 0);
  const std::vector<std::int32_t>& cluster = scratch.description.labels.cluster;
  for (std::size_t i = 0; i < cluster.size(); ++i) {
    if (cluster[i] == kNoCluster) continue;
    const std::int32_t solid = scratch.sweep.solid[scratch.sweep.slot[i]];
    if (belongs_to(target, world, solid)) ++returns[static_cast<std::size_t>(cluster[i])];
  }
  Match result;
  result.clusters = static_cast<int>(returns.size()) -
                    static_cast<int>(std::count(returns.begin(), returns.end(), 0));
  if (result.clusters > 0) {
    const auto most = std::max_element(returns.begin(), returns.end());
    result.cluster = static_cast<std::int32_t>(most - returns.begin());
  }
  return result;
}

IndexRange members_of(std::int32_t wanted, Scratch& scratch) {
  const std::vector<std::int32_t>& cluster = scratch.description.labels.cluster;
  scratch.members.clear();
  for (std::size_t i = 0; i < cluster.size(); ++i) {
    if (cluster[i] == wanted) scratch.members.push_back(static_cast<std::int32_t>(i));
  }
  return {scratch.members.data(), scratch.members.data() + scratch.members.size()};
}

bool is_asked(const PlaneEstimator& estimator, const TrialPlan& plan, std::size_t trial) {
  const auto limit = plan.limits.find(estimator.name());
  return limit == plan.limits.end() || trial < limit->second;
}

// The same scan once more with the other slope method: the stages before it give the same clusters.
void describe_with_beams(const PaperScene& scene, const DescriptionParams& paper_params,
                         Scratch& scratch) {
  DescriptionParams params = paper_params;
  params.slope.method = SlopeMethod::kBeam;
  params.classes.all_features = true;
  const Eigen::Vector3f sensor = scene.sensor.T_robot_sensor.translation().cast<float>();
  const std::array<float, 3> origin = {sensor.x(), sensor.y(), sensor.z()};
  describe({scratch.points.view(), {&origin, nullptr}}, params, scratch.workspace,
           scratch.beam_description);
}

/// One trial and what it is made of.
struct TrialContext {
  const PaperScene& scene;
  const PlaneEstimators& estimators;
  const TrialPlan& plan;
  std::size_t number;
  TrialDraws draws;
};

std::vector<PlaneEstimate> estimate_planes(const TrialContext& context, IndexRange members,
                                           const PointsView& points) {
  std::vector<PlaneEstimate> planes;
  for (const auto& estimator : context.estimators) {
    PlaneEstimate plane;
    plane.status = FeatureStatus::kNotNeeded;
    if (is_asked(*estimator, context.plan, context.number)) {
      plane = estimator->estimate(points, members, context.plan.threshold,
                                  seed_of(estimator->name(), context.draws.estimator_seed));
    }
    planes.push_back(plane);
  }
  return planes;
}

Measurement measure(const TrialContext& context, const Target& target, Scratch& scratch) {
  const Match found = match(target, *context.scene.world, scratch);
  Measurement result;
  result.clusters = found.clusters;
  if (found.clusters == 0) return result;
  const auto cluster = static_cast<std::size_t>(found.cluster);
  result.description = scratch.description.things[cluster];
  if (context.plan.with_beam) {
    const Slope& slope = scratch.beam_description.things[cluster].slope;
    result.beam = {slope.status, slope.angle, slope.angle_sigma};
    result.beam_to_ground = {slope.to_ground.status, slope.to_ground.angle,
                             slope.to_ground.angle_sigma};
  }
  result.planes =
      estimate_planes(context, members_of(found.cluster, scratch), scratch.points.view());
  return result;
}

Trial run_trial(const TrialContext& context, Scratch& scratch) {
  scan(context.scene, context.plan.conditions, context.draws, scratch);
  DescriptionParams params = context.plan.params;
  params.slope.seed = context.draws.estimator_seed;
  describe(scratch.points.view(), params, scratch.workspace, scratch.description);
  if (context.plan.with_beam) describe_with_beams(context.scene, params, scratch);
  Trial trial;
  for (const Target& target : context.scene.targets) {
    trial.push_back(measure(context, target, scratch));
  }
  return trial;
}

/// Trials that several threads take from one counter; results are kept by number.
class TrialQueue {
 public:
  explicit TrialQueue(std::size_t trials) : results_(trials) {}

  template <class Run>
  void work(const Run& run) {
    try {
      while (!stop_) {
        const std::size_t number = next_++;
        if (number >= results_.size()) break;
        results_[number] = run(number);
        ++done_;
      }
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!error_) error_ = std::current_exception();
      stop_ = true;
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    ++finished_;
    changed_.notify_one();
  }

  void wait_for(int workers, const TrialProgress& progress) {
    std::unique_lock<std::mutex> lock(mutex_);
    while (finished_ < workers) {
      changed_.wait_for(lock, std::chrono::milliseconds(100));
      lock.unlock();
      if (progress && !progress(done_)) stop_ = true;
      lock.lock();
    }
  }

  std::vector<Trial> take() {
    if (error_) std::rethrow_exception(error_);
    if (done_ < results_.size()) return {};
    return std::move(results_);
  }

 private:
  std::vector<Trial> results_;
  std::atomic<std::size_t> next_{0}, done_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::exception_ptr error_;
  int finished_ = 0;
};

int source_of(const PaperScene& scene, std::int32_t solid) {
  for (std::size_t k = 0; k < scene.targets.size(); ++k) {
    if (belongs_to(scene.targets[k], *scene.world, solid)) return static_cast<int>(k);
  }
  return solid == sim::kGroundSolid ? ScanPicture::kGround : ScanPicture::kOther;
}

}  // namespace

PaperScene load_paper_scene(const std::string& file, const std::string& sensor_folder,
                            std::vector<Target> targets) {
  const sim::SceneFile loaded = sim::load_scene(file);
  PaperScene scene;
  scene.name = std::filesystem::path(file).stem().string();
  scene.sensor = {sensors::resolve_sensor(loaded.sensor, sensor_folder, file + ": sensor"),
                  loaded.vehicle.T_robot_sensor()};
  scene.world = std::make_unique<sim::World>(sim::build_world(loaded.scene));
  scene.caster = std::make_unique<sim::RayCaster>(*scene.world);
  scene.targets = std::move(targets);
  for (Target& target : scene.targets) {
    for (const int id : target.solids) solid_with(*scene.world, id, file);
    const sim::WorldSolid& first = solid_with(*scene.world, target.solids.front(), file);
    target.height = first.height;
    target.slope = first.slope;
  }
  return scene;
}

std::vector<Trial> run_trials(const PaperScene& scene, const PlaneEstimators& estimators,
                              const TrialPlan& plan, const TrialProgress& progress) {
  TrialQueue queue(plan.trials);
  const int workers = std::max(1, plan.threads);
  std::vector<std::thread> threads;
  for (int k = 0; k < workers; ++k) {
    threads.emplace_back([&] {
      Scratch scratch;
      queue.work([&](std::size_t number) {
        return run_trial({scene, estimators, plan, number, draw(scene, plan, number)}, scratch);
      });
    });
  }
  queue.wait_for(workers, progress);
  for (std::thread& thread : threads) thread.join();
  return queue.take();
}

ScanPicture scan_picture(const PaperScene& scene, const TrialPlan& plan) {
  Scratch scratch;
  scan(scene, plan.conditions, draw(scene, plan, 0), scratch);
  describe(scratch.points.view(), plan.params, scratch.workspace, scratch.description);
  std::map<std::int32_t, int> target_of;
  for (std::size_t k = 0; k < scene.targets.size(); ++k) {
    const Match found = match(scene.targets[k], *scene.world, scratch);
    if (found.clusters > 0) target_of[found.cluster] = static_cast<int>(k);
  }
  ScanPicture picture;
  const PointLabels& labels = scratch.description.labels;
  for (std::size_t i = 0; i < scratch.points.size(); ++i) {
    if (labels.support[i] == Support::kUnknown) continue;
    picture.points.push_back(scratch.points.x[i], scratch.points.y[i], scratch.points.z[i]);
    picture.source.push_back(source_of(scene, scratch.sweep.solid[scratch.sweep.slot[i]]));
    const auto target = target_of.find(labels.cluster[i]);
    const int other =
        labels.support[i] == Support::kGround ? ScanPicture::kGround : ScanPicture::kOther;
    picture.cluster.push_back(target == target_of.end() ? other : target->second);
  }
  return picture;
}

}  // namespace mrpt_terrain::eval
