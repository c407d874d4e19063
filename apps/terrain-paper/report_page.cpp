// SPDX-License-Identifier: BSD-3-Clause
#include "report_page.h"

#include <mrpt/system/string_utils.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "mrpt_terrain/view/text.h"

namespace {

using mrpt_terrain::view::fixed;

constexpr const char* kStyle =
    "body{font:15px/1.45 sans-serif;margin:2em auto;max-width:72em;padding:0 1em;color:#222}"
    "table{border-collapse:collapse;font-variant-numeric:tabular-nums;font-size:13px;"
    "display:block;overflow-x:auto}"
    "th,td{padding:.2em .55em;text-align:right;border-bottom:1px solid #ddd}td{white-space:nowrap}"
    "th{border-bottom:2px solid #888;vertical-align:bottom}"
    "nav ul{columns:2;font-size:13px}"
    "th:first-child,td:first-child{text-align:left}"
    "td.better{color:#176b1c}td.worse{color:#a61b1b}td.tie{color:#777}"
    "img{max-width:100%;height:auto}figure{margin:1.5em 0}figcaption{color:#444}"
    "pre{background:#f4f4f4;padding:.6em;overflow-x:auto}";

std::string seconds_text(double seconds) {
  const auto whole = static_cast<long>(std::lround(seconds));
  return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
}

std::string how_it_was_made(const Options& options, const Results& results,
                            const std::vector<std::string>& remarks) {
  std::string html = "<h2>How this was made</h2>\n<pre>" + html_escaped(options.command) +
                     "</pre>\n<p>terrain-paper " MRPT_TERRAIN_VERSION ", " +
                     std::to_string(results.trials) + " scans per scene and condition, seed " +
                     std::to_string(options.seed) + ", inlier distance T_q " +
                     fixed(1e3 * options.inlier_distance, 1) + " mm, " +
                     std::to_string(options.resamples) + " bootstrap resamples; it took " +
                     seconds_text(results.seconds) +
                     ". Each scan is one turn of a simulated HDL-32E, level at 0.81 m, with range "
                     "noise and nothing else; scenes are in params/scenes, the description is that "
                     "of params/paper.ini. All numbers are in <a href=\"tables.csv\">tables.csv</a>"
                     ", all angles in <a href=\"estimates.csv\">estimates.csv</a>; scripts and "
                     "data of the figures are in <code>figures/</code>.</p>\n";
  for (const std::string& remark : remarks) html += "<p>" + html_escaped(remark) + "</p>\n";
  return html;
}

constexpr const char* kReading =
    "<h2>How to read the tables</h2>\n<p>diff is ours minus published; in Tables 2 and 3 of the "
    "magnitudes. The verdicts compare our estimators (<b>beam</b>: angle against the robot's "
    "horizontal; <b>to ground</b>: against the ground seen in the same scan) with the method of "
    "the row, in the same scans: <i>better</i> and <i>worse</i> if the 95 % bootstrap interval of "
    "the paired difference leaves out zero, <i>tie</i> otherwise. bias compares the magnitudes of "
    "the mean errors. Angles are in degrees, variances in degrees squared.</p>\n";

std::string anchor(const std::string& kind, std::size_t k) { return kind + std::to_string(k + 1); }

std::string number_of(const Figure& figure) {
  return std::to_string(std::stoi(figure.name.substr(figure.name.size() - 2)));
}

std::string link(const std::string& to, const std::string& text) {
  return "<li><a href=\"#" + to + "\">" + html_escaped(text) + "</a></li>\n";
}

// Tables of intervals are left out: each follows the table that it belongs to.
std::string contents(const std::vector<TextTable>& tables, const std::vector<Figure>& figures) {
  std::string html = "<nav>\n<h2>Contents</h2>\n<ul>\n";
  for (std::size_t k = 0; k < tables.size(); ++k) {
    const std::string& title = tables[k].title;
    const bool of_intervals = title.compare(0, 4, "95 %") == 0;
    if (!of_intervals) html += link(anchor("table", k), title.substr(0, title.rfind(';')));
  }
  for (std::size_t k = 0; k < figures.size(); ++k) {
    html += link(anchor("figure", k), "Figure " + number_of(figures[k]));
  }
  return html + "</ul>\n</nav>\n";
}

std::string picture(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(stream), {}};
  std::string text;
  mrpt::system::encodeBase64(bytes, text);
  text.erase(std::remove(text.begin(), text.end(), '\n'), text.end());
  return "data:image/png;base64," + text;
}

std::string figure_html(const Options& options, const Figure& figure) {
  const std::string path = "figures/" + figure.name;
  const std::string file = (std::filesystem::path(options.output_dir) / (path + ".png")).string();
  const std::string name = "Figure " + number_of(figure);
  return "<figure><a href=\"" + path + ".svg\"><img src=\"" + picture(file) + "\" alt=\"" + name +
         "\"></a>\n<figcaption>" + name + ". " + html_escaped(figure.caption) +
         "</figcaption></figure>\n";
}

}  // namespace

std::string report_html(const Options& options, const Results& results,
                        const std::vector<TextTable>& tables, const std::vector<Figure>& figures,
                        const std::vector<std::string>& remarks) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width\">\n"
      "<title>Terrain description: the paper's experiments repeated</title>\n<style>";
  html += kStyle;
  html +=
      "</style>\n</head>\n<body>\n<h1>Terrain description: the paper's experiments repeated</h1>\n"
      "<p>Tables 2 to 5 and Figures 6 to 14 of X. Meng, Z. Cao, S. Liang, L. Pang, S. Wang, C. "
      "Zhou, <i>A terrain description method for traversability analysis based on elevation grid "
      "map</i>, Int. J. of Advanced Robotic Systems, 2018, DOI 10.1177/1729881417751530, repeated "
      "in simulation.</p>\n";
  html += how_it_was_made(options, results, remarks) + kReading + contents(tables, figures);
  html += "<h2>Tables</h2>\n";
  for (std::size_t k = 0; k < tables.size(); ++k) html += as_html(tables[k], anchor("table", k));
  if (!figures.empty()) html += "<h2>Figures</h2>\n";
  for (std::size_t k = 0; k < figures.size(); ++k) {
    html +=
        "<div id=\"" + anchor("figure", k) + "\">" + figure_html(options, figures[k]) + "</div>\n";
  }
  return html + "</body>\n</html>\n";
}
