#!/usr/bin/env python3
"""start_up_check.py passes a right start-up and says what is wrong with a wrong one."""
import struct
import tempfile
import unittest

import canopen_trace as trace
import start_up_check

NODE = 5


class Recording:
    """A start-up of one node, written down frame by frame as candump would."""

    def __init__(self):
        self.lines = []

    def frame(self, identifier, *data):
        self.lines.append(f"({len(self.lines) / 1000:.6f}) vcan0 {identifier:03X}#{bytes(data).hex().upper()}")

    def write(self, index, sub_index, value, size):
        command = 0x23 | (4 - size) << 2
        self.frame(0x600 + NODE, command, *struct.pack("<HBI", index, sub_index, value))
        self.frame(0x580 + NODE, 0x60, *struct.pack("<HBI", index, sub_index, 0))

    def read(self, index, sub_index, value, size):
        self.frame(0x600 + NODE, 0x40, *struct.pack("<HBI", index, sub_index, 0))
        self.frame(0x580 + NODE, 0x43 | (4 - size) << 2, *struct.pack("<HBI", index, sub_index, value))

    def pdo(self, communication, mapping, cob_id, entries):
        self.write(communication, 1, cob_id | 1 << 31, 4)
        self.write(mapping, 0, 0, 1)
        for sub_index, entry in enumerate(entries, start=1):
            self.write(mapping, sub_index, entry, 4)
        self.write(mapping, 0, len(entries), 1)
        self.write(communication, 2, 1, 1)
        self.write(communication, 1, cob_id, 4)
        for sub_index, entry in enumerate(entries, start=1):
            self.read(mapping, sub_index, entry, 4)
        self.read(mapping, 0, len(entries), 1)
        self.read(communication, 2, 1, 1)
        self.read(communication, 1, cob_id, 4)

    def cycle(self, controlword, torque, statusword):
        self.frame(0x200 + NODE, *struct.pack("<Hh", controlword, torque))
        self.frame(trace.SYNC)
        self.frame(0x180 + NODE, *struct.pack("<Hih", statusword, 1000, 0))

    def frames(self):
        with tempfile.NamedTemporaryFile("w", suffix=".log") as file:
            file.write("\n".join(self.lines) + "\n(9.0) vcan0 08")
            file.flush()
            return trace.read(file.name)


def good_start_up():
    r = Recording()
    r.frame(0x000, trace.NMT_RESET_COMMUNICATION, 0)
    r.frame(0x700 + NODE, 0)
    r.read(0x1018, 1, 0xC0D, 4)
    r.read(0x1018, 2, 0x402, 4)
    r.pdo(0x1400, 0x1600, 0x200 + NODE, [0x60400010, 0x60710010])
    r.pdo(0x1800, 0x1A00, 0x180 + NODE, [0x60410010, 0x60640020, 0x60770010])
    r.write(0x1016, 1, 0x7F000A, 4)
    r.write(0x1017, 0, 50, 2)
    r.frame(0x000, trace.NMT_START, NODE)
    r.frame(0x700 + NODE, trace.HEARTBEAT_OPERATIONAL)
    for controlword, statusword in ((0x00, 0x0240), (0x06, 0x0240), (0x06, 0x0221), (0x07, 0x0221), (0x07, 0x0223),
                                    (0x0F, 0x0223), (0x0F, 0x1227)):
        r.cycle(controlword, 0, statusword)
    r.cycle(0x0F, 25, 0x1227)
    return r


def problems(recording):
    return start_up_check.problems(recording.frames(), [NODE])


def without(recording, condition):
    recording.lines = [line for line in recording.lines if not condition(line)]
    return recording


class StartUpCheck(unittest.TestCase):
    def assert_found(self, recording, words):
        found = problems(recording)
        self.assertTrue(any(words in problem for problem in found), found)

    def test_a_right_start_up_has_no_problem(self):
        self.assertEqual(problems(good_start_up()), [])

    def test_identity_must_be_read(self):
        self.assert_found(without(good_start_up(), lambda line: "401810" in line or "431810" in line), "identity 0x1018:01")

    def test_pdo_must_be_off_while_it_is_configured(self):
        self.assert_found(without(good_start_up(), lambda line: "2300140105020080" in line), "not configured whole")

    def test_mapping_must_follow_the_order(self):
        r = good_start_up()
        off = next(i for i, line in enumerate(r.lines) if "#2F001600" in line)
        r.lines[off:off + 4] = r.lines[off + 2:off + 4] + r.lines[off:off + 2]
        self.assert_found(r, "not in the order")

    def test_what_was_written_must_be_read_back_the_same(self):
        r = good_start_up()
        r.lines = [line.replace("4F01140201", "4F011402FE").replace("4F00140201", "4F001402FE") for line in r.lines]
        self.assert_found(r, "read back as 0xFE")

    def test_a_self_acting_pdo_is_not_cyclic(self):
        r = good_start_up()
        r.lines = [line.replace("2F00140201", "2F001402FF").replace("4F00140201", "4F001402FF") for line in r.lines]
        self.assert_found(r, "does not follow SYNC")

    def test_both_heartbeats_must_be_set(self):
        self.assert_found(without(good_start_up(), lambda line: "231610" in line), "consumer 0x1016")

    def test_sync_must_wait_for_operational(self):
        r = good_start_up()
        r.lines.insert(0, "(0.0) vcan0 080#")
        self.assert_found(r, "SYNC came before")

    def test_operational_must_be_confirmed(self):
        self.assert_found(without(good_start_up(), lambda line: line.endswith(f"{0x700 + NODE:03X}#05")), "Operational")

    def test_every_cycle_has_its_pdos(self):
        r = good_start_up()
        del r.lines[max(i for i, line in enumerate(r.lines) if f" {0x200 + NODE:03X}#" in line)]
        self.assert_found(r, "0 RPDOs of node 5")

    def test_no_transition_is_skipped(self):
        r = good_start_up()
        r.lines = [line.replace("#2302", "#2102") for line in r.lines]
        self.assert_found(r, "walked")

    def test_no_torque_before_operation_enabled(self):
        r = good_start_up()
        first = next(i for i, line in enumerate(r.lines) if f" {0x200 + NODE:03X}#" in line)
        r.lines[first] = r.lines[first][:-4] + "0100"
        self.assert_found(r, "torque was sent before")


if __name__ == "__main__":
    unittest.main()
