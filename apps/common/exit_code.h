// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Exit codes of all programs; their `--help` says what they mean there.
enum ExitCode : int {
  kExitOk = 0,
  kExitUsage = 2,       ///< command line or configuration wrong; nothing was done
  kExitInput = 3,       ///< an input is missing, cut off or damaged; what came before it is written
  kExitIncomplete = 4,  ///< finished, but not all scans could be used as asked
  kExitOutput = 5,      ///< an output cannot be written
  kExitInterrupted = 130
};
