#!/usr/bin/env python3
"""A client that is killed, or whose terminal is gone, while the machine moves for it.

    client_dies.py CONTOURD CONTOUR MACHINE_FILE

In lock-step on the in-process bus. What `contour commission` and `contour improve` move is not left running: the torque goes off,
after a stop on the path. A program is the daemon's, and runs on when its `contour run` is killed; a terminal that is gone stops it.
"""
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from control_socket import ControlSocket  # noqa: E402
from lockstep_daemon import lockstep_daemon  # noqa: E402

LONG_CIRCLE = "shape: circle\nradius_mm: 1\nfrequency_hz: 1\nturns: 100000\n"


class Machine(ControlSocket):
    def __init__(self, contour, path):
        super().__init__(path)
        self.contour = contour

    def status(self):
        return self.ask(request="status")["status"]

    def signalled(self, signal_number, *command):
        """Exit status of the command that gets the signal while it has the machine moving."""
        with subprocess.Popen([self.contour, *command, "--socket", self.path], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              text=True) as running:
            self.wait_for("Running")
            running.send_signal(signal_number)
            text = running.communicate()
            print(command[0], signal_number, running.returncode, *text)
            return running.returncode

    def await_own_mode(self):
        """Idle as it began: contourd says so when it has gone back."""
        self._until(self._is_as_it_began, "never Idle in its own mode")

    def _is_as_it_began(self):
        status = self.status()
        return status["state"] == "Idle" and not any("for commissioning" in warning for warning in status["warnings"])

    def ended_for(self, state, reason):
        self.wait_for(state)
        status = self.status()
        assert status["reason"] == reason, (status["reason"], status["reason_text"])


def check(machine, scratch):
    machine.wait_for("Idle")
    circle = Path(f"{scratch}/circle.yaml")
    circle.write_text(LONG_CIRCLE, encoding="utf-8")
    # A killed commission, and one whose terminal is gone, also end in commission_in_csp.
    for command, number, status in (("commission", signal.SIGKILL, -signal.SIGKILL), ("improve", signal.SIGHUP, 1)):
        options = ("--axis", "x", "--yes", "--out", f"{scratch}/model.yaml", "--report", f"{scratch}/report",
                   "--loop", f"{scratch}/loop.yaml")
        assert machine.signalled(number, command, *options) == status
        machine.await_own_mode()
    assert not Path(f"{scratch}/model.yaml").exists()

    assert machine.ask(request="enable")["ok"]
    machine.wait_for("Ready")
    assert machine.signalled(signal.SIGKILL, "run", str(circle)) == -signal.SIGKILL
    assert machine.status()["state"] == "Running", "it is the daemon's"
    assert machine.ask(request="stop")["ok"]
    machine.ended_for("Ready", "operator_stop")
    assert machine.signalled(signal.SIGHUP, "run", str(circle)) == 1
    machine.ended_for("Ready", "operator_stop")
    assert machine.ask(request="disable")["ok"]
    machine.wait_for("Idle")


def main():
    contourd, contour, machine_file = sys.argv[1:]
    with tempfile.TemporaryDirectory() as scratch, lockstep_daemon(contourd, machine_file, scratch):
        check(Machine(contour, f"{scratch}/control.sock"), scratch)
    return 0


if __name__ == "__main__":
    sys.exit(main())
