// SPDX-License-Identifier: BSD-3-Clause
#include "path_option.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "mrpt_terrain/params/document.h"

namespace {

/// \param place beginning of messages
Eigen::Vector2d parse_waypoint(std::string text, const std::string& place) {
  const std::string original = text;
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  Eigen::Vector2d point;
  std::string rest;
  if (!(stream >> point.x() >> point.y()) || (stream >> rest) || !point.allFinite()) {
    throw std::invalid_argument(place + ": \"" + original +
                                "\" is no waypoint: give x and y in metres, such as \"4, -1.5\"");
  }
  return point;
}

bool is_blank(const std::string& text) {
  return text.find_first_not_of(" \t\r") == std::string::npos;
}

std::vector<Eigen::Vector2d> parse_file(const std::string& file) {
  std::istringstream text(mrpt_terrain::params::read_text_file(file));
  std::vector<Eigen::Vector2d> points;
  std::string line;
  for (int number = 1; std::getline(text, line); ++number) {
    line.resize(std::min(line.size(), line.find('#')));
    if (is_blank(line)) continue;
    points.push_back(parse_waypoint(line, file + ":" + std::to_string(number)));
  }
  if (points.empty()) throw std::invalid_argument(file + ": has no waypoints");
  return points;
}

/// Words that begin like a number are waypoints, others name a file.
bool is_list(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  return text.find(';') != std::string::npos ||
         (first != std::string::npos && text.find(',') != std::string::npos &&
          std::string("+-.0123456789").find(text[first]) != std::string::npos);
}

}  // namespace

std::vector<Eigen::Vector2d> parse_path(const std::string& text) {
  if (std::filesystem::exists(text) || !is_list(text)) return parse_file(text);
  std::vector<Eigen::Vector2d> points;
  std::istringstream stream(text);
  std::string part;
  while (std::getline(stream, part, ';')) {
    if (!is_blank(part)) points.push_back(parse_waypoint(part, "--path"));
  }
  if (points.empty()) throw std::invalid_argument("--path: \"" + text + "\" has no waypoints");
  return points;
}
