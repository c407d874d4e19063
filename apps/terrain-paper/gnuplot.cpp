// SPDX-License-Identifier: BSD-3-Clause
#include "gnuplot.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

namespace {

namespace fs = std::filesystem;

// Starts gnuplot in `folder` with its messages in a file; returns its wait status.
int start_and_wait(const std::string& gnuplot, const fs::path& folder, const std::string& setup,
                   const std::string& script, const std::string& messages) {
  const pid_t child = fork();
  if (child == 0) {
    const int file = open(messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (file < 0 || chdir(folder.c_str()) != 0 || dup2(file, STDOUT_FILENO) < 0 ||
        dup2(file, STDERR_FILENO) < 0) {
      _exit(126);
    }
    execl(gnuplot.c_str(), "gnuplot", "-e", setup.c_str(), script.c_str(),
          static_cast<char*>(nullptr));
    _exit(127);
  }
  int status = -1;
  if (child > 0) waitpid(child, &status, 0);
  return status;
}

std::string first_lines(const std::string& file) {
  std::ifstream text(file);
  std::string line;
  std::string result;
  while (result.size() < 400 && std::getline(text, line)) {
    if (line.find_first_not_of(" ^") != std::string::npos) result += " " + line;
  }
  return result;
}

}  // namespace

std::string find_gnuplot() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  std::string folder;
  while (std::getline(folders, folder, ':')) {
    const fs::path program = fs::absolute(folder.empty() ? "." : folder) / "gnuplot";
    std::error_code error;
    if (fs::is_regular_file(program, error) && access(program.c_str(), X_OK) == 0) {
      return program.string();
    }
  }
  return {};
}

std::string run_gnuplot(const std::string& gnuplot, const fs::path& folder,
                        const std::string& name) {
  const fs::path absolute = fs::absolute(folder);
  const std::string svg = name + ".svg.part";
  const std::string png = name + ".png.part";
  const std::string messages = (absolute / (name + ".messages.part")).string();
  const int status = start_and_wait(
      gnuplot, absolute, "svg_file='" + svg + "'; png_file='" + png + "'", name + ".gp", messages);
  std::string problem;
  std::error_code error;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    problem = name + ".gp: gnuplot failed:" + first_lines(messages);
  } else {
    fs::rename(absolute / svg, absolute / (name + ".svg"), error);
    if (!error) fs::rename(absolute / png, absolute / (name + ".png"), error);
    if (error) problem = name + ": cannot be written: " + error.message();
  }
  for (const std::string& part : {(absolute / svg).string(), (absolute / png).string(), messages}) {
    fs::remove(part, error);
  }
  return problem;
}
