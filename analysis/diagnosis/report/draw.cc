#include "analysis/diagnosis/report/draw.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/exit_status.h"

namespace contour::diagnosis {
namespace {

/// Exit status of a program, 127 when there is none.
int Run(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  if (::posix_spawnp(&child, arguments[0], nullptr, nullptr, arguments.data(), environ) != 0) return 127;
  int status = 0;
  if (::waitpid(child, &status, 0) != child) return 127;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

}  // namespace

void Draw(const std::string& script, std::vector<std::string> arguments) {
  const std::string path = std::string(CONTOUR_PLOTS_DIR) + "/" + script;
  arguments.insert(arguments.begin(), {CONTOUR_PYTHON, path});
  if (const int status = Run(std::move(arguments)); status != 0)
    throw EnvironmentError("the pictures were not drawn: " CONTOUR_PYTHON " " + path + " ended with status " +
                           std::to_string(status) + " (Debian: python3-numpy, python3-matplotlib)");
}

}  // namespace contour::diagnosis
