#include "tools/contour/draw_pictures.h"

#include <unistd.h>

#include <cstdlib>
#include <iostream>

namespace contour {
namespace {

/// The script that draws, beside a build in its source tree; empty when this program lives elsewhere.
std::filesystem::path PlotScript(const std::string& name) {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return {};
  // build/release/bin/contour
  const std::filesystem::path script =
      program.parent_path().parent_path().parent_path().parent_path() / "tools/plots" / name;
  return std::filesystem::exists(script, error) ? script : std::filesystem::path{};
}

std::string Quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace

void DrawPictures(const std::string& name, const std::filesystem::path& directory) {
  const std::filesystem::path script = PlotScript(name);
  // The system's own interpreter has the packages; one that comes first in PATH need not.
  std::error_code error;
  const std::string python =
      std::filesystem::exists("/usr/bin/python3", error) ? "/usr/bin/python3" : "python3";
  const std::string command = python + " " + Quoted(script.string()) + " " + Quoted(directory.string());
  if (script.empty()) {
    std::cout << "pictures: tools/plots/" << name << " " << directory.string() << "\n";
    return;
  }
  std::cout << std::flush;
  if (std::system(command.c_str()) != 0)  // NOLINT(concurrency-mt-unsafe): one thread, a command of our own
    std::cerr << "the pictures could not be drawn; all else is written: " << command << "\n";
}

}  // namespace contour
