// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "test_files.h"

namespace mrpt_terrain::test {

/// What a program left behind.
struct ProgramResult {
  int exit_code = -1;  ///< 128 + signal if a signal ended it
  std::string out;     ///< standard output
  std::string err;     ///< standard error
  long max_resident_kib = 0;
};

/// A running program whose output goes to files in a folder.
class Program {
 public:
  Program(const std::filesystem::path& folder, std::vector<std::string> arguments)
      : out_(folder / "stdout.txt"), err_(folder / "stderr.txt") {
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_ = fork();
    if (pid_ != 0) return;
    redirect("/dev/null", O_RDONLY, STDIN_FILENO);
    redirect(out_, O_WRONLY | O_CREAT | O_TRUNC, STDOUT_FILENO);
    redirect(err_, O_WRONLY | O_CREAT | O_TRUNC, STDERR_FILENO);
    execv(argv[0], argv.data());
    _exit(127);
  }
  ~Program() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void send(int signal) const { kill(pid_, signal); }

  ProgramResult wait() {
    int status = 0;
    rusage usage{};
    wait4(std::exchange(pid_, -1), &status, 0, &usage);
    ProgramResult result;
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    result.out = read_file(out_);
    result.err = read_file(err_);
    result.max_resident_kib = usage.ru_maxrss;
    return result;
  }

 private:
  static void redirect(const std::filesystem::path& file, int flags, int to) {
    const int descriptor = open(file.c_str(), flags, 0644);
    if (descriptor < 0 || dup2(descriptor, to) < 0) _exit(126);
    close(descriptor);
  }

  std::filesystem::path out_, err_;
  pid_t pid_ = -1;
};

}  // namespace mrpt_terrain::test
