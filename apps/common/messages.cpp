// SPDX-License-Identifier: BSD-3-Clause
#include "messages.h"

#include <cstdio>

namespace {

constexpr std::size_t kSaidPerKind = 3;

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

void RepeatedWarnings::warn(const std::string& kind, const std::string& place,
                            const std::string& text) {
  Kind& known = kinds_[kind];
  if (known.said + known.unsaid == 0) known.first_place = place;
  const bool new_to_user = known.said < kSaidPerKind && text != known.last_text;
  if (!new_to_user && !messages_.shows(Verbosity::kDebug)) {
    ++known.unsaid;
    return;
  }
  ++known.said;
  known.last_text = text;
  messages_.warn(place + ": " + text);
}

void RepeatedWarnings::finish() {
  for (const auto& [kind, known] : kinds_) {
    if (known.unsaid == 0) continue;
    messages_.warn(known.first_place + ": and " + std::to_string(known.unsaid) +
                   " more of this kind");
  }
  kinds_.clear();
}
