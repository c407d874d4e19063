// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
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

/// Says the first few warnings of each kind and counts the others, so that thousands of scans with
/// the same trouble do not hide what else there is. At DEBUG all are said.
class RepeatedWarnings {
 public:
  explicit RepeatedWarnings(Messages& messages) : messages_(messages) {}

  /// \param kind what is counted together
  /// \param place file and entry
  /// \param text is said once as long as it stays the same
  void warn(const std::string& kind, const std::string& place, const std::string& text);
  /// Says how many there were that were not said, and begins anew.
  void finish();

 private:
  struct Kind {
    std::size_t said = 0, unsaid = 0;
    std::string first_place, last_text;
  };
  Messages& messages_;
  std::map<std::string, Kind> kinds_;
};
