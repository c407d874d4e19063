// SPDX-License-Identifier: BSD-3-Clause
#include "stop_signal.h"

#include <csignal>

namespace {

volatile std::sig_atomic_t g_stop = 0;

void request_stop(int signal) {
  g_stop = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void install_stop_signals() {
  std::signal(SIGINT, request_stop);
  std::signal(SIGTERM, request_stop);
  std::signal(SIGPIPE, SIG_IGN);
}

bool stop_requested() { return g_stop != 0; }
