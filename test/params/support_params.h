// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace mrpt_terrain::params {

/// Message of the exception that `action` throws; fails the test if it throws none.
template <class Exception, class Action>
std::string message_of(Action&& action) {
  try {
    action();
  } catch (const Exception& error) {
    return error.what();
  }
  ADD_FAILURE() << "no exception";
  return {};
}

/// A fresh folder for the files of one test.
inline std::filesystem::path fresh_folder() {
  const auto* info = testing::UnitTest::GetInstance()->current_test_info();
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) /
                                       (std::string(info->test_suite_name()) + "." + info->name());
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

/// Writes a file into a fresh folder and gives its name.
inline std::string write_file(const std::string& name, const std::string& text) {
  const std::filesystem::path file = fresh_folder() / name;
  std::ofstream(file, std::ios::binary) << text;
  return file.string();
}

}  // namespace mrpt_terrain::params
