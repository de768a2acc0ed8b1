"""Draws axes of many makes, and what their owners would state about them.

An axis is a dict of floats, at the motor: rad, Nm. Two machines drawn from the same seed are the same, whatever effect is hidden.
"""
import numpy as np

TURN = 2.0 * np.pi
TICK_S = 1e-3
# Relative standard deviations that the owner states; None of them is cut off, as real ones are not.
STATED = {"motor_inertia": 0.05, "load_inertia": 0.05, "stiffness": 0.1, "Fc": 0.1, "Fs": 0.1, "vs": 0.2, "sigma0": 0.2, "sigma1": 0.3,
          "sigma2": 0.15, "lag_s": 0.1, "torque_constant": 0.02, "delay_s": 0.01}


def log_uniform(random, low, high):
    return low * np.exp(random.uniform() * np.log(high / low))


def draw_friction(random, axis):
    axis["Fc"] = axis["rated"] * random.uniform(0.03, 0.1)
    axis["Fs"] = axis["Fc"] * random.uniform(1.15, 1.5)
    axis["stribeck_exponent"] = float(random.choice([1.0, 2.0]))
    speed = axis["fast_rad_s"]
    axis["vs"] = speed * log_uniform(random, 0.004, 0.02)
    # Breaks away within 1 to 10 um at the table.
    axis["sigma0"] = axis["Fc"] / (log_uniform(random, 1e-6, 1e-5) / axis["lever_m"])
    axis["sigma1"] = 0.3 * np.sqrt(axis["sigma0"] * axis["inertia"]) * random.uniform(0.3, 1.0)
    axis["sigma2"] = axis["Fc"] * random.uniform(0.1, 0.6) / speed


def draw_axis(seed, needs=()):
    """What it is, before anything is hidden. `needs`: two_inertia, rigid, scale, thermometer, second_axis."""
    random = np.random.default_rng([seed, 1])
    axis = {"seed": seed}
    axis["lead_mm"] = float(random.choice([4.0, 5.0, 10.0, 16.0, 20.0]))
    axis["lever_m"] = axis["lead_mm"] * 1e-3 / TURN
    axis["rated"] = log_uniform(random, 0.3, 12.0)
    axis["inertia"] = axis["rated"] / log_uniform(random, 4000.0, 12000.0)
    axis["stroke_m"] = log_uniform(random, 0.15, 0.5)
    axis["fast_rad_s"] = random.uniform(0.15, 0.3) / axis["lever_m"]
    share = random.uniform(0.1, 0.6)
    axis["load_inertia"] = share * axis["inertia"]
    axis["motor_inertia"] = axis["inertia"] - axis["load_inertia"]
    mode_Hz = log_uniform(random, 60.0, 1500.0)
    soft_Hz, stiff_Hz = log_uniform(random, 60.0, 400.0), log_uniform(random, 700.0, 1500.0)
    mode_Hz = soft_Hz if "two_inertia" in needs else stiff_Hz if "rigid" in needs else mode_Hz
    axis["mode_Hz"] = mode_Hz
    # Nobody states a screw that no control loop sees.
    axis["stated_rigid"] = mode_Hz > 600.0
    axis["set_stiffness"] = TURN * TURN * mode_Hz**2 * axis["load_inertia"] * axis["motor_inertia"] / axis["inertia"]
    axis["stiffness"] = axis["set_stiffness"]
    axis["damping_ratio"] = random.uniform(0.02, 0.06)
    axis["friction_on_load"] = random.uniform() < 0.4
    axis["motor_share"] = 0.0
    draw_friction(random, axis)
    axis["delay_s"] = float(random.choice([0.5e-3, 1e-3, 1.5e-3]))
    axis["lag_s"] = random.uniform(0.1e-3, 0.4e-3)
    axis["counts"] = float(2 ** random.integers(16, 21))
    axis["torque_step"] = axis["rated"] / float(random.choice([1000.0, 8192.0, 32768.0]))
    axis["scale"] = "scale" in needs or random.uniform() < 0.5
    axis["scale_step_m"] = float(random.choice([0.1e-6, 0.5e-6, 1e-6]))
    axis["thermometer"] = "thermometer" in needs or random.uniform() < 0.5
    axis["second_axis"] = "second_axis" in needs
    draw_noise(random, axis)
    axis["excitation"] = int(random.integers(1 << 31))
    return axis


def draw_noise(random, axis):
    """Torque noise: white, and a part with a corner between 0.4 and 30 Hz; a scale that wanders."""
    axis["white"] = axis["rated"] * log_uniform(random, 0.001, 0.005)
    axis["coloured"] = axis["white"] * random.uniform(0.0, 0.7)
    axis["corner_Hz"] = log_uniform(random, 0.4, 30.0)
    axis["wander_m"] = random.uniform(0.0, 0.3e-6)
    axis["wander_s"] = log_uniform(random, 3.0, 60.0)


def stated_of(axis):
    """The owner's numbers: off by a normal deviate of what is stated of each."""
    random = np.random.default_rng([axis["seed"], 2])
    stated = dict(axis)
    for key, sigma in STATED.items():
        deviate = random.normal()
        if key in axis and key != "torque_constant":
            stated[key] = axis[key] / (1.0 + sigma * np.clip(deviate, -2.5, 2.5))
    # An axis that breaks away with more than it slides with is never stated without.
    stated["Fs"] = max(stated["Fs"], 1.08 * stated["Fc"])
    return stated
