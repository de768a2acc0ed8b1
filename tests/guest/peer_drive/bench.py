"""A bench with python drives in place of the emulated ones: contourd in lock-step with an independent machine, and that machine's truth."""
import csv
import functools
import json
import os
import select
import socket
import subprocess
import sys
from pathlib import Path

import yaml

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from machine_bench import BenchError, MachineBench  # noqa: E402

HERE = Path(__file__).resolve().parent
# As the daemon's own: neither interrupts the other. Below it, on the guest's one processor a daemon whose cycles take longer than their
# period, as on a busy host, would not let the drives speak; above it, they would wake up for each frame.
PEER_PRIORITY = 80
TORQUE_ON_STATES = (0x27, 0x07, 0x0F)  # Operation Enabled, Quick Stop Active, Fault Reaction Active


class Axis:
    """One row of the truth, one axis."""

    def __init__(self, row, name):
        self.motor_m = float(row[f"{name}_motor_m"])
        self.table_m = float(row[f"{name}_table_m"])
        self.velocity_m_s = float(row[f"{name}_table_velocity_m_s"])
        self.torque_Nm = float(row[f"{name}_torque_Nm"])
        self.statusword = int(row[f"{name}_statusword"], 16)
        self.nmt = int(row[f"{name}_nmt"])

    @property
    def torque_is_on(self):
        mask = 0x4F if self.statusword & 0x4F in (0x00, 0x40, 0x0F, 0x08) else 0x6F
        return self.statusword & mask in TORQUE_ON_STATES


@functools.cache
def describe_keys(contour):
    return subprocess.run([str(contour), "check", "--describe"], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          check=True).stdout


class PeerBench(MachineBench):
    def __init__(self, programs, out, config=HERE / "machine.yaml", machine=(), settings=(), mode="cst"):
        super().__init__(programs, config, out)
        modes = [f"axes.{name}.drive.mode={mode}" for name in ("x", "y")]
        # LCM has no listener here, and costs the guest more than the cycle does.
        self.settings = ["telemetry.publish=false", *modes, *settings]
        # y's encoder is incremental: how far it may go before anybody told it where it is. A build of old does not ask.
        if "unreferenced_travel_mm" in self.describe_keys():
            self.settings.append("axes.y.limits.unreferenced_travel_mm=150")
        self.machine_settings = list(machine)
        self.peer_control = self.work / "peer.sock"
        self.python = sys.executable

    def describe_keys(self):
        return describe_keys(self.programs / "contour")

    def start_emulator(self):
        """The python machine."""
        self.peer_control.unlink(missing_ok=True)
        more = [word for setting in self.machine_settings for word in ("--set", setting)]
        self.start("peer", self.python, HERE / "machine.py", "--bus", self.bus, "--config", HERE / "peer.yaml", "--truth",
                   self.truth_path, "--control", self.peer_control, "--priority", PEER_PRIORITY, *more)
        self.wait_for("the python machine", self.peer_control.exists)

    def start_daemon(self, *arguments, name="contourd", sock=None):
        self._log_number += 1
        os.environ["XDG_STATE_HOME"] = str(self.work / "state")
        more = [word for setting in self.settings for word in ("--set", setting)]
        return self.start(name, self.programs / "contourd", "--config", self.config, "--bus", self.bus, "--clock", self.clock,
                          "--socket", sock or self.socket, "--log", self.work / f"cycles{self._log_number}.lcm", *more, *arguments)

    def stop_all(self):
        for name in ("contourd", "peer"):
            process = self.processes.pop(name, None)
            if process is not None and process.poll() is None:
                process.kill()
                process.wait()

    # The machine ------------------------------------------------------------------------------------------------

    def peer(self, *words):
        """A line to the python machine, its answer."""
        line = " ".join(str(word) for word in words)
        ours = self.work / f"asker.{os.getpid()}"
        ours.unlink(missing_ok=True)
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as asker:
            asker.bind(str(ours))
            asker.sendto(line.encode(), str(self.peer_control))
            ready, _, _ = select.select([asker], [], [], 60)
            if not ready:
                raise BenchError(f"the python machine did not answer {line!r}")
            answer = json.loads(asker.recv(1 << 16))
        ours.unlink(missing_ok=True)
        if "error" in answer:
            raise BenchError(f"the python machine refused {line!r}: {answer['error']}")
        return answer

    def truth(self, from_sync=0):
        """{SYNC: {axis: Axis}}; while time runs by the clock, the rows count on."""
        self.peer("status")
        rows = []
        with open(self.truth_path, encoding="utf-8", newline="") as file:
            for row in csv.DictReader(line for line in file if line.endswith("\n")):
                if int(row["sync_number"]) >= from_sync:
                    rows.append({"sync": int(row["sync_number"]), "x": Axis(row, "x"), "y": Axis(row, "y")})
        return rows

    # Programs ---------------------------------------------------------------------------------------------------

    def write_program(self, name, program):
        path = self.work / f"{name}.yaml"
        path.write_text(yaml.safe_dump(program), encoding="utf-8")
        return path

    def begin(self, program):
        """Runs a program in the background."""
        self.start("run", self.programs / "contour", "run", program, "--socket", self.socket)

    def bring_up(self):
        self.start_emulator()
        self.start_daemon()
        self.wait_for_state("Idle")

    def enable(self):
        self.ask("enable")
        status = self.wait_for_state("Ready", "Faulted")
        if status["state"] != "Ready":
            raise BenchError(f"Faulted after enable: {status['reason']}: {status['reason_text']}")
        return status

    def start_outcome(self):
        """How a start came out: the state, or "ended" where the daemon gave up; and all that it said."""
        log = self.work / "contourd.log"

        def known():
            if self.processes["contourd"].poll() is not None:
                return "ended", log.read_text(errors="replace")
            try:
                status = self.status()
            except BenchError:
                return None
            if status["state"] not in ("Idle", "Faulted"):
                return None
            return status["state"], json.dumps(status) + log.read_text(errors="replace")

        return self.wait_for("the start to come out", known, pause_s=0.2)

    @staticmethod
    def last_words(text):
        return next((line for line in reversed(text.splitlines()) if " error " in line), text.splitlines()[-1] if text else "")
