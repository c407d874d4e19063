// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>

#include "exit_code.h"
#include "options.h"
#include "program.h"
#include "verbosity_option.h"

namespace {

void add_options(CLI::App& app, Options& options) {
  app.add_option("-n,--trials", options.trials, "Scans per scene and condition; the paper has 50")
      ->check(CLI::Range(1, 1000000).description(""))
      ->capture_default_str();
  app.add_option("--threads", options.threads, "The results do not depend on it")
      ->check(CLI::Range(1, 256).description(""))
      ->capture_default_str();
  app.add_option("--seed", options.seed, "Of all random numbers")->capture_default_str();
  app.add_option("-o,--output-dir", options.output_dir, "Folder for all results")
      ->type_name("DIR")
      ->capture_default_str();
  app.add_option("--tables", options.tables, "Tables to make, with their figures")
      ->delimiter(',')
      ->check(CLI::Range(2, 5).description(""))
      ->type_name("N,...")
      ->capture_default_str();
  app.add_option("--noise", options.noise_mm,
                 "Standard deviations of the ranges in mm (default: 0,2,5,10,20 for Tables 2 and "
                 "3; 5,20 for 4 and 5)")
      ->delimiter(',')
      ->check(CLI::Range(0.0, 1000.0).description(""))
      ->type_name("MM,...");
  app.add_option("--pose-jitter", options.tilt_deg,
                 "Standard deviation of roll and pitch in deg in additional rows of Tables 4 and "
                 "5; 0: none")
      ->check(CLI::Range(0.0, 10.0).description(""))
      ->type_name("DEG")
      ->capture_default_str();
  app.add_option("--inlier-distance", options.inlier_distance,
                 "T_q of the sampling estimators, metres")
      ->check(CLI::Range(0.0001, 1.0).description(""))
      ->type_name("M")
      ->capture_default_str();
  app.add_option("--lmeds-trials", options.lmeds_trials,
                 "Scans that LMEDS sees, which is slow (default: all)")
      ->type_name("N");
  app.add_option("--resamples", options.resamples, "Of the bootstrap")
      ->check(CLI::Range(40, 1000000).description(""))
      ->capture_default_str();
  app.add_flag("--refine", options.refine,
               "PCL's estimators refine their plane; as published they do not");
  app.add_flag("--no-figures", options.no_figures, "Tables only");
  add_verbosity(app, options.verbosity);
}

std::string joined(int argc, char** argv) {
  std::string text;
  for (int k = 0; k < argc; ++k) text += (k == 0 ? "" : " ") + std::string(argv[k]);
  return text;
}

int run(int argc, char** argv) {
  CLI::App app(
      "Repeats the experiments of Meng, Cao et al. 2018 in simulation: Tables 2 to 5, Figures 6 to "
      "14, and our slope estimator beside their nine.",
      "terrain-paper");
  app.footer(
      "Exit codes: 0 all well; 2 command line wrong; 3 a scene or sensor is missing or wrong; 4 "
      "tables\n"
      "are written, but not all figures; 5 output cannot be written; 130 interrupted (nothing is\n"
      "written, or no figures).");
  app.set_version_flag("--version", "terrain-paper " MRPT_TERRAIN_VERSION);
  Options options;
  add_options(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kExitOk : kExitUsage;
  }
  options.command = joined(argc, argv);
  return run_paper(options);
}

}  // namespace

int main(int argc, char** argv) { return run_program(run, argc, argv); }
