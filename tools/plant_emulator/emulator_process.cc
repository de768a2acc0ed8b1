#include "tools/plant_emulator/emulator_process.h"

#include <algorithm>
#include <array>
#include <memory>

#include "drivers/can/clock_ns.h"
#include "drivers/can/socketcan_bus.h"
#include "tools/plant_emulator/modbus_io_server.h"
#include "tools/plant_emulator/truth_writer.h"

namespace contour {
namespace {

constexpr std::int64_t kLongestWait_ns = 50'000'000;  ///< how soon a stop is noticed
constexpr std::int64_t kFlushPeriod_ns = 10'000'000;
constexpr std::size_t kBatch = 64;

/// One bus and the emulated drives on it.
class EmulatedBus {
 public:
  EmulatedBus(const std::string& interface, BusNode& node) : bus_(interface), node_(node) {}

  [[nodiscard]] int fd() const noexcept { return bus_.fd(); }
  [[nodiscard]] std::int64_t NextTimer() const noexcept { return node_.NextTimer(); }

  void Run(std::int64_t now_ns) noexcept {
    for (std::size_t n = kBatch; n == kBatch;) {
      n = bus_.Receive(now_ns, frames_);
      for (std::size_t i = 0; i < n; ++i) {
        // The machine's time never runs backwards, whatever the stamps say.
        last_ns_ = std::clamp(frames_[i].stamp_ns, last_ns_, std::max(now_ns, last_ns_));
        PendingFrames out;
        node_.OnFrame(frames_[i].frame, last_ns_, out);
        Send(now_ns, out);
      }
    }
    if (node_.NextTimer() > now_ns) return;
    last_ns_ = std::max(last_ns_, now_ns);
    PendingFrames out;
    node_.OnTimer(last_ns_, out);
    Send(now_ns, out);
  }

 private:
  /// At once: a virtual bus has no bit timing, and the answer times of slow drives would only slow the test
  /// down.
  void Send(std::int64_t now_ns, const PendingFrames& out) noexcept {
    if (out.empty()) return;
    std::array<CanFrame, PendingFrames::capacity()> batch;
    for (std::size_t i = 0; i < out.size(); ++i) batch[i] = out[i].frame;
    bus_.Send(now_ns, std::span(batch.data(), out.size()));
  }

  SocketCanBus bus_;
  BusNode& node_;
  std::array<StampedFrame, kBatch> frames_{};
  std::int64_t last_ns_ = 0;
};

}  // namespace

void RunEmulatorProcess(EmulatedMachine& machine, const EmulatorProcessOptions& options,
                        const std::atomic<bool>& stop, void (*ready)(const EmulatorProcessOptions&)) {
  std::vector<std::unique_ptr<EmulatedBus>> buses;
  for (std::size_t b = 0; b < machine.bus_count(); ++b)
    buses.push_back(std::make_unique<EmulatedBus>(options.interfaces.at(b), machine.node(b)));
  std::unique_ptr<ModbusIoServer> io;
  if (options.io) io = std::make_unique<ModbusIoServer>(*options.io);
  std::unique_ptr<TruthWriter> truth;
  if (options.truth_path) truth = std::make_unique<TruthWriter>(*options.truth_path, options.axis_names);
  machine.SetTruthSink(truth.get());
  ready(options);

  std::vector<int> fds(buses.size());
  std::int64_t flushed_ns = ClockNow_ns();
  while (!stop.load()) {
    const std::int64_t now_ns = ClockNow_ns();
    for (const auto& bus : buses) bus->Run(now_ns);
    if (truth && now_ns - flushed_ns >= kFlushPeriod_ns) {
      truth->Flush();
      flushed_ns = now_ns;
    }
    if (io && !machine.truth().axes.empty())
      io->SetTemperature_degC(machine.truth().axes[0].temperature_degC);
    std::int64_t deadline_ns = now_ns + (truth ? kFlushPeriod_ns : kLongestWait_ns);
    for (const auto& bus : buses) deadline_ns = std::min(deadline_ns, bus->NextTimer());
    // Descriptors change when an interface vanished and came back.
    std::transform(buses.begin(), buses.end(), fds.begin(), [](const auto& bus) { return bus->fd(); });
    if (deadline_ns > now_ns) static_cast<void>(WaitReadable(fds, deadline_ns));
  }
  machine.SetTruthSink(nullptr);
  if (truth) {
    truth->Flush();
    if (!truth->ok()) throw std::runtime_error(*options.truth_path + ": could not be written to the end");
  }
}

}  // namespace contour
