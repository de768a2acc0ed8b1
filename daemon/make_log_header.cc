#include "daemon/make_log_header.h"

#include "config/yaml_tree.h"
#include "daemon/build_identity.h"

namespace contour {
namespace {

const std::string kFriction = "control.friction=";
/// What was the default while logs did not yet name it.
constexpr FrictionKind kUnnamed = FrictionKind::kSrukf;

bool NamesFriction(const MachineSource& source) {
  for (const std::string& assignment : source.overrides)
    if (assignment.starts_with(kFriction)) return true;
  const YamlValue tree = ParseYamlText(source.text, source.name);
  const YamlEntry* control = tree.Find("control");
  return control != nullptr && control->value.Find("friction") != nullptr;
}

}  // namespace

LogHeader MakeLogHeader(const MachineSource& source, const MachineConfig& machine, const std::string& clock,
                        std::int64_t start_unix_us) {
  LogHeader header;
  header.build = BuildIdentity();
  header.machine = machine.machine.name;
  header.controller = Name(machine.machine.controller);
  header.clock = clock;
  header.start_unix_us = start_unix_us;
  header.cycle_us = machine.machine.cycle_us;
  header.axis_names = AxisNames(machine);
  header.config_name = source.name;
  header.config_text = source.text;
  header.overrides = source.overrides;
  // By name, so that a log stays what it was when the default becomes another.
  header.overrides.push_back(kFriction + std::string(Name(machine.control.friction)));
  for (const auto& [name, text] : source.files) header.files.push_back({name, text});
  return header;
}

MachineSource SourceOf(const LogHeader& header) {
  MachineSource source{header.config_name, header.config_text, {}, header.overrides};
  for (const LogFile& file : header.files) source.files[file.name] = file.text;
  if (!NamesFriction(source)) source.overrides.push_back(kFriction + std::string(Name(kUnnamed)));
  return source;
}

}  // namespace contour
