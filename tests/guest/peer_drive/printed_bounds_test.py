#!/usr/bin/env python3
"""Bounds are read from the report as it is printed, and a feed between two columns gets the larger of theirs."""
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from peer_drive.printed_bounds import PrintedBounds  # noqa: E402

REPORT = """Machine m: cycle 1000 us
Safe travel
  x: from rest at the torque limit: 0.54 mm, safe travel 3 mm

Faults of feedback and torque: departure from the commanded path until the torque is off, at a feed of
  axis x            rest       0.1 mm/s    1 mm/s     200 mm/s
  encoder frozen    0.0050 mm  0.0100 mm   0.020 mm   0.800 mm
    within          4.0 ms     300.0 ms    40.0 ms    5.0 ms
  jump not seen     0.0400 mm  0.0400 mm   0.0400 mm  0.300 mm
  worst: 0.80 mm (encoder frozen at 200 mm/s), safe travel 3 mm
  axis y            rest       0.1 mm/s
  encoder frozen    0.0060 mm  0.0110 mm
    within          4.0 ms     310.0 ms
  worst: 0.01 mm (encoder frozen at 0.1 mm/s), safe travel 3 mm
  A lying encoder gets "disable voltage".

Bus main: vcan0
  encoder frozen    9 mm       9 mm        9 mm       9 mm
"""


class PrintedBoundsTest(unittest.TestCase):
    def setUp(self):
        self.bounds = PrintedBounds(REPORT)

    def test_a_column_of_its_own(self):
        self.assertEqual(self.bounds.of("x", "encoder frozen", 0.1), (0.01, 300.0))
        self.assertEqual(self.bounds.of("y", "encoder frozen", 0.0), (0.006, 4.0))

    def test_between_columns_the_larger_of_each(self):
        self.assertEqual(self.bounds.of("x", "encoder frozen", 0.2), (0.02, 300.0))

    def test_without_a_time(self):
        self.assertEqual(self.bounds.of("x", "jump not seen", 200.0), (0.3, None))

    def test_what_is_not_printed(self):
        self.assertIsNone(self.bounds.of("x", "encoder reversed", 1.0))
        self.assertIsNone(PrintedBounds("Machine m").of("x", "encoder frozen", 1.0))


if __name__ == "__main__":
    unittest.main()
