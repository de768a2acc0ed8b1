#include "drivers/modbus/output_writer.h"

#include <iterator>
#include <utility>

#include "drivers/modbus/modbus_connection.h"

namespace contour {

std::uint64_t OutputWriter::Want(const OutputImage& image) {
  const std::lock_guard lock(mutex_);
  wanted_ = image;
  confirmed_ = Clock::now();
  return ++number_;
}

void OutputWriter::Confirm() {
  const std::lock_guard lock(mutex_);
  confirmed_ = Clock::now();
}

std::uint64_t OutputWriter::written() const {
  const std::lock_guard lock(mutex_);
  return written_;
}

bool OutputWriter::TakeSilence() {
  const std::lock_guard lock(mutex_);
  return std::exchange(silent_, false);
}

OutputImage OutputWriter::Now(std::uint64_t& number) {
  const std::lock_guard lock(mutex_);
  const OutputImage off = wanted_.Off();
  if (wanted_ != off && Clock::now() - confirmed_ > silence_) {
    wanted_ = off;
    ++number_;
    silent_ = true;
  }
  number = number_;
  return wanted_;
}

bool OutputWriter::Write(ModbusConnection& connection) {
  std::uint64_t number = 0;
  const OutputImage image = Now(number);
  ForgetOne(image);
  if (!Bring(image, connection)) return false;
  const std::lock_guard lock(mutex_);
  written_ = number;
  return true;
}

void OutputWriter::ForgetOne(const OutputImage& image) {
  const std::size_t count = image.coils.size() + image.registers.size();
  if (count == 0) return;
  const std::size_t one = again_++ % count;
  if (one < image.coils.size()) {
    known_.coils.erase(std::next(image.coils.begin(), static_cast<std::ptrdiff_t>(one))->first);
  } else {
    const auto at = static_cast<std::ptrdiff_t>(one - image.coils.size());
    known_.registers.erase(std::next(image.registers.begin(), at)->first);
  }
}

// What goes off goes first: one direction of a spindle before the other.
bool OutputWriter::Bring(const OutputImage& image, ModbusConnection& connection) {
  bool all = true;
  for (const bool on : {false, true}) {
    for (const auto& [address, value] : image.coils) {
      const auto known = known_.coils.find(address);
      if (value != on || (known != known_.coils.end() && known->second == value)) continue;
      if (connection.connected() && connection.WriteCoil(address, value)) {
        known_.coils[address] = value;
      } else {
        known_.coils.erase(address);
        all = false;
        // Nothing goes on while something does not go off.
        if (!on) continue;
      }
    }
    if (!all) return false;
    if (on) break;
    for (const auto& [address, reg] : image.registers) {
      const auto known = known_.registers.find(address);
      if (known != known_.registers.end() && known->second == reg) continue;
      if (connection.connected() && connection.WriteRegister(address, reg.value)) {
        known_.registers[address] = reg;
      } else {
        known_.registers.erase(address);
        all = false;
      }
    }
  }
  return all;
}

void OutputWriter::Release(ModbusConnection& connection) {
  OutputImage off;
  {
    const std::lock_guard lock(mutex_);
    wanted_ = off = wanted_.Off();
  }
  if (connection.connected()) Bring(off, connection);
}

}  // namespace contour
