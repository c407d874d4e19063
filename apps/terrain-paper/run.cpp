// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>

#include "exit_code.h"
#include "experiments.h"
#include "figures.h"
#include "gnuplot.h"
#include "messages.h"
#include "mrpt_terrain/files/atomic_file.h"
#include "options.h"
#include "paper_tables_text.h"
#include "report_files.h"
#include "report_page.h"
#include "stop_signal.h"

namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& content) {
  mrpt_terrain::files::write_atomically(file.string(), std::string_view(content));
}

/// Pictures that were made, and what went wrong with the others.
struct MadeFigures {
  std::vector<Figure> figures;
  std::vector<std::string> remarks;
};

MadeFigures make_figures(const Options& options, const Results& results, ProgressBar& bar) {
  MadeFigures made;
  const std::vector<Figure> wanted = paper_figures(results);
  const fs::path folder = fs::path(options.output_dir) / "figures";
  fs::create_directories(folder);
  for (const Figure& figure : wanted) {
    for (const Figure::Data& data : figure.data) write(folder / data.file, data.content);
    write(folder / (figure.name + ".gp"), figure.script);
  }
  const std::string gnuplot = find_gnuplot();
  if (gnuplot.empty()) {
    made.remarks.emplace_back(
        "No figures: gnuplot is not installed (Debian package gnuplot-nox). Scripts and data are "
        "in figures/.");
    return made;
  }
  for (std::size_t k = 0; k < wanted.size() && !stop_requested(); ++k) {
    bar.show(static_cast<double>(k) / static_cast<double>(wanted.size()), wanted[k].name);
    const std::string problem = run_gnuplot(gnuplot, folder, wanted[k].name);
    if (problem.empty())
      made.figures.push_back(wanted[k]);
    else
      made.remarks.push_back(problem);
  }
  bar.clear();
  return made;
}

std::string text_of(const std::vector<TextTable>& tables) {
  std::string text;
  for (const TextTable& table : tables) text += as_text(table) + "\n";
  return text;
}

void write_report(const Options& options, const Results& results,
                  const std::vector<TextTable>& tables, const MadeFigures& made,
                  const std::vector<std::string>& remarks) {
  const fs::path folder = options.output_dir;
  write(folder / "tables.txt", text_of(tables));
  write(folder / "tables.csv", tables_csv(results));
  write(folder / "estimates.csv", estimates_csv(results));
  write(folder / "report.html", report_html(options, results, tables, made.figures, remarks));
}

// What the user should know before the numbers.
std::vector<std::string> remarks_of(const Options& options) {
  std::vector<std::string> remarks;
  if (std::string missing = missing_estimators_text(); !missing.empty()) {
    remarks.push_back(std::move(missing));
  }
  if (options.lmeds_trials > 0 && options.lmeds_trials < options.trials) {
    remarks.push_back("lmeds sees the first " + std::to_string(options.lmeds_trials) + " of " +
                      std::to_string(options.trials) + " scans only, because it is slow.");
  }
  return remarks;
}

// Files of an earlier run are replaced one by one, each as a whole.
int report(const Options& options, const Results& results, std::vector<std::string> remarks,
           Messages& messages) {
  const std::vector<TextTable> tables = paper_tables(results);
  messages.info(text_of(tables));
  fs::create_directories(options.output_dir);
  MadeFigures made;
  if (!options.no_figures) made = make_figures(options, results, messages.bar());
  for (const std::string& remark : made.remarks) messages.warn(remark);
  if (stop_requested()) return kExitInterrupted;
  remarks.insert(remarks.end(), made.remarks.begin(), made.remarks.end());
  write_report(options, results, tables, made, remarks);
  messages.info("Written to " + options.output_dir + ": report.html, tables.txt, tables.csv, " +
                "estimates.csv, " + std::to_string(made.figures.size()) + " figures; " +
                duration_text(results.seconds) + " of scans\n");
  return made.remarks.empty() ? kExitOk : kExitIncomplete;
}

}  // namespace

int run_paper(const Options& options) {
  Messages messages(options.verbosity);
  std::vector<std::string> remarks = remarks_of(options);
  for (const std::string& remark : remarks) messages.warn(remark);
  Results results;
  try {
    results = run_experiments(options, [&messages](double share, const std::string& text) {
      messages.bar().show(share, text);
      return !stop_requested();
    });
  } catch (const std::exception& error) {
    messages.error(error.what());
    return kExitInput;
  }
  messages.bar().clear();
  if (!results.complete) {
    messages.warn("interrupted: nothing was written");
    return kExitInterrupted;
  }
  return report(options, results, std::move(remarks), messages);
}
