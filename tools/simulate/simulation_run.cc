#include "tools/simulate/simulation_run.h"

#include <charconv>
#include <fstream>
#include <stdexcept>
#include <string>

#include "daemon/telemetry/cycle_csv.h"
#include "tools/simulate/virtual_machine.h"

namespace contour {
namespace {

void AppendNumber(double value, std::string& out) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  out.append(text, end);
}

/// cycles.csv: the daemon's row of a cycle, then what the emulated machine really did at the same instant.
class CyclesFile {
 public:
  CyclesFile(const std::filesystem::path& file, std::span<const std::string> axes, int cycle_us)
      : file_(file), stream_(file, std::ios::binary), csv_(axes, cycle_us) {
    std::string header = csv_.Header();
    header.pop_back();
    for (const std::string& a : axes)
      header += "," + a + "_table_position_truth_m," + a + "_friction_truth_N";
    stream_ << header << "\n";
  }

  void Add(const CycleEntry& entry, const TruthRow* truth) {
    row_.clear();
    csv_.AppendRow(entry.output.record, entry.timing, row_);
    row_.pop_back();
    for (std::size_t i = 0; i < entry.output.record.axes.size(); ++i) {
      row_ += ',';
      if (truth != nullptr) AppendNumber(truth->axes[i].table_position_m, row_);
      row_ += ',';
      if (truth != nullptr) AppendNumber(truth->axes[i].friction_N, row_);
    }
    row_ += '\n';
    stream_ << row_;
  }

  void Close() {
    stream_.close();
    if (!stream_) throw std::runtime_error("cannot write " + file_.string());
  }

 private:
  std::filesystem::path file_;
  std::ofstream stream_;
  CycleCsv csv_;
  std::string row_;
};

}  // namespace

void RunSimulation(const SimulationRequest& request) {
  std::filesystem::create_directories(request.out);
  VirtualMachine machine(request.file, request.controller);
  CyclesFile cycles(request.out / "cycles.csv", machine.axis_names(), request.file.machine.machine.cycle_us);
  machine.BringUp();
  machine.Enable();
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow* truth) {
    if (entry.output.record.program_id != 0 && entry.output.record.path_points_waiting != 0)
      cycles.Add(entry, truth);
  });
  machine.Run(request.program);
  cycles.Close();
}

}  // namespace contour
