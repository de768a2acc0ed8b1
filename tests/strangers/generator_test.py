#!/usr/bin/env python3
"""The strangers are what they are said to be: the same for the same seed, on their path, with the friction and the effect that was hidden."""
import tempfile
import unittest
from pathlib import Path

import numpy as np

from draw_axis import TICK_S, draw_axis, stated_of
from effects import HIDE, NEEDS, Limits, hidden
from evidence import evidence
from motion import Motion, stroke
from share import foreseen, friction_moved, left_after_refit, of_scale
from simulate import STEP_S, Batch
from sizing import SHARES, TURNS, Case, shares, simulate
from write_case import model_text, write_case


def strokes(axis):
    """A second of rest, a stroke there and back."""
    m = Motion(axis)
    m.to(0.1 * axis["stroke_m"] / axis["lever_m"], 0.3 * m.fast)
    m.to(0.0, 0.3 * m.fast)
    return np.concatenate(m.x), np.concatenate(m.u), np.concatenate(m.other)


def run(axis, effect=None, law="lugre"):
    motion = strokes(axis)
    return Batch([axis], [effect or {}], [motion], law).run(), motion


def sliding_torque(columns, motion):
    """Mean torque while it moves up, and down."""
    speed = np.gradient(motion[0], TICK_S)
    fast = 0.9 * np.max(speed)
    torque = columns["torque"][:, 0]
    return torque[speed > fast].mean(), torque[speed < -fast].mean()


class Strangers(unittest.TestCase):
    def test_a_seed_is_one_axis_whatever_is_hidden(self):
        self.assertEqual(draw_axis(3), draw_axis(3))
        self.assertNotEqual(draw_axis(3)["rated"], draw_axis(4)["rated"])

    def test_every_cause_has_an_effect_with_a_truth(self):
        for kind in HIDE:
            axis = draw_axis(11, NEEDS.get(kind, ()))
            _, truth = hidden(kind, axis, 1.0, np.random.default_rng(1))
            self.assertTrue(truth, kind)

    def test_it_keeps_its_path_and_friction_is_what_was_drawn(self):
        for law in ("lugre", "dahl", "maxwell_slip"):
            axis = {**draw_axis(21), "white": 0.0, "coloured": 0.0}
            columns, motion = run(axis, law=law)
            error_m = axis["lever_m"] * np.max(np.abs(columns["q"][:, 0] - motion[0]))
            self.assertLess(error_m, 0.02 * axis["stroke_m"], law)
            up, down = sliding_torque(columns, motion)
            friction = axis["Fc"] + axis["sigma2"] * 0.3 * axis["fast_rad_s"]
            self.assertAlmostEqual(0.5 * (up - down) / friction, 1.0, delta=0.12, msg=law)

    def test_a_hidden_torque_and_a_hidden_asymmetry_are_there(self):
        axis = {**draw_axis(21), "white": 0.0, "coloured": 0.0}
        plain = sum(sliding_torque(*run(axis)))
        pushed = sum(sliding_torque(*run(axis, {"offset": 0.3 * axis["Fc"]})))
        self.assertAlmostEqual((pushed - plain) / (-0.6 * axis["Fc"]), 1.0, delta=0.1)
        uneven = sum(sliding_torque(*run(axis, {"asymmetry": 0.4})))
        self.assertAlmostEqual((uneven - plain) / (0.4 * axis["Fc"]), 1.0, delta=0.15)

    def test_noise_does_not_depend_on_what_is_made_beside(self):
        axes = [draw_axis(21), draw_axis(22)]
        motion = tuple(np.zeros(300) for _ in range(3))
        alone = Batch(axes[1:], [{}], [motion], "lugre").run()["torque"][:, 0]
        beside = Batch(axes, [{}, {}], [motion, motion], "lugre").run()["torque"][:, 1]
        self.assertTrue(np.array_equal(alone, beside))

    def test_a_soft_element_goes_on_where_the_rest_slides(self):
        axis = draw_axis(21)
        motion = tuple(np.zeros(10) for _ in range(3))
        batch = Batch([axis], [{"soft_share": 0.1, "soft_ratio": 0.1}], [motion], "lugre")
        batch.slow_parts(1)
        # Fast enough for the level to be Coulomb's alone; a hundred steps are a length of the bristle.
        speed = axis["Fc"] / axis["sigma0"] / 100.0 / STEP_S
        torques = [float(batch.friction(np.array([speed]), np.array([0.0]))[0]) for _ in range(6000)]
        self.assertLess(torques[300] / torques[-1], 0.92)

    def test_no_loop_swings_against_its_drive(self):
        # A mode of 90 Hz behind a delay of 1.5 ms: at 18 Hz its loop would.
        columns, _ = run(draw_axis(4100009))
        self.assertLess(np.max(np.abs(columns["torque"])), draw_axis(4100009)["rated"])

    def test_what_changes_does_so_in_the_axis_s_own_log(self):
        axis = {**draw_axis(21), "white": 0.0, "coloured": 0.0}
        short, effect = strokes(axis), {"drift": 0.5, "payload": 0.3, "payload_at": 0.5}
        longer = tuple(np.concatenate([x, np.full(2 * len(x), x[-1])]) for x in short)
        alone = Batch([axis], [effect], [short], "lugre").run()["q"][:, 0]
        beside = Batch([axis, axis], [effect, {}], [short, longer], "lugre").run()["q"][:len(alone), 0]
        self.assertLess(np.max(np.abs(alone - beside)), 1e-9)

    def test_what_pulls_from_outside_winds_the_screw_up(self):
        axis = {**draw_axis(21, ("two_inertia", "scale")), "white": 0.0, "coloured": 0.0, "wander_m": 0.0, "scale_step_m": 1e-9,
                "friction_on_load": False}
        pull = 0.3 * axis["Fc"]

        def twist_m(effect):
            columns, _ = run(axis, effect)
            return (columns["table"][-1, 0] - axis["lever_m"] * columns["q"][-1, 0])

        count_m = axis["lever_m"] * 2.0 * np.pi / axis["counts"]
        self.assertAlmostEqual(twist_m({"offset": pull}) - twist_m({}), axis["lever_m"] * pull / axis["stiffness"], delta=2.0 * count_m)

    def test_a_stroke_ends_where_it_is_to(self):
        x = stroke(-3.0, 2.0, 40.0)
        self.assertAlmostEqual(x[-1], -3.0)
        self.assertLessEqual(np.max(np.abs(np.diff(x))) / TICK_S, 2.05)

    def test_a_case_is_three_files(self):
        axis = draw_axis(31, ("scale", "thermometer"))
        rows = 10
        columns = {name: np.zeros(rows) for name in ("q", "torque", "table", "temperature", "other")}
        with tempfile.TemporaryDirectory() as folder:
            write_case(folder, axis, stated_of(axis), columns, {"kind": "clean"}, False)
            self.assertEqual(sorted(p.name for p in Path(folder).iterdir()), ["log.csv", "model.yaml", "truth.json"])
            header = (Path(folder) / "log.csv").read_text(encoding="utf-8").splitlines()[0]
        self.assertEqual(header, "time_s,torque_Nm,motor_angle_rad,table_position_m,temperature_degC")
        self.assertIn("uncertainty:", model_text(stated_of(axis), False))

    def test_compiled_steps_are_those_of_numpy(self):
        for law in ("lugre", "dahl", "maxwell_slip"):
            cases = [Case(kind, 8200000 + 1000 * number, "clear", law) for number, kind in enumerate(HIDE)]
            motions = [tuple(column[:50] for column in c.motion) for c in cases]
            of = [[c.axis for c in cases], [{**c.effect, "payload_at": 0.5} for c in cases], motions, law, [c.model for c in cases]]
            batch = Batch(*of)
            if batch.function is None:
                self.skipTest("no compiler")
            quick, plain = batch.run(), Batch(*of, fast=False).run()
            for name, column in plain.items():
                self.assertLess(np.max(np.abs(quick[name] - column)), 1e-9 * (1.0 + np.max(np.abs(column))), f"{law} {name}")

    def test_an_axis_with_nothing_hidden_leaves_its_noise(self):
        for law in ("lugre", "dahl", "maxwell_slip"):
            for seed, needs in ((21, ("two_inertia",)), (22, ("rigid",))):
                axis = {**draw_axis(seed, needs), "friction_on_load": seed == 21}
                columns = Batch([axis], [{}], [strokes(axis)], law, [axis]).run()
                log = {name: values[:, 0] for name, values in columns.items()}
                left = np.where(foreseen(axis, log), log["unexplained_torque"], 0.0)
                self.assertLess(np.max(np.abs(left)), 1e-6 * axis["white"], law)

    def test_a_hidden_torque_is_all_that_is_left(self):
        axis = draw_axis(21, ("two_inertia",))
        push = 0.1 * axis["Fc"]
        left = Batch([axis], [{"offset": push}], [strokes(axis)], "lugre", [axis]).run()["unexplained_torque"][:, 0]
        # It pulls forward: the motor arrives with too little.
        self.assertAlmostEqual(left[-200:].mean() / -push, 1.0, delta=0.02)

    def test_evidence_is_the_square_of_an_effect_in_deviations_of_the_noise(self):
        axis = {**draw_axis(21, ("two_inertia",)), "white": 0.0, "coloured": 0.0}
        noisy = {**axis, "white": 1e-3 * axis["rated"]}
        for rel in (0.02, 0.04):
            columns = Batch([axis], [{"offset": rel * axis["Fc"]}], [strokes(axis)], "lugre", [axis]).run()
            log = {name: values[:, 0] for name, values in columns.items()}
            friction = friction_moved([axis], "lugre", columns["true_q"])[:, :, 0]
            most = len(log["q"]) * (rel * axis["Fc"] / noisy["white"]) ** 2
            # Less what the encoder hides, what numbers of the model make up for, and rows that nobody foresees.
            self.assertAlmostEqual(evidence(noisy, log, friction) / most, 0.75, delta=0.25)

    def test_a_refit_takes_what_is_stated_and_no_more(self):
        column = np.random.default_rng(1).normal(size=4000)
        within = left_after_refit(1.5 * column, column[:, None], 1e-6)
        beyond = left_after_refit(3.0 * column, column[:, None], 1e-6)
        self.assertLess(within, 1e-6)
        self.assertAlmostEqual(beyond, np.mean(column**2), delta=1e-3)

    def test_a_stated_coupling_takes_wind_up(self):
        turn = np.random.default_rng(2).normal(size=1000)
        log = {"true_q": np.zeros(1000), "unexplained_table": 0.1 * turn, "true_table": 1.1 * turn, "table": 1.1 * turn,
               "parted": np.zeros(1000)}
        self.assertLess(of_scale({"lever_m": 1.0, "Fc": 1.0, "stated_rigid": False}, log)[0], 1e-20)
        self.assertAlmostEqual(of_scale({"lever_m": 1.0, "Fc": 1.0, "stated_rigid": True}, log)[0], np.var(0.1 * turn))

    def test_an_effect_of_the_size_found_has_the_share_asked(self):
        case = Case("cogging", 8209000, "moderate", "lugre")
        case.size *= 3.0
        for _ in range(4):
            case.prepare()
            case.motion = tuple(column[8000:20000] for column in case.motion)
            logs, q = simulate([case])
            if case.measured(shares([case], logs, q)[0]):
                break
        self.assertAlmostEqual(case.share, SHARES["moderate"], delta=0.03)
        again = shares([case], logs, q)[0]
        self.assertEqual(case.share, again)

    def test_between_a_size_too_small_and_one_too_large_it_is_found(self):
        # What a refit takes up to a size leaves nothing, and all of a sudden much.
        case, share = Case("stribeck", 8204000, "moderate", "lugre"), 0.9
        for _ in range(TURNS):
            if case.measured(share):
                break
            share = max(1e-9, 1.0 - 0.25 / case.size)
        self.assertAlmostEqual(case.share, SHARES["moderate"], delta=0.03)

    def test_a_size_beyond_what_a_machine_can_have_is_none(self):
        case, limits = Case("asymmetric_coulomb", 8201000, "moderate", "lugre"), Limits()
        hidden("asymmetric_coulomb", dict(case.axis), 1e4, np.random.default_rng(1), limits)
        self.assertTrue(limits.beyond)
        case.size = 1e4
        self.assertFalse(case.measured(1e-8))
        self.assertEqual(case.why_not, "beyond what a machine can have")


if __name__ == "__main__":
    unittest.main()
