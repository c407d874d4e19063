// SPDX-License-Identifier: BSD-3-Clause
#include "program.h"

#include <exception>
#include <iostream>

#include "exit_code.h"
#include "stop_signal.h"

int run_program(int (*run)(int, char**), int argc, char** argv) {
  install_stop_signals();
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << "\n";
    return kExitOutput;
  }
}
