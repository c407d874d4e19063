// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "results.h"

/// A figure of the paper: a gnuplot script and the data that it reads, all in one folder.
struct Figure {
  std::string name;     ///< "figure_06"; the script is NAME.gp, the pictures NAME.svg and NAME.png
  std::string caption;  ///< what is seen, for the report
  std::string script;
  struct Data {
    std::string file;
    std::string content;
  };
  std::vector<Data> data;
};

/// The figures that can be made of the results.
[[nodiscard]] std::vector<Figure> paper_figures(const Results& results);
