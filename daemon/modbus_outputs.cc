#include "daemon/modbus_outputs.h"

#include <algorithm>
#include <cmath>

#include "daemon/output_words.h"

namespace contour {

ModbusOutputs::ModbusOutputs(const ProgramOutputsConfig& config, OutputWriter& writer)
    : config_(config), writer_(writer) {
  for (const auto& coil : {config_.spindle_forward, config_.spindle_backward, config_.mist, config_.flood})
    if (coil) image_.coils[coil->coil] = false;
  if (config_.tool_change) image_.coils[config_.tool_change->coil] = false;
  if (config_.spindle_speed) image_.registers[config_.spindle_speed->address] = {};
  number_ = writer_.Want(image_);
}

bool ModbusOutputs::Listens(const GcodeEvent& event) const { return contour::Listens(config_, event); }

void ModbusOutputs::Spindle(bool forward, bool backward) {
  if (config_.spindle_forward) image_.coils[config_.spindle_forward->coil] = forward;
  if (config_.spindle_backward) image_.coils[config_.spindle_backward->coil] = backward;
  if (forward) settle_s_ = config_.spindle_forward->settle_s;
  if (backward) settle_s_ = config_.spindle_backward->settle_s;
}

void ModbusOutputs::Switch(const GcodeEvent& event) {
  settle_s_ = 0.0;
  if (event.letter == 'S') {
    const SpeedRegisterConfig& speed = *config_.spindle_speed;
    image_.registers[speed.address].value =
        static_cast<std::uint16_t>(std::lround(std::abs(event.value) * speed.counts_per_rpm));
    settle_s_ = speed.settle_s;
  } else if (event.letter == 'T') {
    image_.registers[config_.tool_number->address] = {static_cast<std::uint16_t>(std::lround(event.value)),
                                                      true};
  } else if (event.code <= 5) {
    Spindle(event.code == 3, event.code == 4);
  } else if (event.code == 6) {
    image_.coils[config_.tool_change->coil] = true;
    settle_s_ = config_.tool_change->settle_s;
  } else {
    if (config_.mist && event.code != 8) image_.coils[config_.mist->coil] = event.code == 7;
    if (config_.flood && event.code != 7) image_.coils[config_.flood->coil] = event.code == 8;
    if (event.code == 7) settle_s_ = config_.mist->settle_s;
    if (event.code == 8) settle_s_ = config_.flood->settle_s;
  }
}

void ModbusOutputs::Do(const GcodeEvent& event) {
  Switch(event);
  pulse_ = event.letter == 'M' && event.code == 6 && !config_.tool_change->hold;
  written_ = {};
  number_ = writer_.Want(image_);
}

// The motion goes on when the output stands at the server, and has had its time.
bool ModbusOutputs::Done() {
  const auto now = std::chrono::steady_clock::now();
  if (writer_.written() < number_) return false;
  if (written_ == std::chrono::steady_clock::time_point{}) written_ = now;
  if (now - written_ < std::chrono::duration<double>(settle_s_)) return false;
  if (!pulse_) return true;
  // The change of a tool is over when its coil is off again.
  pulse_ = false;
  image_.coils[config_.tool_change->coil] = false;
  settle_s_ = 0.0;
  number_ = writer_.Want(image_);
  return false;
}

void ModbusOutputs::Over(const GcodeEvent& event) {
  if (event.letter != 'M' || event.code != 6 || !config_.tool_change) return;
  image_.coils[config_.tool_change->coil] = false;
  number_ = writer_.Want(image_);
}

void ModbusOutputs::Off() {
  pulse_ = false;
  const OutputImage off = image_.Off();
  if (off == image_) return;
  image_ = off;
  number_ = writer_.Want(image_);
}

}  // namespace contour
