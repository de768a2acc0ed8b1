"""A CiA 402 servo drive without its bus: power state machine, torque and position loop, quick stop, and the axis it drives.

It sees its axis through its encoder only, as a real drive does: what the encoder gets wrong, the position loop and the
quick-stop ramp get wrong, too.
"""
import math
from dataclasses import dataclass, field

from .encoder import Encoder
from .plant import Plant, PlantParameters

CSP, CST = 8, 10

NOT_READY, DISABLED, READY, SWITCHED_ON, ENABLED, QUICK_STOP, REACTION, FAULT = (
    "Not Ready To Switch On", "Switch On Disabled", "Ready To Switch On", "Switched On", "Operation Enabled",
    "Quick Stop Active", "Fault Reaction Active", "Fault")
STATE_BITS = {NOT_READY: 0x00, DISABLED: 0x40, READY: 0x21, SWITCHED_ON: 0x23, ENABLED: 0x27, QUICK_STOP: 0x07,
              REACTION: 0x0F, FAULT: 0x08}
VOLTAGE_ENABLED, REMOTE, FOLLOWS_TARGET = 1 << 4, 1 << 9, 1 << 12
# Bits 0 to 3 of the controlword
COMMANDS = {"shutdown": (0x07, 0x06), "switch on": (0x0F, 0x07), "enable": (0x0F, 0x0F), "quick stop": (0x06, 0x02)}


@dataclass
class ServoParameters:
    rated_torque_Nm: float = 2.4
    peak_torque_Nm: float = 7.2
    encoder_counts_per_rev: int = 131072
    absolute_encoder: bool = True
    encoder_noise_counts: float = 0.3
    encoder_offset_turns: float = 0.0
    current_lag_ms: float = 0.35
    switch_on_ms: int = 4        # charging
    enable_ms: int = 15          # the motor is magnetised, a brake would open
    follow_ms: int = 2           # from then on it follows the target
    torque_constant_rel: float = 1.0  # of what the drive believes it gives
    position_gain_1_s: float = 45.0
    velocity_gain_1_s: float = 260.0
    velocity_integral_1_s: float = 40.0
    velocity_filter_ms: float = 0.5
    believed_inertia_kgm2: float = 3.7e-4  # motor and table
    quick_stop_deceleration_rad_s2: float = 3000.0
    plant: dict = field(default_factory=dict)


class Servo:
    STEPS_PER_CONTROL = 2

    def __init__(self, parameters, seed):
        p = self.parameters = parameters
        self.plant = Plant(PlantParameters(**p.plant))
        self.encoder = Encoder(p.encoder_counts_per_rev, p.absolute_encoder, p.encoder_noise_counts, seed,
                               p.encoder_offset_turns)
        self.rad_per_count = 2.0 * math.pi / p.encoder_counts_per_rev
        # Objects that the master writes
        self.mode = 0
        self.torque_limit_per_mille = 1000.0 * p.peak_torque_Nm / p.rated_torque_Nm
        self.quick_stop_option = 2
        self.fault_reaction_option = 2
        self.disable_option = 1
        self.quick_stop_deceleration_rad_s2 = p.quick_stop_deceleration_rad_s2
        # What breaks
        self.gives_torque = True
        self.reports_demand = False
        self.ignores_target = False
        self.power_up()

    def power_up(self):
        """Power off and on: whatever the axis does meanwhile, the drive starts anew."""
        self.state = DISABLED
        self.controlword = 0
        self.wait_ms = 0
        self.enabled_ms = 0
        self.target_torque_per_mille = 0
        self.target_position_counts = None
        self.torque_offset_per_mille = 0
        self.mode = 0
        self.demand_Nm = 0.0     # what the current loop is asked for
        self.torque_Nm = 0.0     # what it gives, as the drive measures it
        self.mean_torque_Nm = 0.0  # what really turned the motor in the last period
        self._ramp_rad_s = None
        self._pending_state = None
        self._cascade_reset()
        self.start_counting()

    def start_counting(self):
        """What an incremental encoder begins with when the drive first looks at it."""
        self.encoder.power_up(self.plant.angle_rad)
        self.position_counts = self._filter_counts = self.encoder.read(self.plant.angle_rad)
        self._filter_rad_s = 0.0

    # The wire's side --------------------------------------------------------------------------------------------

    @property
    def statusword(self):
        word = STATE_BITS[self.state] | VOLTAGE_ENABLED | REMOTE
        if self.state == ENABLED and self.enabled_ms >= self.parameters.follow_ms and not self.ignores_target:
            word |= FOLLOWS_TARGET
        return word

    @property
    def actual_torque_per_mille(self):
        shown_Nm = self.demand_Nm if self.reports_demand else self.torque_Nm
        return max(-32768, min(32767, round(1000.0 * shown_Nm / self.parameters.rated_torque_Nm)))

    def command(self, controlword):
        """One controlword, at a SYNC: at most one transition."""
        rising = controlword & ~self.controlword
        self.controlword = controlword

        def says(name):
            mask, value = COMMANDS[name]
            return controlword & mask == value

        voltage_off = controlword & 0x02 == 0
        state = self.state
        if state in (REACTION, NOT_READY):
            return
        if state == FAULT:
            if rising & 0x80:
                self._go(DISABLED)
            return
        if voltage_off:
            if state != DISABLED:
                self._go(DISABLED)
        elif state == DISABLED:
            if says("shutdown"):
                self._go(READY)
        elif state == QUICK_STOP:
            pass
        elif says("quick stop"):
            if state == ENABLED:
                self.quick_stop()
            else:
                self._go(DISABLED)
        elif state == READY:
            if says("switch on") or says("enable"):
                self._go_after(SWITCHED_ON, self.parameters.switch_on_ms)
        elif state == SWITCHED_ON:
            if says("enable"):
                self._go_after(ENABLED, self.parameters.enable_ms)
            elif says("shutdown"):
                self._go(READY)
        elif state == ENABLED:
            if says("switch on"):
                self._go(SWITCHED_ON)
            elif says("shutdown"):
                self._go(READY)

    def quick_stop(self):
        if self.state == ENABLED:
            if self.quick_stop_option == 0:
                self._go(DISABLED)
            else:
                self._go(QUICK_STOP)

    def fail(self):
        """An internal fault: stops by its ramp, then Fault."""
        if self.state in (ENABLED, QUICK_STOP):
            self._go(REACTION if self.fault_reaction_option else FAULT)
        elif self.state not in (REACTION, FAULT):
            self._go(FAULT)

    def torque_is_on(self):
        return self.state in (ENABLED, QUICK_STOP, REACTION)

    def is_off_and_at_rest(self):
        return not self.torque_is_on() and abs(self.plant.table_m_s) < 1e-5 and abs(self.torque_Nm) < 1e-9

    # Time -------------------------------------------------------------------------------------------------------

    def advance(self, period_us):
        """The axis and the drive's loops, one period on, with the targets as they are."""
        self._transitions(period_us / 1000.0)
        if self.mode == CSP and self.state == ENABLED:
            if self.target_position_counts is None:
                self.target_position_counts = self.position_counts
            start = self._interpolated if self._interpolated is not None else self.position_counts
            goal = start if self.ignores_target else self.target_position_counts
        else:
            self._interpolated = None
            start = goal = None
        steps = Plant.STEPS_PER_ms * period_us // 1000
        controls = steps // self.STEPS_PER_CONTROL
        step_s = 1e-3 / Plant.STEPS_PER_ms
        control_s = self.STEPS_PER_CONTROL * step_s
        share = 1.0 - math.exp(-step_s * 1000.0 / self.parameters.current_lag_ms)
        given = self.parameters.torque_constant_rel if self.gives_torque else 0.0
        limit_Nm = min(self.parameters.peak_torque_Nm, self.torque_limit_per_mille / 1000.0 * self.parameters.rated_torque_Nm)
        plant, lost = self.plant, not self.gives_torque
        total_Nm = 0.0
        for control in range(controls):
            reference = None if start is None else start + (goal - start) * (control + 1) / controls
            slope = 0.0 if start is None else (goal - start) / (controls * control_s)
            self.demand_Nm = max(-limit_Nm, min(limit_Nm, self._demand_Nm(control_s, reference, slope)))
            for _ in range(self.STEPS_PER_CONTROL):
                if self.torque_is_on():
                    self.torque_Nm += share * ((0.0 if lost else self.demand_Nm) - self.torque_Nm)
                else:
                    self.torque_Nm = 0.0
                plant.step(given * self.torque_Nm, step_s)
                total_Nm += given * self.torque_Nm
        if goal is not None:
            self._interpolated = goal
        self.mean_torque_Nm = total_Nm / steps
        self._ends_of_ramps()
        self.position_counts = self.encoder.read(plant.angle_rad)

    def _transitions(self, elapsed_ms):
        if self._pending_state is not None:
            self.wait_ms -= elapsed_ms
            if self.wait_ms <= 0:
                self._go(self._pending_state)
        if self.state == ENABLED:
            self.enabled_ms += elapsed_ms

    def _go_after(self, state, wait_ms):
        if self._pending_state != state:
            self._pending_state, self.wait_ms = state, wait_ms

    def _go(self, state):
        self._pending_state = None
        if state == ENABLED:
            self._cascade_reset()
            self.enabled_ms = 0
            self.target_position_counts = self.position_counts
        if state in (QUICK_STOP, REACTION):
            self._ramp_rad_s = self._filter_rad_s
            self._integral_Nm = 0.0
        if state not in (ENABLED, QUICK_STOP, REACTION):
            self.demand_Nm = 0.0
        self.state = state

    def _cascade_reset(self):
        self._interpolated = None
        self._integral_Nm = 0.0

    # Loops ------------------------------------------------------------------------------------------------------

    def _demand_Nm(self, control_s, reference_counts, slope_counts_s):
        p = self.parameters
        counts = self.encoder.read(self.plant.angle_rad)
        raw_rad_s = (counts - self._filter_counts) * self.rad_per_count / control_s
        self._filter_counts = counts
        self._filter_rad_s += (1.0 - math.exp(-control_s * 1000.0 / p.velocity_filter_ms)) * (raw_rad_s - self._filter_rad_s)
        if self.state == ENABLED and self.mode == CST:
            if self.ignores_target:
                return 0.0
            return self.target_torque_per_mille / 1000.0 * p.rated_torque_Nm
        if self.state == ENABLED and self.mode == CSP:
            error_rad = (reference_counts - counts) * self.rad_per_count
            speed_rad_s = p.position_gain_1_s * error_rad + slope_counts_s * self.rad_per_count
            offset_Nm = self.torque_offset_per_mille / 1000.0 * p.rated_torque_Nm
            return offset_Nm + self._velocity_loop_Nm(speed_rad_s, control_s)
        if self.state in (QUICK_STOP, REACTION):
            fall = self.quick_stop_deceleration_rad_s2 * control_s
            self._ramp_rad_s = math.copysign(max(0.0, abs(self._ramp_rad_s) - fall), self._ramp_rad_s)
            return self._velocity_loop_Nm(self._ramp_rad_s, control_s)
        return 0.0

    def _velocity_loop_Nm(self, wanted_rad_s, control_s):
        p = self.parameters
        error_rad_s = wanted_rad_s - self._filter_rad_s
        proportional_Nm = p.velocity_gain_1_s * p.believed_inertia_kgm2 * error_rad_s
        integral_Nm = self._integral_Nm + p.velocity_integral_1_s * proportional_Nm * control_s
        self._integral_Nm = max(-p.peak_torque_Nm, min(p.peak_torque_Nm, integral_Nm))
        return proportional_Nm + self._integral_Nm

    def _ends_of_ramps(self):
        if self.state in (QUICK_STOP, REACTION) and self._ramp_rad_s == 0.0:
            if abs(self._filter_rad_s) < 0.3:
                if self.state == REACTION:
                    self._go(FAULT)
                elif self.quick_stop_option < 5:
                    self._go(DISABLED)
