#!/usr/bin/env python3
"""The peer's plant obeys mechanics: tested without CAN and without the product."""
import math
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from peer_drive.encoder import Encoder  # noqa: E402
from peer_drive.friction import StopFriction  # noqa: E402
from peer_drive.plant import Plant, PlantParameters  # noqa: E402

STEP_s = 1e-3 / Plant.STEPS_PER_ms


def friction(**changes):
    values = {"coulomb_plus": 100.0, "coulomb_minus": 80.0, "static_over_coulomb": 1.25, "stribeck_velocity": 3e-3,
              "viscous": 300.0, "elements": [(0.6, 8e6), (0.4, 2e6)], "damping": 0.0}
    return StopFriction(**{**values, **changes})


class FrictionTest(unittest.TestCase):
    def slide(self, law, velocity, travel):
        steps = round(abs(travel / velocity) / STEP_s)
        return [law.force(velocity, STEP_s) for _ in range(steps)][-1]

    def test_sliding_reaches_stribeck_and_viscous_force_either_way(self):
        speed = 0.03
        stribeck = 1.0 + 0.25 / (1.0 + (speed / 3e-3)**2)
        self.assertAlmostEqual(self.slide(friction(), speed, 1e-3), 100.0 * stribeck + 300.0 * speed, places=6)
        self.assertAlmostEqual(self.slide(friction(), -speed, 1e-3), -80.0 * stribeck - 300.0 * speed, places=6)

    def test_presliding_is_a_spring_that_gives_back(self):
        law = friction(viscous=0.0)
        there = self.slide(law, 1e-4, 1e-6)
        self.assertAlmostEqual(there, 1e-6 * 10e6, delta=0.1)
        back = self.slide(law, -1e-4, 1e-6)
        self.assertAlmostEqual(back, 0.0, places=6)

    def test_a_reversal_takes_twice_the_travel_of_a_breakaway(self):
        law = friction(coulomb_minus=100.0, static_over_coulomb=1.0, viscous=0.0)
        self.slide(law, 1e-3, 1e-3)
        travel = 2 * law.breakaway_travel()
        self.assertGreater(self.slide(law, -1e-3, 0.9 * travel), -99.0)
        self.assertAlmostEqual(self.slide(law, -1e-3, 0.2 * travel), -100.0, places=6)


class PlantTest(unittest.TestCase):
    def run_plant(self, plant, torque_Nm, milliseconds):
        """The work of the motor."""
        work_J = 0.0
        for _ in range(milliseconds * Plant.STEPS_PER_ms):
            before_rad = plant.angle_rad
            plant.step(torque_Nm, STEP_s)
            work_J += torque_Nm * (plant.angle_rad - before_rad)
        return work_J

    def test_energy_never_comes_from_nowhere(self):
        plant = Plant(PlantParameters(cogging_Nm=0.0))
        work_J = 0.0
        for torque_Nm in (0.3, -0.5, 0.0, 0.8, -0.8, 0.1, 0.0):
            work_J += self.run_plant(plant, torque_Nm, 40)
            self.assertLessEqual(plant.energy_J(), work_J + 1e-6)

    def test_without_friction_energy_is_kept(self):
        plant = Plant(PlantParameters(cogging_Nm=0.0, motor_coulomb_Nm=1e-12, motor_viscous_Nms_rad=0.0, coulomb_plus_N=1e-9,
                                      coulomb_minus_N=1e-9, viscous_Ns_m=0.0, presliding_damping_Ns_m=0.0))
        work_J = self.run_plant(plant, 0.5, 50)
        self.assertAlmostEqual(plant.energy_J() / work_J, 1.0, delta=0.01)

    def test_it_sticks_below_friction_and_slides_above(self):
        p = PlantParameters()
        scale = Plant(p).m_per_rad
        breakaway_Nm = p.coulomb_plus_N * p.static_over_coulomb * scale + p.motor_coulomb_Nm * 1.05 + p.cogging_Nm
        stuck, free = Plant(p), Plant(p)
        self.run_plant(stuck, 0.7 * breakaway_Nm, 300)
        self.run_plant(free, 1.3 * breakaway_Nm, 300)
        self.assertLess(abs(stuck.table_m), 1e-4)
        self.assertLess(abs(stuck.table_m_s), 1e-5)
        self.assertGreater(free.table_m, 5e-3)

    def test_acceleration_is_torque_less_friction_over_both_inertias(self):
        p = PlantParameters(cogging_Nm=0.0)
        plant = Plant(p)
        self.run_plant(plant, 1.0, 30)
        speed, seconds = plant.table_m_s, 10e-3
        self.run_plant(plant, 1.0, 10)
        mean = 0.5 * (speed + plant.table_m_s)
        mass_kg = p.motor_inertia_kgm2 / plant.m_per_rad**2 + p.table_mass_kg
        against_N = (p.coulomb_plus_N + p.viscous_Ns_m * mean
                     + (p.motor_coulomb_Nm + p.motor_viscous_Nms_rad * mean / plant.m_per_rad) / plant.m_per_rad)
        expected = (1.0 / plant.m_per_rad - against_N) / mass_kg
        self.assertAlmostEqual((plant.table_m_s - speed) / seconds / expected, 1.0, delta=0.03)

    def test_half_the_step_makes_little_difference(self):
        """Fine enough: the path of a shove and a coast hardly depends on the step."""
        ends = []
        for parts in (1, 4):
            plant = Plant(PlantParameters())
            for torque_Nm in (0.9, 0.0):
                for _ in range(60 * Plant.STEPS_PER_ms * parts):
                    plant.step(torque_Nm, STEP_s / parts)
            ends.append(plant.table_m)
        self.assertAlmostEqual(ends[0] / ends[1], 1.0, delta=0.01)


class EncoderTest(unittest.TestCase):
    def encoder(self, **changes):
        return Encoder(**{"counts_per_turn": 1000, "absolute": False, "noise_counts": 0.0, "seed": 1, **changes})

    def test_counts_turns(self):
        self.assertEqual(self.encoder().read(2.0 * math.pi * 1.5 + 1e-9), 1500)

    def test_an_incremental_one_begins_anew_and_an_absolute_one_does_not(self):
        turn = 2.0 * math.pi + 1e-9
        for absolute, expected in ((False, 0), (True, 1000)):
            encoder = self.encoder(absolute=absolute)
            encoder.power_up(turn)
            self.assertEqual(encoder.read(turn), expected)

    def test_faults(self):
        encoder = self.encoder()
        encoder.jump(7)
        self.assertEqual(encoder.read(1e-9), 7)
        encoder.freeze()
        self.assertEqual([encoder.read(0.5), encoder.read(1.0)], [86, 86])
        encoder.mend()
        self.assertEqual(encoder.read(1.0), 166)
        encoder.freeze(flickers=True)
        self.assertEqual({encoder.read(2.0) for _ in range(50)}, {325, 326})
        encoder.mend()
        encoder.reverse(1.0)
        self.assertEqual(encoder.read(2.0), 7)


if __name__ == "__main__":
    unittest.main()
