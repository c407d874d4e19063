// SPDX-License-Identifier: BSD-3-Clause
#include "messages.h"

#include <cstdio>

namespace {

void print(std::FILE* stream, const std::string& text) {
  std::fputs(text.c_str(), stream);
  std::fflush(stream);
}

}  // namespace

void Messages::error(const std::string& text) {
  bar_.clear();
  print(stderr, "error: " + text + "\n");
}

void Messages::warn(const std::string& text) {
  if (!shows(Verbosity::kWarn)) return;
  bar_.clear();
  print(stderr, "warning: " + text + "\n");
}

void Messages::info(const std::string& text) {
  if (!shows(Verbosity::kInfo)) return;
  bar_.clear();
  print(stdout, text);
}

void Messages::debug(const std::string& text) {
  if (!shows(Verbosity::kDebug)) return;
  bar_.clear();
  print(stdout, text);
}
