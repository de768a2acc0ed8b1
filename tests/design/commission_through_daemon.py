#!/usr/bin/env python3
"""Commissions an axis of a running contourd (emulated machine, lock-step), as an operator would.

    commission_through_daemon.py CONTOURD CONTOUR MACHINE_FILE

The machine file is contradicted by half; the model that comes out must be near what the emulated axis is, the drives
must be off afterwards, and nothing may move without --yes.
"""
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import yaml

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from free_port import free_port  # noqa: E402


def main():
    contourd, contour, machine_file = sys.argv[1:]
    emulated = yaml.safe_load(Path(machine_file).read_text(encoding="utf-8"))["emulator"]["axes"]["x"]
    # YAML 1.1 takes 5e6 for text.
    friction = {k: float(v) for k, v in emulated["friction"].items() if k != "law"}
    emulated = {k: float(v) for k, v in emulated.items() if not isinstance(v, dict)}
    wrong = {"Fs_plus_N": 1.5, "Fc_plus_N": 1.5, "Fs_minus_N": 0.5, "Fc_minus_N": 0.5, "vs_mm_s": 1.5,
             "sigma0_N_m": 0.5, "sigma1_Ns_m": 1.5, "sigma2_Ns_m": 0.5}
    overrides = [f"axes.x.model.friction.{k}={friction[k] * f}" for k, f in wrong.items()]
    overrides += [f"axes.x.model.{k}={emulated[k] * 1.3}" for k in ("motor_inertia_kgm2", "table_mass_kg")]
    # No variation from the seed, and one level over the stroke: the file then says what the axis is.
    overrides += ["emulator.parameter_variation_rel=0", "emulator.axes.x.friction.position_amplitude_rel=0",
                  "telemetry.publish=false",
                  # With that much inertia the file's quick stop would be beyond the torque limit, which is refused.
                  "axes.x.drive.quick_stop_deceleration_rad_s2=15000", "axes.x.limits.safe_travel_mm=5"]
    port = free_port()  # other tests may run beside this one
    overrides += [f"emulator.io.port={port}"]
    with tempfile.TemporaryDirectory() as scratch:
        socket = f"{scratch}/control.sock"
        command = [contourd, "--config", machine_file, "--clock", "lockstep", "--controller", "mpc_observer", "--socket", socket]
        for override in overrides:
            command += ["--set", override]
        with open(f"{scratch}/daemon.txt", "w", encoding="utf-8") as messages:
            daemon = subprocess.Popen(command, stdout=messages, stderr=messages)
        try:
            ask = [contour, "status", "--json", "--socket", socket]

            def status():
                answer = subprocess.run(ask, capture_output=True, text=True)
                return json.loads(answer.stdout) if answer.returncode == 0 else {"state": "no answer"}

            for _ in range(300):
                if status()["state"] == "Idle":
                    break
                time.sleep(0.1)
            assert status()["state"] == "Idle", Path(f"{scratch}/daemon.txt").read_text(encoding="utf-8")

            commission = [contour, "commission", "--axis", "x", "--socket", socket, "--out", f"{scratch}/model.yaml",
                          "--report", f"{scratch}/report", "--loop", f"{scratch}/loop.yaml"]
            refused = subprocess.run(commission, stdin=subprocess.DEVNULL, capture_output=True, text=True)
            assert refused.returncode == 2 and "--yes" in refused.stderr, refused
            assert status()["state"] == "Idle"
            refused = subprocess.run([*commission, "--yes", "--travel_mm", "1000"], capture_output=True, text=True)
            assert refused.returncode == 2 and "--travel_mm: found 1000" in refused.stderr, refused

            # In lock-step the machine goes as fast as it can: a busy host may lose rows, which is refused.
            for _ in range(5):
                done = subprocess.run([*commission, "--yes"], capture_output=True, text=True)
                print(done.stdout)
                if "cycles are missing" not in done.stderr:
                    break
            assert done.returncode == 0, (done.returncode, done.stderr, done.stdout)
            for _ in range(100):
                if status()["state"] == "Idle":
                    break
                time.sleep(0.1)
            after = status()
            assert after["state"] == "Idle", after["state"]
            model = yaml.safe_load(Path(f"{scratch}/model.yaml").read_text(encoding="utf-8"))
            allowed = {"Fs_plus_N": 0.05, "Fc_plus_N": 0.05, "Fs_minus_N": 0.05, "Fc_minus_N": 0.05, "vs_mm_s": 0.15,
                       "sigma0_N_m": 0.1, "sigma1_Ns_m": 0.3, "sigma2_Ns_m": 0.05}
            for key, share in allowed.items():
                is_, found = friction[key], float(model["friction"][key])
                assert abs(found / is_ - 1) < share, f"{key}: found {found}, is {is_}"
            for key, share in (("motor_inertia_kgm2", 0.05), ("table_mass_kg", 0.03), ("screw_stiffness_N_um", 0.03)):
                found = float(model[key])
                assert abs(found / emulated[key] - 1) < share, f"{key}: found {found}, is {emulated[key]}"
            for name in ("identification.json", "report.html", "stribeck.png", "presliding.png", "overlay.png"):
                assert Path(f"{scratch}/report/{name}").stat().st_size > 1000, name
        finally:
            daemon.terminate()
            daemon.wait(timeout=30)
    return 0


if __name__ == "__main__":
    sys.exit(main())
