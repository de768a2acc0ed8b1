#!/usr/bin/env python3
"""No loop that is unstable on what the axis may be moves it: contourd refuses it at its start, in a reload, and with a model.

    unstable_loop.py CONTOURD MACHINE_FILE

In lock-step on the in-process bus. What breaks a limit and is stable is warned of.
"""
import subprocess
import sys
import tempfile
from pathlib import Path

import yaml

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from control_socket import ControlSocket  # noqa: E402
from free_port import free_port  # noqa: E402

REGULATOR = "axes.x.loop.regulator_Hz"
REFUSED = "axes.x.loop: found a loop that does not keep its limits ("


def command_of(contourd, machine_file, scratch, *overrides):
    port = free_port()
    command = [contourd, "--config", str(machine_file), "--clock", "lockstep", "--socket", f"{scratch}/control.sock"]
    for override in ("telemetry.publish=false", f"emulator.io.port={port}", *overrides):
        command += ["--set", override]
    return command


def refuses_a_start(contourd, machine_file, scratch):
    run = subprocess.run(command_of(contourd, machine_file, scratch, f"{REGULATOR}=150"), capture_output=True,
                         text=True, timeout=60, check=False)
    assert run.returncode == 2, run
    assert REFUSED + "unstable: " in run.stderr and Path(machine_file).name + ":" in run.stderr, run.stderr


def warns_of_a_limit(client):
    assert any(REFUSED + "peak " in w for w in client.ask(request="status")["status"]["warnings"])


def refuses_a_model_and_takes_another(client):
    model = client.axis()["model"]
    soft = {**model, "screw_stiffness_N_um": 1}
    refused = client.ask(request="load_model", axis="x", model=yaml.safe_dump(soft))
    assert not refused["ok"] and REFUSED + "unstable: " in refused["error"], refused
    assert client.ask(request="status")["status"]["state"] == "Idle"
    less_soft = {**model, "screw_stiffness_N_um": 3}
    assert client.ask(request="load_model", axis="x", model=yaml.safe_dump(less_soft))["ok"]
    client.await_axis(lambda axis: axis["model"]["screw_stiffness_N_um"] == 3)
    assert any(REFUSED + "peak " in w for w in client.ask(request="status")["status"]["warnings"])


def refuses_a_reload(client, machine_file):
    """A loop that nothing went by until the file says otherwise."""
    text = machine_file.read_text(encoding="utf-8")
    machine_file.write_text(text.replace("friction: srukf", "friction: linear"), encoding="utf-8")
    refused = client.ask(request="reload")
    assert not refused["ok"] and REFUSED + "unstable: " in refused["error"], refused


def with_daemon(command, socket, check):
    process = subprocess.Popen(command)
    try:
        client = ControlSocket(socket)
        client.wait_for("Idle")
        check(client)
        assert process.poll() is None
    finally:
        process.terminate()
        status = process.wait(timeout=60)
    assert status == 0, status


def main():
    contourd, machine_file = sys.argv[1:]
    with tempfile.TemporaryDirectory() as scratch:
        socket = f"{scratch}/control.sock"
        refuses_a_start(contourd, machine_file, scratch)
        with_daemon(command_of(contourd, machine_file, scratch, f"{REGULATOR}=40"), socket, warns_of_a_limit)
        with_daemon(command_of(contourd, machine_file, scratch), socket, refuses_a_model_and_takes_another)
        unused = Path(scratch) / "unused.yaml"
        unused.write_text(Path(machine_file).read_text(encoding="utf-8") + "\ncontrol: {friction: srukf}\n", encoding="utf-8")
        with_daemon(command_of(contourd, unused, scratch, f"{REGULATOR}=150"), socket,
                    lambda client: refuses_a_reload(client, unused))
    return 0


if __name__ == "__main__":
    sys.exit(main())
