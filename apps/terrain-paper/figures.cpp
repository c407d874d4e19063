// SPDX-License-Identifier: BSD-3-Clause
#include "figures.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>

#include "mrpt_terrain/eval/published_tables.h"
#include "mrpt_terrain/view/text.h"

namespace {

namespace eval = mrpt_terrain::eval;
using mrpt_terrain::view::fixed;

// As in the paper, whatever the number of trials.
constexpr std::size_t kPlottedTrials = 50;

constexpr const char* kRed = "#d62728";
constexpr const char* kGreen = "#2ca02c";
constexpr const char* kBlue = "#1f77b4";

std::string quoted(const std::string& text) { return "\"" + text + "\""; }

// The second pass begins as the first did.
constexpr const char* kReset =
    "set key on\nset size noratio\nset xrange [*:*]\nset yrange [*:*]\nset ytics auto\n";

// The two terminals one after the other; `body` draws one multiplot. Names of the output files can
// be given from outside (gnuplot -e).
std::string script_of(const std::string& name, int width, int height, const std::string& body) {
  const std::string size = std::to_string(width) + "," + std::to_string(height);
  return "# Makes " + name + ".svg and " + name + ".png: gnuplot " + name +
         ".gp\n"
         "if (!exists(\"svg_file\")) svg_file = \"" +
         name +
         ".svg\"\n"
         "if (!exists(\"png_file\")) png_file = \"" +
         name +
         ".png\"\n"
         "set encoding utf8\n"
         "set tics nomirror\nset border 3\nset grid lt 1 lc rgb \"#e0e0e0\"\n"
         "do for [pass = 1:2] {\n"
         "if (pass == 1) {\n"
         "  set terminal svg size " +
         size +
         " font \"DejaVu Sans,13\" background \"white\"\n"
         "  set output svg_file\n"
         "} else {\n"
         "  set terminal pngcairo size " +
         size +
         " font \"DejaVu Sans,10\" background \"white\"\n"
         "  set output png_file\n"
         "}\n" +
         body +
         "unset multiplot\n"
         "unset output\n"
         "}\n";
}

/// Rectangle in a plane, metres.
struct Window {
  double x0, x1, y0, y1;
};

bool is_inside(const Window& window, const mrpt_terrain::Points& points, std::size_t i) {
  return points.x[i] >= window.x0 && points.x[i] <= window.x1 && points.y[i] >= window.y0 &&
         points.y[i] <= window.y1;
}

/// One colour of a cloud.
struct Layer {
  std::string title;
  const char* colour;
  int number;            ///< as in ScanPicture
  bool in_front = true;  ///< whether the front view shows it
};
using PointColour = std::vector<int> eval::ScanPicture::*;

// Points of the layers, one gnuplot index each; a layer without points keeps its index.
Figure::Data cloud_data(const std::string& file, const SceneCloud& cloud, PointColour colour,
                        const Window& window, const std::vector<Layer>& layers) {
  std::string text = "# x y z of one scan, metres, robot frame; one block per colour\n";
  const eval::ScanPicture& picture = cloud.picture;
  for (const Layer& layer : layers) {
    text += "# " + layer.title + "\n";
    std::size_t count = 0;
    for (std::size_t i = 0; i < picture.points.size(); ++i) {
      if ((picture.*colour)[i] != layer.number || !is_inside(window, picture.points, i)) continue;
      ++count;
      text += fixed(picture.points.x[i], 4) + " " + fixed(picture.points.y[i], 4) + " " +
              fixed(picture.points.z[i], 4) + "\n";
    }
    if (count == 0) text += "NaN NaN NaN\n";
    text += "\n\n";
  }
  return {file, text};
}

// What surrounds the targets by `margin`, in the ground plane.
Window window_of(const SceneCloud& cloud, double margin) {
  constexpr double kFar = std::numeric_limits<double>::max();
  Window window{kFar, -kFar, kFar, -kFar};
  const eval::ScanPicture& picture = cloud.picture;
  for (std::size_t i = 0; i < picture.points.size(); ++i) {
    if (picture.source[i] < 0) continue;
    window.x0 = std::min(window.x0, picture.points.x[i] - margin);
    window.x1 = std::max(window.x1, picture.points.x[i] + margin);
    window.y0 = std::min(window.y0, picture.points.y[i] - margin);
    window.y1 = std::max(window.y1, picture.points.y[i] + margin);
  }
  return window.x0 < window.x1 ? window : Window{-2.5, 2.5, -2.5, 2.5};
}

std::string range(double low, double high) {
  return "[" + fixed(low, 3) + ":" + fixed(high, 3) + "]";
}

// With a key also for colours of which there are no points.
std::string layers_plot(const std::string& file, const std::string& columns,
                        const std::vector<Layer>& layers, bool front) {
  std::string plot;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    if (front && !layers[k].in_front) continue;
    const std::string colour = quoted(layers[k].colour);
    plot += (plot.empty() ? "plot " : ", ") + quoted(file) + " index " + std::to_string(k) +
            " using " + columns + " with points pt 7 ps 0.25 lc rgb " + colour +
            " notitle, NaN with points pt 7 ps 1 lc rgb " + colour + " title " +
            quoted(layers[k].title);
  }
  return plot + "\n";
}

/// Layout of the panels of a figure, pixels.
struct Layout {
  int rows, columns;
  int width, height;  ///< of the picture
};

// A multiplot with room for one line of keys below all panels.
std::string panels(const Layout& layout) {
  const double unit = 1.0 / layout.height;
  const double top = 1.0 - 40.0 * unit;
  const double bottom = 100.0 * unit;
  return "set multiplot layout " + std::to_string(layout.rows) + "," +
         std::to_string(layout.columns) + " margins " + fixed(80.0 / layout.width, 3) + "," +
         fixed(1.0 - 20.0 / layout.width, 3) + "," + fixed(bottom, 3) + "," + fixed(top, 3) +
         " spacing " + fixed(90.0 / layout.width, 3) + "," + fixed(100.0 * unit, 3) +
         "\nset key at screen 0.5," + fixed(15.0 * unit, 4) +
         " center bottom horizontal maxrows 1\n";
}

// Left: seen from above, y to the left as the robot sees it. Right: seen along x. Only the first
// plot of a figure draws the key.
std::string views(const std::string& file, const std::string& what, const Window& window,
                  const std::vector<Layer>& layers) {
  const std::string leftwards = range(window.y1, window.y0);
  return "set size ratio -1\nset title " + quoted(what + ", top view") +
         "\nset xlabel \"y, m\"\nset ylabel \"x, m\"\nset xrange " + leftwards + "\nset yrange " +
         range(window.x0, window.x1) + "\n" + layers_plot(file, "2:1", layers, false) +
         "set key off\nset size noratio\nset title " + quoted(what + ", front view") +
         "\nset xlabel \"y, m\"\nset ylabel \"z, m\"\nset xrange " + leftwards +
         "\nset yrange [*:*]\n" + layers_plot(file, "2:3", layers, true);
}

const SceneCloud* cloud_of(const Results& results, const std::string& target) {
  const auto found =
      std::find_if(results.clouds.begin(), results.clouds.end(), [&](const SceneCloud& cloud) {
        return std::find(cloud.targets.begin(), cloud.targets.end(), target) != cloud.targets.end();
      });
  return found == results.clouds.end() ? nullptr : &*found;
}

std::string at_noise(const Results& results) {
  return "range noise " + fixed(1e3 * results.figure_sigma, 0) + " mm";
}

// Figures 6 and 8: one scene in two views.
Figure scene_figure(const std::string& name, const std::string& caption, const SceneCloud& cloud,
                    const std::string& what, const std::vector<Layer>& layers) {
  const Window window = window_of(cloud, 0.35);
  const Layout layout{2, 1, 900, 900};
  Figure figure{name,
                caption,
                {},
                {cloud_data(name + ".dat", cloud, &eval::ScanPicture::source, window, layers)}};
  figure.script = script_of(name, layout.width, layout.height,
                            panels(layout) + views(name + ".dat", what, window, layers) + kReset);
  return figure;
}

// Figures 11 and 13: three slopes in two views each.
std::optional<Figure> slopes_figure(const Results& results, const std::string& name,
                                    const std::vector<std::string>& slopes) {
  const auto rows = static_cast<int>(slopes.size());
  const Layout layout{rows, 2, 1000, 430 * rows};
  std::string body = panels(layout);
  Figure figure{name,
                "Point clouds of the slopes, top and front view (" + at_noise(results) +
                    "). Blue: the cluster whose angle is estimated; grey: ground; orange: other "
                    "clusters.",
                {},
                {}};
  const std::vector<Layer> layers = {{"ground", "#b0b0b0", eval::ScanPicture::kGround},
                                     {"other clusters", "#ff7f0e", eval::ScanPicture::kOther},
                                     {"slope", kBlue, 0}};
  for (const std::string& slope : slopes) {
    const SceneCloud* cloud = cloud_of(results, slope);
    if (cloud == nullptr) return std::nullopt;
    const std::string file = name + "_" + slope + ".dat";
    const Window window = window_of(*cloud, 0.35);
    figure.data.push_back(cloud_data(file, *cloud, &eval::ScanPicture::cluster, window, layers));
    body += views(file, "slope " + slope, window, layers);
  }
  figure.script = script_of(name, layout.width, layout.height, body + kReset);
  return figure;
}

std::string cell(const eval::Series& series, std::size_t trial) {
  const bool known = trial < series.size() && series[trial];
  return known ? fixed(*series[trial], 5) : "NaN";
}

// One line per trial, one column per series.
Figure::Data series_data(const std::string& file, const std::string& header,
                         const std::vector<const eval::Series*>& columns) {
  std::string text = "# trial " + header + "\n";
  std::size_t trials = 0;
  for (const eval::Series* series : columns) trials = std::max(trials, series->size());
  for (std::size_t k = 0; k < std::min(trials, kPlottedTrials); ++k) {
    text += std::to_string(k + 1);
    for (const eval::Series* series : columns) text += " " + cell(*series, k);
    text += "\n";
  }
  return {file, text};
}

// Without a truth only the key shows the line.
std::string truth_plot(const std::optional<double>& truth) {
  return (truth ? fixed(*truth, 4) : "NaN") + " with lines lw 2 lc rgb " + quoted(kBlue) +
         " title \"truth\"";
}

const TargetSeries* series_of(const Results& results, const std::string& target) {
  const auto found =
      std::find_if(results.series.begin(), results.series.end(),
                   [&](const TargetSeries& series) { return series.target == target; });
  return found == results.series.end() ? nullptr : &*found;
}

// Figures 7 and 9: one panel per target, its values over the trials and the truth if it has one.
struct Panel {
  std::string title;
  std::string axis;
  const eval::Series* series;
  std::optional<double> truth;
};

Figure panels_figure(const std::string& name, const std::string& caption,
                     const std::vector<Panel>& items) {
  Figure figure{name, caption, {}, {}};
  std::vector<const eval::Series*> columns;
  std::string header;
  const auto columns_of_panels = static_cast<int>(items.size());
  const Layout layout{1, columns_of_panels, 430 * columns_of_panels, 400};
  std::string body = panels(layout) + "set xlabel \"measurement\"\n";
  for (std::size_t k = 0; k < items.size(); ++k) {
    if (k == 1) body += "set key off\n";
    columns.push_back(items[k].series);
    header += (k == 0 ? "" : " ") + quoted(items[k].title);
    body += "set title " + quoted(items[k].title) + "\nset ylabel " + quoted(items[k].axis) +
            "\nplot " + quoted(name + ".dat") + " using 1:" + std::to_string(k + 2) +
            " with linespoints pt 7 ps 0.5 lc rgb " + quoted(kRed) + " title \"measured\", " +
            truth_plot(items[k].truth) + "\n";
  }
  figure.data.push_back(series_data(name + ".dat", header, columns));
  figure.script = script_of(name, layout.width, layout.height, body + kReset);
  return figure;
}

// Without the blue of the truth and the red of the paper's method.
constexpr const char* kColours[] = {"#17becf", "#ff7f0e", "#2ca02c", "#9467bd", "#8c564b",
                                    "#e377c2", "#7f7f7f", "#bcbd22", "#aec7e8"};

// Figure 10: height index and roughness of all clusters.
Figure features_figure(const Results& results, const std::vector<const TargetSeries*>& clusters) {
  const std::string name = "figure_10";
  Figure figure{name,
                "Height index and roughness of clusters 1 to 5 over the measurements (" +
                    at_noise(results) +
                    "). All are above T_pos = 5 cm; flat ones are slopes, rough ones obstacles.",
                {},
                {}};
  std::vector<const eval::Series*> columns;
  std::string header;
  std::string heights = "plot 5 with lines dt 2 lc rgb \"black\" title \"T_{pos}\"";
  std::string roughness = "plot ";
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    columns.insert(columns.end(), {&clusters[k]->height_index, &clusters[k]->rough});
    header += quoted(clusters[k]->target + " height index, cm") + " " +
              quoted(clusters[k]->target + " R_n") + " ";
    const std::string style = " with linespoints pt 7 ps 0.4 lc rgb " + quoted(kColours[k]);
    heights += ", " + quoted(name + ".dat") + " using 1:" + std::to_string(2 * k + 2) + style +
               " title " + quoted(clusters[k]->target);
    // One line per cluster: its number, and 0.6 more where it is rough.
    roughness += (k == 0 ? "" : ", ") + quoted(name + ".dat") + " using 1:(" +
                 std::to_string(k + 1) + " + 0.6 * $" + std::to_string(2 * k + 3) + ")" + style +
                 " notitle";
  }
  std::string tics;
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    const std::string number = std::to_string(k + 1);
    tics += (k == 0 ? "" : ", ") + quoted(clusters[k]->target + ": 0") + " " + number + ", " +
            quoted("1") + " " + number + ".6";
  }
  figure.data.push_back(series_data(name + ".dat", header, columns));
  const Layout layout{1, 2, 1100, 460};
  figure.script = script_of(
      name, layout.width, layout.height,
      panels(layout) +
          "set xlabel \"measurement\"\n"
          "set title \"(a) height index\"\nset ylabel \"H_f, cm\"\nset yrange [0:*]\n" +
          heights +
          "\nset title \"(b) roughness R_n\"\nunset ylabel\nset key off\nset yrange [0.7:" +
          fixed(static_cast<double>(clusters.size()) + 0.9, 1) + "]\nset ytics (" + tics + ")\n" +
          roughness + "\n" + kReset);
  return figure;
}

const eval::SlopeResult* slope_of(const Results& results, const std::string& slope) {
  const auto found =
      std::find_if(results.slopes.begin(), results.slopes.end(), [&](const SlopeBlock& block) {
        return block.result.slope == slope && block.result.conditions.tilt_sigma == 0.0 &&
               block.result.conditions.range_sigma == results.figure_sigma;
      });
  return found == results.slopes.end() ? nullptr : &found->result;
}

std::string method_style(const std::string& method, std::size_t number) {
  if (method == "paper_method") return " with linespoints pt 7 ps 0.4 lw 2 lc rgb \"#d62728\"";
  if (method == eval::kBeam) return " with linespoints pt 5 ps 0.4 lw 2 lc rgb \"black\"";
  if (method == eval::kBeamToGround) return " with lines dt 3 lw 2 lc rgb \"black\"";
  return " with linespoints pt 7 ps 0.25 lc rgb " + quoted(kColours[number % 9]);
}

// Figures 12 and 14: estimates of all methods on three slopes.
std::optional<Figure> estimates_figure(const Results& results, const std::string& name,
                                       const std::vector<std::string>& slopes) {
  Figure figure{name,
                "Estimates of all methods over the measurements (" + at_noise(results) +
                    "). Red: the paper's method; black: ours; blue line: truth.",
                {},
                {}};
  std::string body = "set multiplot layout " + std::to_string(slopes.size()) +
                     ",1 margins 0.08,0.76,0.06,0.96 spacing 0,0.08\n"
                     "set ylabel \"slope angle, deg\"\nset xlabel \"measurement\"\n";
  for (std::size_t panel = 0; panel < slopes.size(); ++panel) {
    const eval::SlopeResult* result = slope_of(results, slopes[panel]);
    if (result == nullptr) return std::nullopt;
    const std::string file = name + "_" + slopes[panel] + ".dat";
    std::vector<const eval::Series*> columns;
    std::string header;
    std::string plot = "plot ";
    for (std::size_t k = 0; k < result->rows.size(); ++k) {
      columns.push_back(&result->rows[k].summary.series);
      header += result->rows[k].method + " ";
      plot += quoted(file) + " using 1:" + std::to_string(k + 2) +
              method_style(result->rows[k].method, k) + " title " + quoted(result->rows[k].method) +
              " noenhanced, ";
    }
    figure.data.push_back(series_data(file, header, columns));
    body += panel == 0 ? "set key at screen 0.78,0.96 left top vertical\n" : "set key off\n";
    body += "set title \"slope " + slopes[panel] + "\"\n" + plot + truth_plot(result->truth) + "\n";
  }
  body += kReset;
  figure.script = script_of(name, 1000, 330 * static_cast<int>(slopes.size()), body);
  return figure;
}

void add_height_figures(const Results& results, std::vector<Figure>& figures) {
  const SceneCloud* cloud = cloud_of(results, "obstacle");
  const TargetSeries* obstacle = series_of(results, "obstacle");
  const TargetSeries* pothole = series_of(results, "pothole");
  if (cloud == nullptr || obstacle == nullptr || pothole == nullptr) return;
  figures.push_back(scene_figure(
      "figure_06",
      "Point cloud of an obstacle and a pothole, top and front view (" + at_noise(results) + ").",
      *cloud, "obstacle and pothole",
      {{"ground", "#b0b0b0", eval::ScanPicture::kGround},
       {"other clusters", "#ff7f0e", eval::ScanPicture::kOther},
       {"obstacle", kRed, 0},
       {"pothole", kGreen, 1}}));
  figures.push_back(
      panels_figure("figure_07",
                    "Height index of the obstacle and the pothole over the measurements (" +
                        at_noise(results) + ").",
                    {{"(a) obstacle", "H_f, cm", &obstacle->height_index, obstacle->height},
                     {"(b) pothole", "H_f, cm", &pothole->height_index, pothole->height}}));
}

void add_cluster_figures(const Results& results, std::vector<Figure>& figures) {
  const SceneCloud* cloud = cloud_of(results, "cluster 1");
  std::vector<const TargetSeries*> clusters;
  for (int number = 1; number <= 5; ++number) {
    const TargetSeries* series = series_of(results, "cluster " + std::to_string(number));
    if (series != nullptr) clusters.push_back(series);
  }
  if (cloud == nullptr || clusters.size() != 5) return;
  figures.push_back(scene_figure(
      "figure_08",
      "Point cloud of three obstacles (1, 2, 4) and two slopes (3, 5), top view, and front view of "
      "clusters 3 and 4 (" +
          at_noise(results) + ").",
      *cloud, "five clusters",
      {{"ground", "#b0b0b0", eval::ScanPicture::kGround},
       {"cluster 1", "#8c1c13", 0, false},
       {"cluster 2", kRed, 1, false},
       {"cluster 3", kBlue, 2},
       {"cluster 4", "#e8697c", 3},
       {"cluster 5", "#17becf", 4, false}}));
  std::vector<Panel> panels;
  for (const std::size_t k : {1, 2, 3}) {
    const std::optional<double> truth =
        k == 2 ? std::optional<double>(clusters[k]->slope) : std::nullopt;
    panels.push_back(
        {"cluster " + std::to_string(k + 1), "slope angle, deg", &clusters[k]->angle, truth});
  }
  figures.push_back(panels_figure(
      "figure_09",
      "Slope angle of clusters 2, 3 and 4 over the measurements (" + at_noise(results) +
          "); only cluster 3 is a slope. Planes are fitted along z, to the letter.",
      panels));
  figures.push_back(features_figure(results, clusters));
}

}  // namespace

std::vector<Figure> paper_figures(const Results& results) {
  std::vector<Figure> figures;
  add_height_figures(results, figures);
  add_cluster_figures(results, figures);
  const std::vector<std::string> plain = {"A", "B", "C"};
  const std::vector<std::string> disturbed = {"A1", "A2", "A3"};
  for (auto figure :
       {slopes_figure(results, "figure_11", plain), estimates_figure(results, "figure_12", plain),
        slopes_figure(results, "figure_13", disturbed),
        estimates_figure(results, "figure_14", disturbed)}) {
    if (figure) figures.push_back(std::move(*figure));
  }
  return figures;
}
