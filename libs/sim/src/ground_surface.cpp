// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/sim/ground_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <locale>
#include <sstream>

#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain::sim {
namespace {

constexpr double kTwoPi = 6.28318530717958647692;
// A plane needs no fine lattice; small cells keep it precise where Embree's floats see it.
constexpr double kPlaneSpacing = 5.0;
constexpr std::size_t kMostNodes = 30'000'000;

// Gradient of the noise lattice at a node: a unit vector whose direction is a hash of the node.
Eigen::Vector2d gradient_at(std::int64_t i, std::int64_t k, std::uint64_t seed) {
  const auto column = static_cast<std::uint64_t>(i) * 0x9E3779B97F4A7C15ULL;
  const auto row = static_cast<std::uint64_t>(k) * 0xC2B2AE3D27D4EB4FULL;
  RandomGenerator random(seed ^ column, (row ^ (column >> 17U)) & 0x7FFFFFFFFFFFFFFFULL);
  const double angle = kTwoPi * random.uniform();
  return {std::cos(angle), std::sin(angle)};
}

double fade(double t) { return t * t * t * (t * (6.0 * t - 15.0) + 10.0); }

// Gradient noise (Perlin 2002) of wavelength 1, about -0.7 to 0.7.
double gradient_noise(double x, double y, std::uint64_t seed) {
  const auto i = static_cast<std::int64_t>(std::floor(x));
  const auto k = static_cast<std::int64_t>(std::floor(y));
  const double u = x - static_cast<double>(i);
  const double v = y - static_cast<double>(k);
  const auto corner = [&](int di, int dk) {
    return gradient_at(i + di, k + dk, seed).dot(Eigen::Vector2d(u - di, v - dk));
  };
  const double low = corner(0, 0) + fade(u) * (corner(1, 0) - corner(0, 0));
  const double high = corner(0, 1) + fade(u) * (corner(1, 1) - corner(0, 1));
  return low + fade(v) * (high - low);
}

// From 0 within the radius to 1 half a wavelength farther out.
double fade_in(const Ground& ground, double x, double y) {
  if (ground.flat_radius <= 0.0) return 1.0;
  const double beyond = std::hypot(x - ground.x, y - ground.y) - ground.flat_radius;
  return fade(std::clamp(beyond / (0.5 * ground.wavelength), 0.0, 1.0));
}

std::vector<double> numbers_of(const std::string& line) {
  std::istringstream in(line);
  in.imbue(std::locale::classic());
  std::vector<double> numbers;
  for (double number = 0.0; in >> number;) numbers.push_back(number);
  if (!in.eof()) numbers.clear();
  return numbers;
}

std::vector<std::vector<double>> rows_of(const std::string& file, const std::string& source) {
  std::ifstream in(file);
  if (!in) throw SceneError(source + ": file = " + file + ": cannot be read");
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    rows.push_back(numbers_of(line));
    const bool fits = rows.back().size() >= 2 && rows.back().size() == rows.front().size() &&
                      std::all_of(rows.back().begin(), rows.back().end(),
                                  [](double height) { return std::isfinite(height); });
    if (!fits) {
      throw SceneError(source + ": file = " + file + ": row " + std::to_string(rows.size()) +
                       ": every row must hold the same number of heights, at least two");
    }
  }
  if (rows.size() < 2) throw SceneError(source + ": file = " + file + ": needs two rows at least");
  return rows;
}

}  // namespace

GroundSurface::GroundSurface(const Ground& ground, const std::string& source) {
  const Eigen::Vector2d half(ground.length / 2, ground.width / 2);
  min_corner_ = Eigen::Vector2d(ground.x, ground.y) - half;
  max_corner_ = Eigen::Vector2d(ground.x, ground.y) + half;
  const double cells = (ground.length / ground.spacing) * (ground.width / ground.spacing);
  if (ground.form == GroundForm::kFractal && cells > static_cast<double>(kMostNodes)) {
    throw SceneError(source + ": spacing: too fine for a ground of that size: more than " +
                     std::to_string(kMostNodes) + " nodes");
  }
  if (ground.form == GroundForm::kHeightMap) {
    read_height_map(ground, source);
  } else {
    set_lattice(ground, ground.form == GroundForm::kPlane ? kPlaneSpacing : ground.spacing);
  }
  if (ground.form == GroundForm::kFractal) add_fractal(ground);
  add_plane(ground);
}

void GroundSurface::set_lattice(const Ground& ground, double spacing) {
  nodes_x_ = static_cast<std::size_t>(std::ceil(ground.length / spacing)) + 1;
  nodes_y_ = static_cast<std::size_t>(std::ceil(ground.width / spacing)) + 1;
  step_ = {ground.length / static_cast<double>(nodes_x_ - 1),
           ground.width / static_cast<double>(nodes_y_ - 1)};
  heights_.assign(nodes_x_ * nodes_y_, 0.0);
}

void GroundSurface::read_height_map(const Ground& ground, const std::string& source) {
  const std::vector<std::vector<double>> rows = rows_of(ground.file, source);
  nodes_x_ = rows.front().size();
  nodes_y_ = rows.size();
  step_ = {ground.length / static_cast<double>(nodes_x_ - 1),
           ground.width / static_cast<double>(nodes_y_ - 1)};
  heights_.clear();
  for (const std::vector<double>& row : rows) {
    heights_.insert(heights_.end(), row.begin(), row.end());
  }
}

void GroundSurface::add_plane(const Ground& ground) {
  const double rise = std::tan(ground.slope);
  const Eigen::Vector2d gradient(rise * std::cos(ground.slope_direction),
                                 rise * std::sin(ground.slope_direction));
  for (std::size_t k = 0; k < nodes_y_; ++k) {
    for (std::size_t i = 0; i < nodes_x_; ++i) {
      const Eigen::Vector2d from_centre =
          node(i, k).head<2>() - Eigen::Vector2d(ground.x, ground.y);
      at(i, k) += gradient.dot(from_centre);
    }
  }
}

void GroundSurface::add_fractal(const Ground& ground) {
  for (std::size_t k = 0; k < nodes_y_; ++k) {
    for (std::size_t i = 0; i < nodes_x_; ++i) {
      const Eigen::Vector3d place = node(i, k);
      double amplitude = ground.amplitude;
      double frequency = 1.0 / ground.wavelength;
      double height = 0.0;
      for (int octave = 0; octave < ground.octaves; ++octave) {
        height += amplitude * gradient_noise(place.x() * frequency, place.y() * frequency,
                                             ground.seed + static_cast<std::uint64_t>(octave));
        amplitude *= ground.persistence;
        frequency *= 2.0;
      }
      at(i, k) = height * fade_in(ground, place.x(), place.y());
    }
  }
  const double too_steep = steepest() / std::tan(ground.max_slope);
  if (too_steep > 1.0) {
    for (double& height : heights_) height /= too_steep;
  }
}

// Greatest gradient of all triangles.
double GroundSurface::steepest() const {
  double greatest = 0.0;
  for (std::size_t k = 0; k + 1 < nodes_y_; ++k) {
    for (std::size_t i = 0; i + 1 < nodes_x_; ++i) {
      const double low = (at(i + 1, k) - at(i, k)) / step_.x();
      const double high = (at(i + 1, k + 1) - at(i, k + 1)) / step_.x();
      const double right = (at(i + 1, k + 1) - at(i + 1, k)) / step_.y();
      const double left = (at(i, k + 1) - at(i, k)) / step_.y();
      greatest = std::max({greatest, std::hypot(low, right), std::hypot(high, left)});
    }
  }
  return greatest;
}

Eigen::Vector3d GroundSurface::node(std::size_t i, std::size_t k) const {
  const double x =
      i + 1 == nodes_x_ ? max_corner_.x() : min_corner_.x() + step_.x() * static_cast<double>(i);
  const double y =
      k + 1 == nodes_y_ ? max_corner_.y() : min_corner_.y() + step_.y() * static_cast<double>(k);
  return {x, y, at(i, k)};
}

bool GroundSurface::contains(double x, double y) const {
  return x >= min_corner_.x() && x <= max_corner_.x() && y >= min_corner_.y() &&
         y <= max_corner_.y();
}

GroundSurface::Place GroundSurface::place_of(double x, double y) const {
  const double u = (x - min_corner_.x()) / step_.x();
  const double v = (y - min_corner_.y()) / step_.y();
  const double i = std::clamp(std::floor(u), 0.0, static_cast<double>(nodes_x_ - 2));
  const double k = std::clamp(std::floor(v), 0.0, static_cast<double>(nodes_y_ - 2));
  return {static_cast<std::size_t>(i), static_cast<std::size_t>(k), u - i, v - k};
}

double GroundSurface::height(double x, double y) const {
  const Place p = place_of(x, y);
  const double origin = at(p.i, p.k);
  const double opposite = at(p.i + 1, p.k + 1);
  if (p.u >= p.v) {
    const double corner = at(p.i + 1, p.k);
    return origin + p.u * (corner - origin) + p.v * (opposite - corner);
  }
  const double corner = at(p.i, p.k + 1);
  return origin + p.v * (corner - origin) + p.u * (opposite - corner);
}

Eigen::Vector3d GroundSurface::normal(double x, double y) const {
  const Place p = place_of(x, y);
  const Eigen::Vector3d origin = node(p.i, p.k);
  const Eigen::Vector3d opposite = node(p.i + 1, p.k + 1);
  const Eigen::Vector3d corner = p.u >= p.v ? node(p.i + 1, p.k) : node(p.i, p.k + 1);
  const Eigen::Vector3d normal = (corner - origin).cross(opposite - origin).normalized();
  return normal.z() < 0.0 ? Eigen::Vector3d(-normal) : normal;
}

}  // namespace mrpt_terrain::sim
