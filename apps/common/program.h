// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// What `main` of every program does: Ctrl-C asks it to stop, and an exception that nobody else
/// handled, such as an output that cannot be written, is told and ends it with its exit code.
int run_program(int (*run)(int, char**), int argc, char** argv);
