#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "tools/plant_emulator/emulated_machine.h"

namespace contour::test {

/// A small CANopen master without a bus: hands frames to an emulated machine and keeps what comes back.
class DriveHarness {
 public:
  static constexpr std::int64_t kPeriod_ns = 1'000'000;

  explicit DriveHarness(const EmulatorConfig& config, std::vector<EmulatedAxisPlacement> placements,
                        EmulatedClock clock = EmulatedClock::kSync, std::uint32_t cycle_us = 1000)
      : machine(config, placements, cycle_us, clock), placements_(std::move(placements)) {
    RunTimers(5'000'000);  // boot-up
  }

  struct Reply {
    bool answered = false;
    std::uint32_t abort = 0;
    std::uint32_t value = 0;
  };

  Reply Read(std::uint8_t node, std::uint16_t index, std::uint8_t sub = 0) {
    return Transfer(node, {0x40, index, sub, 0});
  }
  Reply Write(std::uint8_t node, std::uint16_t index, std::uint8_t sub, int bytes, std::int64_t value) {
    const auto command = static_cast<std::uint8_t>(0x23 | (4 - bytes) << 2);
    return Transfer(node, {command, index, sub, static_cast<std::uint32_t>(value)});
  }
  void Expect(std::uint8_t node, std::uint16_t index, std::uint8_t sub, int bytes, std::int64_t value) {
    const Reply r = Write(node, index, sub, bytes, value);
    EXPECT_TRUE(r.answered);
    EXPECT_EQ(r.abort, 0U) << std::hex << index << ":" << int{sub};
  }

  void Nmt(std::uint8_t command, std::uint8_t node = 0) {
    CanFrame f;
    f.length = 2;
    f.data = {command, node};
    Send(f);
  }
  void Heartbeat(std::uint8_t master = 127) {
    CanFrame f;
    f.id = static_cast<std::uint16_t>(0x700 + master);
    f.length = 1;
    f.data[0] = 5;
    Send(f);
  }

  /// Maps controlword + target torque in, statusword + position + torque out, synchronously.
  void MapTorquePdos(std::uint8_t n) {
    Expect(n, 0x1400, 1, 4, 0x80000200LL + n);
    Expect(n, 0x1600, 0, 1, 0);
    Expect(n, 0x1600, 1, 4, 0x60400010);
    Expect(n, 0x1600, 2, 4, 0x60710010);
    Expect(n, 0x1600, 0, 1, 2);
    Expect(n, 0x1400, 2, 1, 1);
    Expect(n, 0x1400, 1, 4, 0x200 + n);
    Expect(n, 0x1800, 1, 4, 0x80000180LL + n);
    Expect(n, 0x1A00, 0, 1, 0);
    Expect(n, 0x1A00, 1, 4, 0x60410010);
    Expect(n, 0x1A00, 2, 4, 0x60640020);
    Expect(n, 0x1A00, 3, 4, 0x60770010);
    Expect(n, 0x1A00, 0, 1, 3);
    Expect(n, 0x1800, 2, 1, 1);
    Expect(n, 0x1800, 1, 4, 0x180 + n);
  }
  /// Controlword + target position in, the same out.
  void MapPositionPdos(std::uint8_t n) {
    MapTorquePdos(n);
    Expect(n, 0x1400, 1, 4, 0x80000200LL + n);
    Expect(n, 0x1600, 0, 1, 0);
    Expect(n, 0x1600, 2, 4, 0x607A0020);
    Expect(n, 0x1600, 0, 1, 2);
    Expect(n, 0x1400, 1, 4, 0x200 + n);
  }
  void BringUp(std::int8_t mode = 10) {
    for (const auto& p : placements_) {
      mode == 8 ? MapPositionPdos(p.node_id) : MapTorquePdos(p.node_id);
      Expect(p.node_id, 0x6060, 0, 1, mode);
    }
    Nmt(0x01);
  }

  /// RPDO 1 of a node: controlword and a 2-byte torque or a 4-byte position.
  void Command(std::uint8_t node, std::uint16_t controlword, std::int32_t target, int bytes = 2) {
    CanFrame f;
    f.id = static_cast<std::uint16_t>(0x200 + node);
    f.length = static_cast<std::uint8_t>(2 + bytes);
    f.data[0] = static_cast<std::uint8_t>(controlword);
    f.data[1] = static_cast<std::uint8_t>(controlword >> 8U);
    for (int i = 0; i < bytes; ++i)
      f.data[static_cast<std::size_t>(2 + i)] =
          static_cast<std::uint8_t>(static_cast<std::uint32_t>(target) >> (8 * i));
    Send(f);
  }
  void Sync() {
    CanFrame f;
    f.id = 0x80;
    Send(f);
    RunTimers(kPeriod_ns);
  }
  /// All nodes get the same controlword and target.
  void Cycle(std::uint16_t controlword, std::int32_t target = 0, int bytes = 2) {
    for (const auto& p : placements_) Command(p.node_id, controlword, target, bytes);
    Sync();
  }
  /// Walks all drives to Operation Enabled.
  void Enable(int bytes = 2) {
    for (const int word : {0x06, 0x06, 0x07, 0x07, 0x0F, 0x0F})
      for (int i = 0; i < 2; ++i)
        Cycle(static_cast<std::uint16_t>(word), bytes == 4 ? position(placements_[0].node_id) : 0, bytes);
  }

  /// Lets time pass without a frame from the master.
  void RunTimers(std::int64_t duration_ns) {
    const std::int64_t end = now_ns + duration_ns;
    for (std::size_t b = 0; b < machine.bus_count(); ++b) {
      BusNode& node = machine.node(b);
      for (int guard = 0; guard < 100000 && node.NextTimer() <= end; ++guard) {
        const std::int64_t at = std::max(now_ns, node.NextTimer());
        PendingFrames out;
        node.OnTimer(at, out);
        Keep(out);
      }
    }
    now_ns = end;
  }
  void Send(const CanFrame& f, std::size_t bus = 0) {
    PendingFrames out;
    machine.node(bus).OnFrame(f, now_ns, out);
    Keep(out);
  }

  [[nodiscard]] std::uint16_t status(std::uint8_t node) const {
    const CanFrame* f = Last(static_cast<std::uint16_t>(0x180 + node));
    return f == nullptr ? std::uint16_t{0xFFFF} : static_cast<std::uint16_t>(f->data[0] | f->data[1] << 8);
  }
  [[nodiscard]] std::int32_t position(std::uint8_t node) const {
    const CanFrame* f = Last(static_cast<std::uint16_t>(0x180 + node));
    if (f == nullptr) return 0;
    std::uint32_t raw = 0;
    for (std::size_t i = 0; i < 4; ++i) raw |= static_cast<std::uint32_t>(f->data[2 + i]) << (8 * i);
    return static_cast<std::int32_t>(raw);
  }
  [[nodiscard]] const CanFrame* Last(std::uint16_t id) const {
    for (auto it = seen.rbegin(); it != seen.rend(); ++it)
      if (it->id == id) return &*it;
    return nullptr;
  }
  [[nodiscard]] int Count(std::uint16_t id) const {
    int n = 0;
    for (const CanFrame& f : seen) n += f.id == id;
    return n;
  }
  /// EMCY codes of a node, in order.
  [[nodiscard]] std::vector<std::uint16_t> Emergencies(std::uint8_t node) const {
    std::vector<std::uint16_t> codes;
    for (const CanFrame& f : seen)
      if (f.id == 0x80 + node && f.length == 8)
        codes.push_back(static_cast<std::uint16_t>(f.data[0] | f.data[1] << 8));
    return codes;
  }

  EmulatedMachine machine;
  std::int64_t now_ns = 0;
  std::vector<CanFrame> seen;

 private:
  struct Request {
    std::uint8_t command;
    std::uint16_t index;
    std::uint8_t sub;
    std::uint32_t value;
  };
  Reply Transfer(std::uint8_t node, const Request& q) {
    CanFrame f;
    f.id = static_cast<std::uint16_t>(0x600 + node);
    f.length = 8;
    f.data[0] = q.command;
    f.data[1] = static_cast<std::uint8_t>(q.index);
    f.data[2] = static_cast<std::uint8_t>(q.index >> 8);
    f.data[3] = q.sub;
    for (std::size_t i = 0; i < 4; ++i) f.data[4 + i] = static_cast<std::uint8_t>(q.value >> (8 * i));
    const auto before = seen.size();
    Send(f);
    for (std::size_t i = before; i < seen.size(); ++i) {
      if (seen[i].id != 0x580 + node) continue;
      std::uint32_t value = 0;
      for (std::size_t b = 0; b < 4; ++b) value |= static_cast<std::uint32_t>(seen[i].data[4 + b]) << (8 * b);
      if (seen[i].data[0] == 0x80) return {true, value, 0};
      return {true, 0, value};
    }
    return {};
  }
  void Keep(const PendingFrames& out) {
    for (const PendingFrame& f : out) seen.push_back(f.frame);
  }

  std::vector<EmulatedAxisPlacement> placements_;
};

/// The X axis of the nominal machine (a small ball-screw table), without the seed's variation.
inline EmulatedAxisConfig NominalAxis() {
  EmulatedAxisConfig a;
  a.motor_inertia_kgm2 = 5e-5;
  a.table_mass_kg = 10.0;
  a.screw_stiffness_N_um = 40.0;
  a.screw_damping_Ns_m = 1100.0;
  a.friction.Fs_plus_N = 52.0;
  a.friction.Fs_minus_N = 47.0;
  a.friction.Fc_plus_N = 42.0;
  a.friction.Fc_minus_N = 36.0;
  return a;
}
inline EmulatorConfig NominalMachine() {
  EmulatorConfig c;
  c.axes["x"] = NominalAxis();
  EmulatedAxisConfig y = NominalAxis();
  y.friction.Fs_plus_N = 48.0;
  y.friction.Fs_minus_N = 53.0;
  y.friction.Fc_plus_N = 37.0;
  y.friction.Fc_minus_N = 43.0;
  c.axes["y"] = y;
  return c;
}
inline EmulatedAxisPlacement Place(const std::string& name, std::uint8_t node, std::size_t bus = 0) {
  EmulatedAxisPlacement p;
  p.name = name;
  p.node_id = node;
  p.bus = bus;
  return p;
}

}  // namespace contour::test
