"""The mechanics of the peer's axis: motor and table, a screw between them that is a spring, friction on both sides, cogging.

Metres and newtons at the table's side are what the screw makes of turns and torque. Nothing random is in here: noise
belongs to the encoder.
"""
import math
from dataclasses import dataclass, field

from .friction import StopFriction


@dataclass
class PlantParameters:
    lead_mm: float = 10.0
    motor_inertia_kgm2: float = 3.2e-4
    table_mass_kg: float = 25.0
    screw_stiffness_N_um: float = 95.0
    screw_damping_Ns_m: float = 2600.0
    gravity_N: float = 0.0
    cogging_Nm: float = 0.008
    cogging_per_turn: int = 12
    motor_coulomb_Nm: float = 0.035
    motor_viscous_Nms_rad: float = 1.2e-4
    motor_presliding_rad: float = 4e-4
    coulomb_plus_N: float = 112.0
    coulomb_minus_N: float = 96.0
    static_over_coulomb: float = 1.25
    stribeck_mm_s: float = 3.0
    viscous_Ns_m: float = 310.0
    presliding: list = field(default_factory=lambda: [[0.55, 8.0e6], [0.45, 2.5e6]])  # share of the yield, N/m
    presliding_damping_Ns_m: float = 2500.0
    end_stop_mm: float = 240.0


class Plant:
    STEPS_PER_ms = 16

    def __init__(self, parameters):
        p = self.parameters = parameters
        self.m_per_rad = p.lead_mm * 1e-3 / (2.0 * math.pi)
        self.friction = StopFriction(p.coulomb_plus_N, p.coulomb_minus_N, p.static_over_coulomb, p.stribeck_mm_s * 1e-3,
                                     p.viscous_Ns_m, p.presliding, p.presliding_damping_Ns_m)
        motor_stiffness = p.motor_coulomb_Nm / p.motor_presliding_rad
        self.bearing = StopFriction(p.motor_coulomb_Nm, p.motor_coulomb_Nm, 1.05, 1.0, p.motor_viscous_Nms_rad,
                                    [(1.0, motor_stiffness)], 2e-3)
        self.stiffness_N_m = p.screw_stiffness_N_um * 1e6
        self.angle_rad = 0.0
        self.speed_rad_s = 0.0
        self.table_m = 0.0
        self.table_m_s = 0.0

    @property
    def motor_m(self):
        return self.angle_rad * self.m_per_rad

    def step(self, torque_Nm, step_s):
        """One step, semi-implicit: forces from the positions, speeds from the forces, positions from the new speeds."""
        p, scale = self.parameters, self.m_per_rad
        screw_N = (self.stiffness_N_m * (self.angle_rad * scale - self.table_m)
                   + p.screw_damping_Ns_m * (self.speed_rad_s * scale - self.table_m_s))
        table_N = screw_N - self.friction.force(self.table_m_s, step_s) - p.gravity_N - self._end_stop_N()
        motor_Nm = (torque_Nm - screw_N * scale - self.bearing.force(self.speed_rad_s, step_s)
                    - p.cogging_Nm * math.sin(p.cogging_per_turn * self.angle_rad))
        self.table_m_s += table_N / p.table_mass_kg * step_s
        self.speed_rad_s += motor_Nm / p.motor_inertia_kgm2 * step_s
        self.table_m += self.table_m_s * step_s
        self.angle_rad += self.speed_rad_s * step_s

    def _end_stop_N(self):
        beyond_m = abs(self.table_m) - self.parameters.end_stop_mm * 1e-3
        if beyond_m <= 0.0:
            return 0.0
        return math.copysign(5e6 * beyond_m, self.table_m) + 3000.0 * self.table_m_s

    def energy_J(self):
        """Kinetic energy and what springs hold."""
        p = self.parameters
        return (0.5 * p.motor_inertia_kgm2 * self.speed_rad_s**2 + 0.5 * p.table_mass_kg * self.table_m_s**2
                + 0.5 * self.stiffness_N_m * (self.motor_m - self.table_m)**2 + self.friction.stored_energy()
                + self.bearing.stored_energy())
