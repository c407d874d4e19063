// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ostream>

#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/view/scan_record.h"

/// \file
/// clusters.csv, holes.csv and scans.csv: comma separated, one header line, lines end in "\n", text
/// quoted by RFC 4180 where it needs it. Numbers do not depend on the locale and read back exactly.
/// Metres, square metres and seconds; angles in degrees where the column's name says so. A field is
/// empty where there is no number to give (a feature whose status is not "ok").
namespace mrpt_terrain::view {

void write_clusters_csv_header(std::ostream& out);

/// One line per cluster of the scan; `cluster` is the cluster's number, as in pictures and tables.
void write_clusters_csv(std::ostream& out, const ScanRecord& scan, const Description& description);

void write_holes_csv_header(std::ostream& out);

/// One line per hole of a description of field mode, in their order; `cluster` is empty for those
/// in none. The depth is a lower bound.
void write_holes_csv(std::ostream& out, const ScanRecord& scan, const Description& description);

void write_scans_csv_header(std::ostream& out);

/// One line for the scan.
void write_scans_csv(std::ostream& out, const ScanRecord& scan);

}  // namespace mrpt_terrain::view
