#pragma once

#include <chrono>
#include <cstdint>

#include "daemon/program_outputs.h"
#include "drivers/modbus/output_writer.h"
#include "drivers/modbus/program_outputs_config.h"

namespace contour {

/// Spindle, coolant and tools as Modbus outputs. From the start they are off.
class ModbusOutputs final : public ProgramOutputs {
 public:
  ModbusOutputs(const ProgramOutputsConfig& config, OutputWriter& writer);

  [[nodiscard]] bool Listens(const GcodeEvent& event) const override;
  void Do(const GcodeEvent& event) override;
  [[nodiscard]] bool Done() override;
  void Over(const GcodeEvent& event) override;
  void Off() override;
  void Confirm() override { writer_.Confirm(); }
  [[nodiscard]] bool TakeLoss() override { return writer_.TakeSilence(); }

 private:
  void Switch(const GcodeEvent& event);
  void Spindle(bool forward, bool backward);

  ProgramOutputsConfig config_;
  OutputWriter& writer_;
  OutputImage image_;
  std::uint64_t number_ = 0;  ///< of the image that was asked for last
  double settle_s_ = 0.0;     ///< it takes when it is written
  bool pulse_ = false;        ///< and a tool's change is over then
  std::chrono::steady_clock::time_point written_{};
};

}  // namespace contour
