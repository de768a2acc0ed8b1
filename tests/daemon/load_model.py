#!/usr/bin/env python3
"""Another model of an axis is handed to a running contourd: it begins anew with it, Idle, and gives it back again.

    load_model.py CONTOURD MACHINE_FILE

In lock-step on the in-process bus. The process stays the same, its log goes on in a file of its own, what cannot be loaded is
refused before anything ends, and nothing is loaded while there is torque.
"""
import sys
import tempfile
from pathlib import Path

import yaml

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from control_socket import ControlSocket  # noqa: E402
from lockstep_daemon import lockstep_daemon  # noqa: E402


class Client(ControlSocket):
    def model(self):
        return self.axis()["model"]

    def load(self, model):
        return self.ask(request="load_model", axis="x", model=model)

    def warnings(self):
        return self.ask(request="status")["status"]["warnings"]

    def await_stiffness(self, value):
        self.await_axis(lambda axis: axis["model"]["screw_stiffness_N_um"] == value)


def check(client, process, log):
    client.wait_for("Idle")
    own = client.model()["screw_stiffness_N_um"]
    model = client.model()
    refused = client.load("lead_mm: 5\n")
    assert not refused["ok"] and "motor_inertia_kgm2: missing" in refused["error"], refused
    refused = client.ask(request="load_model", axis="q", model="")
    assert not refused["ok"] and "no axis q" in refused["error"], refused
    model["screw_stiffness_N_um"] = 33
    assert client.ask(request="enable")["ok"]
    client.wait_for("Ready")
    refused = client.load(yaml.safe_dump(model))
    assert not refused["ok"] and "Idle" in refused["error"], refused
    assert client.ask(request="disable")["ok"]
    client.wait_for("Idle")
    assert client.load(yaml.safe_dump(model))["ok"]
    client.await_stiffness(33)
    client.wait_for("Idle")
    assert any("axis x runs with a model" in w for w in client.warnings()), client.warnings()
    assert client.load("")["ok"]
    client.await_stiffness(own)
    client.wait_for("Idle")
    assert not any("axis x runs with a model" in w for w in client.warnings()), client.warnings()
    assert process.poll() is None
    for number in ("", ".1", ".2"):
        assert Path(f"{log}{number}").stat().st_size > 1000, number


def main():
    contourd, machine_file = sys.argv[1:]
    with tempfile.TemporaryDirectory() as scratch:
        log = f"{scratch}/run.log"
        with lockstep_daemon(contourd, machine_file, scratch, "--log", log) as process:
            check(Client(f"{scratch}/control.sock"), process, log)
    return 0


if __name__ == "__main__":
    sys.exit(main())
