// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace mrpt_terrain::view {
namespace {

constexpr double kFirstAbsoluteStamp = 1e8;  // March 1973
constexpr std::int64_t kMillisecondsPerDay = 86'400'000;

template <class Number>
std::string shortest_text(Number value) {
  if (!std::isfinite(value)) return {};
  // The exponent form only where the plain one would be a row of zeros.
  const auto size = std::abs(value);
  const bool is_plain =
      size == 0 || (size >= static_cast<Number>(1e-6) && size < static_cast<Number>(1e15));
  const auto format = is_plain ? std::chars_format::fixed : std::chars_format::scientific;
  std::array<char, 64> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, format).ptr;
  return {buffer.data(), end};
}

struct Date {
  std::int64_t year = 0;
  int month = 0;
  int day = 0;
};

bool is_leap(std::int64_t year) { return (year % 4 == 0 && year % 100 != 0) || year % 400 == 0; }

Date date_of(std::int64_t days_since_1970) {
  Date date{1970, 1, 1};
  auto days = days_since_1970;
  for (; days >= (is_leap(date.year) ? 366 : 365); ++date.year) {
    days -= is_leap(date.year) ? 366 : 365;
  }
  std::array<int, 12> lengths{{31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31}};
  if (is_leap(date.year)) lengths[1] = 29;
  std::size_t month = 0;
  for (; days >= lengths[month]; ++month) days -= lengths[month];
  date.month = static_cast<int>(month) + 1;
  date.day = static_cast<int>(days) + 1;
  return date;
}

std::string padded(std::int64_t value, std::size_t digits) {
  std::string text = std::to_string(value);
  if (text.size() < digits) text.insert(0, digits - text.size(), '0');
  return text;
}

/// Length of the valid UTF-8 sequence at the start of `text`, or 0.
std::size_t sequence_length(std::string_view text) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const unsigned first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7F ? 1 : 0;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < length) return 0;
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(k) & 0xC0U) != 0x80U) return 0;
  }
  const unsigned second = byte(1);
  const bool overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
  const bool surrogate = first == 0xED && second >= 0xA0;
  const bool beyond = first == 0xF4 && second >= 0x90;
  return overlong || surrogate || beyond ? 0 : length;
}

}  // namespace

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return {};
  std::array<char, 400> buffer{};  // the largest double has 309 digits before the point
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 std::chars_format::fixed, decimals)
                       .ptr;
  std::string text(buffer.data(), end);
  const bool is_zero = text.find_first_of("123456789") == std::string::npos;
  return is_zero && text.front() == '-' ? text.substr(1) : text;
}

std::string shortest(double value) { return shortest_text(value); }
std::string shortest(float value) { return shortest_text(value); }

std::string grouped(std::size_t count) {
  std::string text = std::to_string(count);
  for (auto place = static_cast<std::ptrdiff_t>(text.size()) - 3; place > 0; place -= 3) {
    text.insert(static_cast<std::size_t>(place), 1, ' ');
  }
  return text;
}

std::string time_text(double stamp) {
  if (!std::isfinite(stamp)) return {};
  if (stamp < kFirstAbsoluteStamp || stamp > 1e11) return "t = " + fixed(stamp, 3) + " s";
  const auto milliseconds = static_cast<std::int64_t>(std::llround(stamp * 1e3));
  const Date date = date_of(milliseconds / kMillisecondsPerDay);
  const std::int64_t of_day = milliseconds % kMillisecondsPerDay;
  return padded(date.year, 4) + "-" + padded(date.month, 2) + "-" + padded(date.day, 2) + " " +
         padded(of_day / 3'600'000, 2) + ":" + padded(of_day / 60'000 % 60, 2) + ":" +
         padded(of_day / 1000 % 60, 2) + "." + padded(of_day % 1000, 3) + " UTC";
}

std::string printable(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t length = sequence_length(text);
    result += length == 0 ? std::string_view("?") : text.substr(0, length);
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return result;
}

std::string base_name(std::string_view path) {
  while (path.size() > 1 && path.back() == '/') path.remove_suffix(1);
  const auto slash = path.rfind('/');
  const bool has_folder = slash != std::string_view::npos && path.size() > 1;
  return std::string(has_folder ? path.substr(slash + 1) : path);
}

double round_step(double least) {
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  // The factor just below 1 keeps 0.1 + 0.2 from becoming 0.5.
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * power >= least * (1.0 - 1e-9)) return digit * power;
  }
  return 10.0 * power;
}

int decimals_of(double step) {
  return std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
}

}  // namespace mrpt_terrain::view
