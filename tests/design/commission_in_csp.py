#!/usr/bin/env python3
"""Commissions an axis in csp whose machine file has torque mode, and finds it in torque mode afterwards.

    commission_in_csp.py CONTOURD CONTOUR MACHINE_FILE [--first]

The emulated machine in lock-step: measured as its drive holds it, interrupted, and with drives that have no csp. With --first
catalogue data that no loop is stable for all of: recorded in csp, then in torque mode with what that tells.
"""
import math
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import yaml

from commission_changes_mode import Daemon, commission_once


class TorqueMode(Daemon):
    """Its machine file has it, and an interrupt, a failure or an end gives it back."""

    OWN_MODE = "cst"

    def __init__(self, contourd, machine_file, scratch, overrides):
        super().__init__(contourd, machine_file, scratch, ["axes.x.drive.mode=cst", *overrides])

    def is_as_before(self):
        self.wait_for("Idle")
        return self.mode() == "cst"


def commission(contour, daemon, scratch, *options):
    return [contour, "commission", "--axis", "x", "--socket", daemon.path, "--yes", "--out", f"{scratch}/out",
            "--report", f"{scratch}/report", "--loop", f"{scratch}/loop.yaml", *options]


def drive_is_measured(contour, daemon, scratch):
    done = subprocess.run(commission(contour, daemon, scratch, "--drive"), capture_output=True, text=True)
    assert done.returncode == 0, (done.returncode, done.stdout, done.stderr)
    assert "held by its drive, and back to torque mode" in done.stdout, done.stdout
    assert "the position loops of all drives act" in done.stdout, done.stdout
    assert Path(f"{scratch}/out").exists() and daemon.is_as_before()
    assert "in csp for commissioning" in Path(daemon.messages).read_text(encoding="utf-8")


def loops_to_begin_with_are_found(contour, daemon, scratch):
    """The file's own is sharper than what the model leaves open bears; nothing moves without a yes."""
    asked = [word for word in commission(contour, daemon, scratch) if word != "--yes"]
    done = subprocess.run(asked, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    assert done.returncode == 2 and "--yes" in done.stderr, (done.returncode, done.stdout, done.stderr)
    assert "axis x: its loop is not stable for all that the model leaves open" in done.stdout, done.stdout
    assert "in torque mode, held by loops from here, and back to the machine file's loops" in done.stdout, done.stdout
    assert daemon.is_as_before()


def for_commissioning(daemon):
    return any("for commissioning" in warning for warning in daemon.ask(request="status")["status"]["warnings"])


def interrupt_gives_the_mode_back(contour, daemon, scratch, interrupt):
    Path(f"{scratch}/out").unlink(missing_ok=True)
    assert not for_commissioning(daemon)
    with subprocess.Popen(commission(contour, daemon, scratch, "--mode", "csp"), stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          text=True) as running:
        daemon.wait_for("Running")
        assert daemon.mode() == "csp" and for_commissioning(daemon), "told, for whoever does not know of the command"
        running.send_signal(interrupt)
        text, error = running.communicate()
        assert running.returncode == 1 and "did not end by itself" in error, (running.returncode, text, error)
    assert daemon.is_as_before() and not Path(f"{scratch}/out").exists()
    assert not for_commissioning(daemon)


def killed_gives_the_mode_back(contour, daemon, scratch):
    """Nobody is left to ask for it: contourd takes the torque off and goes back by itself."""
    with subprocess.Popen(commission(contour, daemon, scratch, "--mode", "csp"), stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL) as running:
        daemon.wait_for("Running")
        assert for_commissioning(daemon)
        running.kill()
    daemon.await_axis(lambda axis: axis["drive"]["mode"] == daemon.OWN_MODE)
    assert not for_commissioning(daemon)


def quick(contourd, contour, machine_file):
    with tempfile.TemporaryDirectory() as scratch:
        daemon = TorqueMode(contourd, machine_file, scratch, ["emulator.parameter_variation_rel=0"])
        try:
            loops_to_begin_with_are_found(contour, daemon, scratch)
            drive_is_measured(contour, daemon, scratch)
            # The second one: a terminal that is gone.
            for interrupt in (signal.SIGINT, signal.SIGHUP):
                interrupt_gives_the_mode_back(contour, daemon, scratch, interrupt)
            killed_gives_the_mode_back(contour, daemon, scratch)
        finally:
            status = daemon.end()
        assert status == 0, (status, Path(daemon.messages).read_text(encoding="utf-8"))
        daemon = TorqueMode(contourd, machine_file, scratch, ["emulator.axes.x.csp_mode=false"])
        try:
            done = subprocess.run(commission(contour, daemon, scratch, "--mode", "csp"), capture_output=True, text=True)
            assert done.returncode == 1 and "0x6502" in done.stderr, (done.returncode, done.stdout, done.stderr)
            assert daemon.is_as_before()
        finally:
            daemon.end()
    return 0


FACTORS = {"motor_inertia_kgm2": 0.9236, "table_mass_kg": 0.9062, "screw_stiffness_N_um": 1.462, "screw_damping_Ns_m": 0.67}
FRICTION = {"vs_mm_s": 0.535, "sigma0_N_m": 1.648, "sigma1_Ns_m": 0.8105, "sigma1_decay_mm_s": 0.535, "sigma2_Ns_m": 0.7193}
LEVEL = 0.6217


def stated_as_in_a_catalogue(machine_file, scratch):
    """One axis of it, off by what FACTORS say."""
    machine = yaml.safe_load(Path(machine_file).read_text(encoding="utf-8"))
    for axes in (machine["axes"], machine["emulator"]["axes"]):
        del axes["y"]
    axis, is_ = machine["axes"]["x"], machine["emulator"]["axes"]["x"]
    model, friction = axis["model"], axis["model"]["friction"]
    for key, factor in FACTORS.items():
        model[key] = factor * float(is_[key])
    for key, factor in FRICTION.items():
        friction[key] = factor * float(is_["friction"][key])
    level = LEVEL * (float(is_["friction"]["Fc_plus_N"]) + float(is_["friction"]["Fc_minus_N"])) / 2
    friction.update(Fc_plus_N=level, Fc_minus_N=level, Fs_plus_N=1.25 * level, Fs_minus_N=1.25 * level)
    model["uncertainty"] = {key: 0.3 / math.sqrt(3) for key in ("motor_inertia_kgm2", "table_mass_kg")}
    model["uncertainty"].update({key: math.log(2) / math.sqrt(3) for key in (
        "screw_stiffness_N_um", "Fc_plus_N", "Fc_minus_N", "sigma0_N_m", "sigma2_Ns_m")})
    machine["realtime"]["required"] = False
    out = Path(scratch) / "machine.yaml"
    out.write_text(yaml.safe_dump(machine), encoding="utf-8")
    return out, {key: float(is_[key]) for key in FACTORS if key != "screw_damping_Ns_m"}


def first(contourd, contour, machine_file):
    with tempfile.TemporaryDirectory() as scratch:
        stated, truth = stated_as_in_a_catalogue(machine_file, scratch)
        daemon = TorqueMode(contourd, stated, scratch, ["emulator.parameter_variation_rel=0"])
        try:
            text, model = commission_once(daemon, scratch, contour)
        finally:
            status = daemon.end()
        assert status == 0, (status, Path(daemon.messages).read_text(encoding="utf-8"))
        assert "no loop of axis x is stable for all that its model leaves open" in text, text
        assert "axis x, in csp first" in text and "back to the machine file's loops" in text, text
        assert "recorded in csp, where" not in text, text
        for key, is_ in truth.items():
            assert abs(float(model[key]) / is_ - 1) < 0.02, f"{key}: found {model[key]}, is {is_}"
        assert Path(f"{scratch}/loop.yaml").exists(), "a torque-mode machine with its loop"
    return 0


if __name__ == "__main__":
    sys.exit((first if sys.argv[4:] == ["--first"] else quick)(*sys.argv[1:4]))
