#include "daemon/make_log_header.h"

#include "daemon/build_identity.h"

namespace contour {

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
  for (const auto& [name, text] : source.files) header.files.push_back({name, text});
  return header;
}

MachineSource SourceOf(const LogHeader& header) {
  MachineSource source{header.config_name, header.config_text, {}, header.overrides};
  for (const LogFile& file : header.files) source.files[file.name] = file.text;
  return source;
}

}  // namespace contour
