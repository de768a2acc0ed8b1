// Records the reference inputs: what a cycle took in during short eventful runs of the example machine,
// without what it gave out. tests/replay/rerecord runs it; see docs/replay.md.
#include <filesystem>
#include <iostream>

#include "config/load_machine.h"
#include "daemon/make_log_header.h"
#include "daemon/telemetry/log_writer.h"
#include "tests/replay/eventful_run.h"

namespace contour::test {
namespace {

void Record(const std::string& config, ControllerName controller, const std::filesystem::path& file) {
  const std::vector<std::string> set{"machine.controller=" + std::string(Name(controller))};
  const MachineSource source = ReadSource(config, set);
  LogHeader header = MakeLogHeader(source, LoadMachine(source), "virtual", 0);
  header.build.clear();  // inputs are nobody's results
  header.config_name = std::filesystem::path(config).filename().string();
  LogWriter writer(file, header);
  TelemetryConfig sparse;
  sparse.look_hz = 1;
  TelemetryEncoder encoder(sparse, header.cycle_us, header.axis_names);
  TelemetrySink* sinks[] = {&writer};
  EventfulRun run(LoadEmulatedMachine(config, set), controller);
  CycleEntry inputs;
  run.machine().SetRecorder([&](const CycleEntry& entry) {
    inputs.input = entry.input;
    inputs.output.record.cycle = entry.input.cycle;
    inputs.output.record.grid_time_ns = entry.input.grid_time_ns;
    encoder.Add(inputs, sinks);
  });
  run.BringUp();
  run.Enable();
  if (controller != ControllerName::kCsp)
    run.Start("{shape: circle, radius_mm: 0.1, turns: 1, frequency_hz: 4}", 330);
  run.Start("{shape: square, side_mm: 0.5, feed_mm_min: 1200, corners: velocity_jump}", 80);
  run.EmergencyStop();
  encoder.Flush(sinks);
  writer.Close();
  std::cout << file.string() << ": " << run.machine().record().cycle << " cycles\n";
}

}  // namespace
}  // namespace contour::test

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: record_inputs MACHINE_FILE DIRECTORY\n";
    return 2;
  }
  const std::filesystem::path directory = argv[2];
  contour::test::Record(argv[1], contour::ControllerName::kFull, directory / "torque.lcmlog");
  contour::test::Record(argv[1], contour::ControllerName::kCsp, directory / "position.lcmlog");
  return 0;
}
