// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <string>

/// One line on the terminal with a bar, what was done, and the time that is left. Draws nothing
/// when standard error is not a terminal.
class ProgressBar {
 public:
  explicit ProgressBar(bool wanted);
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// \param share done, 0 to 1
  /// \param text short, such as "12 scans"
  void show(double share, const std::string& text);
  /// Removes the bar, before something else is printed.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  bool active_;
  bool drawn_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_{};
};

/// "1:05" or "2:03:04".
[[nodiscard]] std::string duration_text(double seconds);
