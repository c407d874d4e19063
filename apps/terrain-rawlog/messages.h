// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "progress_bar.h"

/// How much is said, named as MRPT's programs name it.
enum class Verbosity { kError, kWarn, kInfo, kDebug };

/// What the program tells its user: results on standard output, problems on standard error, both
/// in step with the progress bar.
class Messages {
 public:
  explicit Messages(Verbosity level) : level_(level), bar_(level >= Verbosity::kInfo) {}

  void error(const std::string& text);
  void warn(const std::string& text);
  /// Results and news; `text` carries its own line breaks.
  void info(const std::string& text);
  void debug(const std::string& text);
  [[nodiscard]] bool shows(Verbosity level) const { return level <= level_; }
  ProgressBar& bar() { return bar_; }

 private:
  Verbosity level_;
  ProgressBar bar_;
};
