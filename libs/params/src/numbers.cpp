// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/params/numbers.h"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

namespace mrpt_terrain::params {
namespace {

constexpr long double kDegree = 3.141592653589793238462643383279502884L / 180.0L;

std::string_view without_plus(std::string_view text) {
  const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+';
  return plus ? text.substr(1) : text;
}

template <class Number>
NumberStatus read_whole(std::string_view text, Number& value) {
  text = without_plus(text);
  Number read{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), read);
  if (error == std::errc::invalid_argument || end != text.data() + text.size()) {
    return NumberStatus::kNotANumber;
  }
  if (error == std::errc::result_out_of_range) return NumberStatus::kUnrepresentable;
  value = read;
  return NumberStatus::kOk;
}

template <class Real>
NumberStatus read_finite(std::string_view text, Real& value) {
  Real read{};
  const NumberStatus status = read_whole(text, read);
  if (status != NumberStatus::kOk) return status;
  if (!std::isfinite(read)) return NumberStatus::kNotFinite;
  value = read;
  return NumberStatus::kOk;
}

// Enough for every digit of a long double of 1e-4 or more.
constexpr int kMostDecimals = 4 + std::numeric_limits<long double>::max_digits10;

std::string to_chars_text(long double value, std::chars_format format, int decimals) {
  std::array<char, 128> buffer{};
  char* const first = buffer.data();
  return {first, std::to_chars(first, first + buffer.size(), value, format, decimals).ptr};
}

double to_radians(long double degrees) { return static_cast<double>(degrees * kDegree); }

bool reads_well_without_exponent(double value) {
  const double size = std::abs(value);
  return value == 0.0 || (size >= 1e-4 && size < 1e7);
}

}  // namespace

NumberStatus parse(std::string_view text, double& value) { return read_finite(text, value); }
NumberStatus parse(std::string_view text, int& value) { return read_whole(text, value); }

NumberStatus parse(std::string_view text, std::uint64_t& value) {
  // from_chars of an unsigned type calls "-1" no number, but it is one that cannot be held.
  std::int64_t negative = 0;
  if (!text.empty() && text[0] == '-' && read_whole(text, negative) != NumberStatus::kNotANumber) {
    return NumberStatus::kUnrepresentable;
  }
  return read_whole(text, value);
}

NumberStatus parse_degrees(std::string_view text, double& radians) {
  long double degrees = 0.0L;
  const NumberStatus status = read_finite(text, degrees);
  if (status != NumberStatus::kOk) return status;
  if (!std::isfinite(to_radians(degrees))) return NumberStatus::kUnrepresentable;
  radians = to_radians(degrees);
  return NumberStatus::kOk;
}

std::string to_text(double value) {
  std::array<char, 64> buffer{};
  char* const first = buffer.data();
  char* const last = first + buffer.size();
  const auto result = reads_well_without_exponent(value)
                          ? std::to_chars(first, last, value, std::chars_format::fixed)
                          : std::to_chars(first, last, value);
  return {first, result.ptr};
}

std::string to_text_degrees(double radians) {
  if (!std::isfinite(radians)) return to_text(radians);
  const long double degrees = static_cast<long double>(radians) / kDegree;
  const auto format = reads_well_without_exponent(static_cast<double>(degrees))
                          ? std::chars_format::fixed
                          : std::chars_format::scientific;
  for (int decimals = 0; decimals < kMostDecimals; ++decimals) {
    std::string text = to_chars_text(degrees, format, decimals);
    double read = 0.0;
    if (parse_degrees(text, read) == NumberStatus::kOk && read == radians) return text;
  }
  return to_chars_text(degrees, format, kMostDecimals);
}

double radians_of(double degrees) {
  // By way of its text: 0.1 in double is not 0.1, and the bound 0.1 must equal what "0.1" reads as.
  double radians = degrees;  // stays so where degrees are not finite
  (void)parse_degrees(to_text(degrees), radians);
  return radians;
}

}  // namespace mrpt_terrain::params
