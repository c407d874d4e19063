// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// From now on Ctrl-C and SIGTERM ask the program to finish what it is at and write its files; a
/// second Ctrl-C ends it at once. A closed pipe no longer ends the program.
void install_stop_signals();

/// Whether the program was asked to stop.
[[nodiscard]] bool stop_requested();
