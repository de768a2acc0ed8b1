#include "daemon/start_again.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "core/exit_status.h"

// After the headers that it needs.
#include <linux/close_range.h>

namespace contour {
namespace {

constexpr unsigned kFirstOwnDescriptor = 3;

}  // namespace

DaemonOptions WithModel(DaemonOptions options, const std::string& model) {
  const std::string axis = model.substr(0, model.find('=') + 1);
  std::erase_if(options.models, [&](const std::string& m) { return m.starts_with(axis); });
  if (model.size() > axis.size()) options.models.push_back(model);
  return options;
}

DaemonOptions WithNewStart(DaemonOptions options, const NewStart& start) {
  if (start.model) options = WithModel(std::move(options), *start.model);
  if (start.recording_mode) {
    options.torque_loops = start.recording_mode->loops;
    options.torque_models = start.recording_mode->models;
    options.csp_axes = start.recording_mode->csp_axes;
  }
  options.log = NextFile(options.log);
  options.truth = NextFile(options.truth);
  return options;
}

std::string Describe(const NewStart& start) {
  if (start.model) return "with another model of axis " + start.model->substr(0, start.model->find('='));
  if (start.recording_mode && !start.recording_mode->loops.empty()) return "in torque mode for commissioning";
  if (start.recording_mode && !start.recording_mode->csp_axes.empty()) return "in csp for commissioning";
  return "in the machine file's own mode";
}

std::string NextFile(const std::string& file) {
  if (file.empty()) return file;
  std::string stem = file;
  int number = 0;
  const std::size_t dot = file.rfind('.');
  const std::string end = dot == std::string::npos ? "" : file.substr(dot + 1);
  const bool counts =
      !end.empty() && end.size() < 6 &&
      std::all_of(end.begin(), end.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  if (counts) {
    stem = file.substr(0, dot);
    number = std::stoi(end);
  }
  std::string next;
  do next = stem + "." + std::to_string(++number);
  while (std::filesystem::exists(next));
  return next;
}

std::vector<std::string> ArgumentsOf(const DaemonOptions& o) {
  std::vector<std::string> out{"contourd", "--config=" + o.config, "--clock=" + o.clock};
  std::string buses;
  for (const std::string& bus : o.buses) buses += (buses.empty() ? "" : ",") + bus;
  for (const auto& [name, value] :
       {std::pair{"--bus=", buses}, std::pair{"--controller=", o.controller}, std::pair{"--log=", o.log},
        std::pair{"--truth=", o.truth}, std::pair{"--socket=", o.socket}})
    if (!value.empty()) out.push_back(name + value);
  for (const std::string& set : o.set) out.push_back("--set=" + set);
  for (const std::string& model : o.models) out.push_back("--model=" + model);
  for (const std::string& loop : o.torque_loops) out.push_back("--torque-loop=" + loop);
  for (const std::string& model : o.torque_models) out.push_back("--torque-model=" + model);
  for (const std::string& axis : o.csp_axes) out.push_back("--csp-axis=" + axis);
  return out;
}

void StartAgain(const DaemonOptions& options) {
  std::vector<std::string> arguments = ArgumentsOf(options);
  std::vector<char*> words;
  for (std::string& a : arguments) words.push_back(a.data());
  words.push_back(nullptr);
  // Of sockets, locks and files nothing is left over.
  ::close_range(kFirstOwnDescriptor, ~0U, CLOSE_RANGE_CLOEXEC);
  ::execv("/proc/self/exe", words.data());
  throw EnvironmentError("contourd cannot begin anew: " + std::string(std::strerror(errno)));
}

}  // namespace contour
