#!/usr/bin/env python3
"""include_floors.py finds what it is there to find, and lets pass what is right."""
import tempfile
import unittest
from pathlib import Path

import include_floors


def offences(**files):
    """Offences in a tree made of the given files; __ in a key stands for / and a trailing _h or _cc for the suffix."""
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        for key, text in files.items():
            stem, suffix = key.replace("__", "/").rsplit("_", 1)
            path = root / f"{stem}.{suffix}"
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return include_floors.check(root)


class IncludeFloors(unittest.TestCase):
    def assert_illegal(self, found, *words):
        self.assertEqual(len(found), 1, found)
        for word in words:
            self.assertIn(word, found[0])

    def test_downwards_is_allowed(self):
        self.assertEqual(offences(
            estimator__filter_h='#include "core/axis.h"\n#include <Eigen/Core>\n',
            daemon__rt__cycle_cc='#include "estimator/filter.h"\n#include "drivers/cia402/scaling.h"\n',
            daemon__pump_cc='#include "daemon/rt/cycle.h"\n#include "config/machine_config.h"\n#include <mutex>\n',
            tools__contour__check_cc='#include "daemon/pump.h"\n#include "analysis/metrics/metrics.h"\n'
                                     '#include "daemon/rt/cycle.h"\n#include "tools/plant_emulator/plant.h"\n',
            drivers__cia402__scaling_h='#include "drivers/can/frame_bus.h"\n'), [])

    def test_upwards_is_caught_with_file_and_line(self):
        found = offences(core__axis_h='// core\n#include "estimator/filter.h"\n')
        self.assert_illegal(found, "core/axis.h:2", "estimator/filter.h")

    def test_neighbours_are_blind_to_each_other(self):
        self.assert_illegal(offences(estimator__a_h='#include "control/b.h"\n'), "estimator may not")
        self.assert_illegal(offences(control__a_h='#include "drivers/can/b.h"\n'), "control may not")
        self.assert_illegal(offences(daemon__rt__a_h='#include "config/b.h"\n'), "daemon/rt may not")
        self.assert_illegal(offences(config__a_h='#include "daemon/rt/b.h"\n'), "config may not")

    def test_the_cycle_knows_no_slow_driver_and_nothing_above_it(self):
        self.assert_illegal(offences(daemon__rt__a_h='#include "drivers/modbus/io.h"\n'), "daemon/rt may not")
        self.assert_illegal(offences(daemon__rt__a_h='#include "daemon/pump.h"\n'), "daemon/rt may not")
        self.assert_illegal(offences(drivers__can__a_h='#include "drivers/lcm/b.h"\n'), "drivers/can may not")

    def test_emulator_and_estimator_share_nothing(self):
        self.assert_illegal(offences(tools__plant_emulator__a_h='#include "estimator/b.h"\n'), "plant_emulator may not")
        self.assert_illegal(offences(estimator__a_h='#include "tools/plant_emulator/b.h"\n'), "estimator may not")

    def test_analysis_and_emulator_do_not_know_each_other(self):
        self.assert_illegal(offences(tools__plant_emulator__a_h='#include "analysis/recording/b.h"\n'), "plant_emulator may not")
        for folder in ("recording", "axis_model", "prediction_error", "identification", "diagnosis", "diagnosis/causes", "metrics"):
            key = "analysis__" + folder.replace("/", "__") + "__a_h"
            self.assert_illegal(offences(**{key: '#include "tools/plant_emulator/b.h"\n'}), "may not")
            self.assert_illegal(offences(**{key: '#include "tools/simulate/b.h"\n'}), "may not")

    def test_floors_of_the_analysis(self):
        self.assertEqual(offences(
            analysis__diagnosis__decision__a_cc='#include "analysis/diagnosis/screening/b.h"\n#include "analysis/prediction_error/b.h"\n',
            analysis__diagnosis__diagnose_cc='#include "analysis/diagnosis/decision/a.h"\n'), [])
        self.assert_illegal(offences(analysis__recording__a_h='#include "analysis/axis_model/b.h"\n'), "recording may not")
        self.assert_illegal(offences(analysis__prediction_error__a_h='#include "analysis/diagnosis/result/b.h"\n'), "may not")
        self.assert_illegal(offences(analysis__identification__a_h='#include "analysis/diagnosis/diagnose.h"\n'), "may not")
        self.assert_illegal(offences(analysis__diagnosis__screening__a_h='#include "analysis/diagnosis/decision/b.h"\n'), "may not")
        self.assert_illegal(offences(analysis__diagnosis__report__a_h='#include "analysis/diagnosis/decision/b.h"\n'), "may not")
        self.assert_illegal(offences(daemon__a_h='#include "analysis/recording/b.h"\n'), "daemon may not")

    def test_kinds_of_validation_are_blind_to_each_other(self):
        self.assert_illegal(offences(tools__validation__emps__a_h='#include "tools/validation/hidden/b.h"\n'), "emps may not")
        self.assert_illegal(offences(tools__simulate__a_h='#include "tools/contour/b.h"\n'), "simulate may not")

    def test_only_the_program_knows_the_emulator(self):
        text = '#include "tools/plant_emulator/emulated_machine.h"\n'
        self.assertEqual(offences(daemon__main_cc=text), [])
        self.assert_illegal(offences(daemon__startup_cc=text), "daemon may not")

    def test_the_realtime_side_neither_locks_nor_talks(self):
        for header in ("mutex", "iostream", "yaml-cpp/yaml.h", "spdlog/spdlog.h", "lcm/lcm-cpp.hpp", "modbus/modbus.h"):
            self.assert_illegal(offences(daemon__rt__a_h=f"#include <{header}>\n"), "real-time side", header)

    def test_a_folder_without_a_floor_is_caught(self):
        self.assert_illegal(offences(tools__novelty__a_h='#include "core/axis.h"\n'), "tools/novelty/a.h", "no floor")

    def test_paths_are_written_from_the_root(self):
        self.assert_illegal(offences(core__a_h='#include "axis.h"\n'), "root of the repository")
        self.assert_illegal(offences(core__a_h='#include "../core/axis.h"\n'), "root of the repository")


if __name__ == "__main__":
    unittest.main()
