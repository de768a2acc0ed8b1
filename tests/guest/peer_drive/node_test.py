#!/usr/bin/env python3
"""The python drive as a CANopen device, frame by frame, without a bus."""
import struct
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
try:
    import canopen  # noqa: F401
except ImportError:
    print("SKIPPED: no python-canopen; tools/setup --all puts it into build/venv")
    sys.exit(77)

from peer_drive.network import TimedNetwork  # noqa: E402
from peer_drive.node import BOOTING, OPERATIONAL, PRE_OPERATIONAL, DriveNode, NodeParameters  # noqa: E402
from peer_drive.servo import CST, DISABLED, ENABLED  # noqa: E402

NODE, MASTER = 5, 127
MAPPING = {0x1400: [0x60400010, 0x60710010], 0x1800: [0x60410010, 0x60640020, 0x60770010]}


class Wire(TimedNetwork):
    def __init__(self):
        super().__init__()
        self.sent = []

    def send_message(self, can_id, data, remote=False):
        del remote
        self.sent.append((can_id, bytes(data)))

    def of(self, can_id):
        return [data for identifier, data in self.sent if identifier == can_id]


class NodeTest(unittest.TestCase):
    def make(self, **parameters):
        self.wire = Wire()
        self.drive = DriveNode(NodeParameters(**{"node_id": NODE, "boot_ms": 3, **parameters}), self.wire, 1)
        self.periods(4)
        return self.drive

    def periods(self, number):
        for _ in range(number):
            self.drive.latch_and_apply()
            self.drive.advance(1000)
            self.wire.elapse(1.0)
            self.drive.boot_on(1.0)

    def write(self, index, sub_index, size, value):
        """The abort code, 0 when it was taken."""
        command = 0x23 | (4 - size) << 2
        self.wire.notify(0x600 + NODE, struct.pack("<BHB", command, index, sub_index) + (value & (1 << 32) - 1).to_bytes(4, "little"), 0)
        reply = self.wire.of(0x580 + NODE)[-1]
        return struct.unpack("<I", reply[4:])[0] if reply[0] == 0x80 else 0

    def read(self, index, sub_index=0):
        self.wire.notify(0x600 + NODE, struct.pack("<BHB4x", 0x40, index, sub_index), 0)
        reply = self.wire.of(0x580 + NODE)[-1]
        size = 4 - (reply[0] >> 2 & 3)
        return int.from_bytes(reply[4:4 + size], "little")

    def configure(self):
        for communication, cob_id in ((0x1400, 0x200), (0x1800, 0x180)):
            mapping = MAPPING[communication]
            self.assertEqual(self.write(communication, 1, 4, 1 << 31 | (cob_id + NODE)), 0)
            self.assertEqual(self.write(communication + 0x200, 0, 1, 0), 0)
            for number, entry in enumerate(mapping, start=1):
                self.assertEqual(self.write(communication + 0x200, number, 4, entry), 0)
            self.assertEqual(self.write(communication + 0x200, 0, 1, len(mapping)), 0)
            self.assertEqual(self.write(communication, 2, 1, 1), 0)
            self.assertEqual(self.write(communication, 1, 4, cob_id + NODE), 0)
        self.assertEqual(self.write(0x6007, 0, 2, 3), 0)
        self.assertEqual(self.write(0x6060, 0, 1, CST), 0)
        self.wire.notify(0, bytes([0x01, NODE]), 0)

    def command(self, controlword, torque=0):
        self.wire.notify(0x200 + NODE, struct.pack("<Hh", controlword, torque), 0)
        self.periods(1)

    def enable(self):
        for controlword, periods in ((0x06, 1), (0x07, 6), (0x0F, 20)):
            for _ in range(periods):
                self.command(controlword)
        self.assertEqual(self.drive.servo.state, ENABLED)

    def test_says_that_it_has_booted_and_answers_then(self):
        self.make(boot_ms=10)
        self.assertEqual(self.drive.nmt_state, BOOTING)
        self.wire.notify(0x600 + NODE, struct.pack("<BHB4x", 0x40, 0x1000, 0), 0)
        self.assertEqual(self.wire.sent, [])
        self.periods(10)
        self.assertEqual(self.wire.sent, [(0x700 + NODE, b"\0")])
        self.assertEqual(self.read(0x1000) & 0xFFFF, 402)

    def test_a_pdo_is_mapped_only_while_it_is_off(self):
        self.make()
        self.assertEqual(self.write(0x1600, 0, 1, 0), 0x08000022)
        self.configure()
        self.assertEqual(self.drive.nmt_state, OPERATIONAL)

    def test_walks_to_operation_enabled_and_tells_at_sync(self):
        self.make()
        self.configure()
        self.enable()
        self.command(0x0F, 300)
        self.periods(40)
        statusword, counts, torque = struct.unpack("<Hih", self.wire.of(0x180 + NODE)[-1])
        self.assertEqual(statusword & 0x106F, 0x1027)
        self.assertGreater(counts, 100)
        self.assertEqual(torque, 300)

    def test_a_set_point_acts_at_the_next_sync(self):
        self.make()
        self.configure()
        self.enable()
        self.wire.notify(0x200 + NODE, struct.pack("<Hh", 0x0F, 300), 0)
        self.assertEqual(self.drive.servo.target_torque_per_mille, 0)
        self.drive.latch_and_apply()
        self.assertEqual(self.drive.servo.target_torque_per_mille, 300)

    def test_a_master_that_falls_silent_is_noticed(self):
        self.make()
        self.assertEqual(self.write(0x1016, 1, 4, MASTER << 16 | 6), 0)
        self.configure()
        self.enable()
        self.periods(20)
        self.assertEqual(self.drive.nmt_state, OPERATIONAL, "the watch begins with the first heartbeat")
        self.wire.notify(0x700 + MASTER, b"\x05", 0)
        self.periods(6)
        self.assertEqual(self.drive.servo.state, ENABLED)
        self.periods(30)
        self.assertEqual(self.drive.servo.state, DISABLED)
        self.assertEqual(self.drive.nmt_state, PRE_OPERATIONAL)
        self.assertEqual(struct.unpack("<H", self.wire.of(0x080 + NODE)[0][:2]), (0x8130,))
        self.assertEqual(self.read(0x1003, 1), 0x8130)

    def test_heartbeats_come_in_the_machines_time(self):
        self.make()
        self.assertEqual(self.write(0x1017, 0, 2, 10), 0)
        self.wire.sent.clear()
        self.periods(35)
        self.assertEqual(self.wire.of(0x700 + NODE), [b"\x7f"] * 3)

    def test_only_a_loss_of_power_begins_the_count_anew(self):
        self.make(servo={"absolute_encoder": False})
        plant = self.drive.servo.plant
        plant.angle_rad, plant.table_m = 1.0, plant.m_per_rad
        self.periods(1)
        counts = self.drive.servo.position_counts
        self.assertGreater(counts, 1000)
        for command, expected in ((0x82, counts), (0x81, 0)):
            self.wire.notify(0, bytes([command, NODE]), 0)
            self.periods(5)
            self.assertAlmostEqual(self.drive.servo.position_counts, expected, delta=30)
        self.assertEqual(len(self.wire.of(0x700 + NODE)), 3)

    def test_what_is_read_only_and_right_refuses_writes(self):
        self.make(read_only={0x6007: 3, 0x60C2: 1}, fixed_pdos=True)
        self.assertEqual(self.write(0x6007, 0, 2, 3), 0x06010002)
        self.assertEqual(self.read(0x6007), 3)
        self.assertEqual(self.read(0x60C2, 1), 1)
        self.assertEqual(self.write(0x1600, 0, 1, 0), 0x06010002)
        self.assertEqual(self.read(0x1A00, 2), 0x60640020)


if __name__ == "__main__":
    unittest.main()
