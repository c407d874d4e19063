// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app_params.h"
#include "mrpt_terrain/core/unseen_reason.h"
#include "mrpt_terrain/files/whole_file.h"
#include "mrpt_terrain/io/ply.h"
#include "mrpt_terrain/view/run_summary.h"
#include "mrpt_terrain/view/scan_record.h"

/// A described scan that waits to be drawn.
struct DrawableScan {
  mrpt_terrain::view::ScanRecord record;
  mrpt_terrain::Points points;
  mrpt_terrain::Description description;
  std::vector<mrpt_terrain::UnseenReason> unseen;  ///< per `CellId`; empty in paper mode
};

/// A scan that was drawn.
struct View {
  std::string why;  ///< such as "first scan"
  std::string picture;
};

/// The colours of pictures for the points of labelled clouds.
[[nodiscard]] mrpt_terrain::io::PointPalette label_colours();

/// The folder with everything that `process` writes. Tables grow while the run goes on and get
/// their names in `finish`; views appear one by one.
class Outputs {
 public:
  /// Makes the folder. Throws std::runtime_error if it cannot be written to.
  Outputs(std::string folder, const AppParams& params);

  void add_rows(const mrpt_terrain::view::ScanRecord& record,
                const mrpt_terrain::Description& description);
  /// Writes `scan_NNNNNN.png`, `.3Dscene` and `.ply`, once per scan; `why` is for the user.
  void write_views(const mrpt_terrain::view::ScanRecord& record, const mrpt_terrain::Points& points,
                   const mrpt_terrain::Description& description,
                   const std::vector<mrpt_terrain::UnseenReason>& unseen, const std::string& why);
  /// Completes the tables and writes `summary.json`.
  void finish(const mrpt_terrain::view::RunSummary& summary);

  [[nodiscard]] const std::vector<View>& views() const { return views_; }
  [[nodiscard]] const std::string& folder() const { return folder_; }

 private:
  std::string folder_;
  mrpt_terrain::DescriptionParams params_;
  mrpt_terrain::files::WholeFile clusters_;
  mrpt_terrain::files::WholeFile scans_;
  std::unique_ptr<mrpt_terrain::files::WholeFile> holes_;  ///< in field mode
  std::vector<View> views_;
};
