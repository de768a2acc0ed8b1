"""A machine on a test bench: the emulated drives, the daemon and a recording of the bus, each a process of its own."""
import csv
import os
import re
import shutil
import socket
import struct
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "support"))
import canopen_trace  # noqa: E402
from control_socket import ControlSocket  # noqa: E402


class BenchError(Exception):
    """The machine did not do what the test needs; the message says what it did instead."""


def _numbers(row):
    """A row with its numbers as numbers."""
    def number(text):
        try:
            return float(text)
        except ValueError:
            return text

    return {key: number(value) for key, value in row.items()}


def write_modbus_coil(port, coil, value):
    """Writes one coil of the Modbus TCP server on this host (function 5)."""
    request = struct.pack(">HHHBBHH", 1, 0, 6, 1, 5, coil, 0xFF00 if value else 0)
    with socket.create_connection(("127.0.0.1", port), timeout=5) as connection:
        connection.sendall(request)
        reply = connection.recv(64)
    if reply[7:8] != b"\x05":
        raise BenchError(f"Modbus server refused coil {coil}: {reply.hex()}")


class MachineBench:
    """Use as a context: whatever was started is ended, and its logs lie in `out`, whichever way the test ends."""

    def __init__(self, programs, config, out, clock="lockstep", bus="vcan0"):
        self.programs = Path(programs)
        self.config = Path(config)
        self.out = Path(out)
        self.clock = clock
        self.bus = bus
        # On a busy host a process may be held up for long, which neither the emulated drives nor the I/O client is to
        # take for the other's death: time-outs by the clock do not belong to lock-step.
        self.patience_ms = 4000
        # The emulated drives know when it was they who did not listen; the I/O client goes by the clock: the most that it takes.
        self.io_patience_ms = 5000
        self.work = Path("/tmp/bench")
        self.socket = self.work / "contourd.sock"
        self.processes = {}
        self._log_number = 0

    def __enter__(self):
        shutil.rmtree(self.work, ignore_errors=True)
        self.work.mkdir(parents=True)
        return self

    def __exit__(self, kind, error, _traceback):
        if error is not None:
            self._explain(error)
        for process in self.processes.values():
            if process.poll() is None:
                process.kill()
                process.wait()
        for path in self.work.iterdir():
            if path.is_file():
                shutil.copy(path, self.out)

    def _explain(self, error):
        print(f"-- {type(error).__name__}: {error}", flush=True)
        for path in sorted(self.work.glob("*.log")):
            if path.name == "candump.log":
                continue
            lines = path.read_text(errors="replace").splitlines()
            print(f"-- last lines of {path.name}:", *lines[-25:], sep="\n", flush=True)

    # Processes -------------------------------------------------------------------------------------------------

    def start(self, name, *command):
        """Starts a process under a name; its output goes to NAME.log."""
        log = open(self.work / f"{name}.log", "ab")
        self.processes[name] = subprocess.Popen([str(word) for word in command], stdin=subprocess.DEVNULL, stdout=log,
                                                stderr=subprocess.STDOUT)
        return self.processes[name]

    def start_recording(self):
        self.start("candump", "candump", "-D", "-r", "16777216", "-L", self.bus)
        # Without a listener the list says "(vcan0: no entry)".
        self.wait_for("candump to listen", lambda: re.search(rf"^ *{self.bus} ", Path("/proc/net/can/rcvlist_all").read_text(),
                                                             re.MULTILINE))
        # Its output is the recording, not a message.

    def start_emulator(self):
        self.start("emulator", self.programs / "contour", "emulate", "--config", self.config, "--bus", self.bus, "--clock",
                   "sync" if self.clock == "lockstep" else "wall", "--truth", self.truth_path,
                   "--set", f"emulator.silence_ms={self.patience_ms}")
        self.wait_for("the emulator's Modbus server", lambda: self._listens(self.modbus_port))

    def start_daemon(self, *arguments):
        self._log_number += 1
        return self.start("contourd", self.programs / "contourd", "--config", self.config, "--bus", self.bus, "--clock",
                          self.clock, "--socket", self.socket, "--log", self.work / f"cycles{self._log_number}.lcm",
                          "--set", f"io.modbus.timeout_ms={self.io_patience_ms}",
                          "--set", "io.modbus.accept_blind_travel=true", *arguments)

    def wait_for_end(self, name, seconds=20):
        """Exit status of a process that should end by itself."""
        try:
            return self.processes[name].wait(seconds)
        except subprocess.TimeoutExpired:
            raise BenchError(f"{name} did not end within {seconds} s") from None

    # What the machine says -------------------------------------------------------------------------------------

    @property
    def truth_path(self):
        return self.work / "truth.csv"

    @property
    def modbus_port(self):
        return 1502

    @staticmethod
    def _listens(port):
        try:
            socket.create_connection(("127.0.0.1", port), timeout=1).close()
        except OSError:
            return False
        return True

    def contour(self, *arguments, check=True):
        """Runs a subcommand of contour; its output as text."""
        command = [str(self.programs / "contour"), *[str(a) for a in arguments]]
        result = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False, timeout=120)
        with open(self.work / "contour.log", "a", encoding="utf-8") as log:
            print("$", *command, f"-> {result.returncode}", file=log)
            print(result.stderr if arguments[0] == "status" else result.stdout + result.stderr, file=log)
        if check and result.returncode != 0:
            raise BenchError(f"contour {' '.join(map(str, arguments))} ended with {result.returncode}: "
                             f"{(result.stderr or result.stdout).strip()}")
        return result.stdout

    def ask(self, *arguments):
        """A request to the running daemon."""
        return self.contour(*arguments, "--socket", self.socket)

    def status(self):
        """As `contour status --json` prints it. Not by that: to start a program takes this guest a third of a second of a processor,
        and this is asked again and again."""
        try:
            return ControlSocket(self.socket).ask(request="status")["status"]
        except (OSError, ValueError) as error:
            raise BenchError(f"contourd does not say its status: {error}") from None

    def wait_for_log(self, sentence):
        """The daemon's log for people may be a moment behind its status."""
        log = self.work / "contourd.log"
        self.wait_for(f"the log to say {sentence!r}", lambda: sentence in log.read_text(errors="replace"))

    def try_ask(self, *arguments):
        """A request that may be refused; whether it was accepted."""
        try:
            self.ask(*arguments)
        except BenchError:
            return False
        return True

    def stop_bound_s(self, way):
        """The longest time to rest of a way to stop, over all axes, as `contour check` prints it."""
        for line in self.contour("check", self.config).splitlines():
            name, *columns = re.split(r"\s{2,}", line.strip())
            if name == way and columns:
                return max(float(column.removesuffix(" ms")) for column in columns if column.endswith(" ms")) / 1e3
        raise BenchError(f"contour check prints no bound for {way!r}")

    def truth(self):
        """Rows of the emulator's truth log, values as numbers where they are."""
        with open(self.truth_path, encoding="utf-8", newline="") as file:
            rows = csv.DictReader(line for line in file if line.endswith("\n"))
            return [_numbers(row) for row in rows]

    def last_truth(self):
        """The newest whole row."""
        with open(self.truth_path, "rb") as file:
            header = file.readline().decode().strip().split(",")
            file.seek(0, os.SEEK_END)
            file.seek(max(len(header), file.tell() - 8192))
            lines = file.read().decode().split("\n")
        if len(lines) < 3:
            raise BenchError("the truth log has no rows")
        return _numbers(dict(zip(header, lines[-2].split(","))))

    def trace(self, sync_number=0):
        """What was on the bus so far, at least up to that SYNC: the recording may be a moment behind the machine."""
        def recorded():
            frames = canopen_trace.read(self.work / "candump.log")
            return frames if sum(1 for frame in frames if frame.id == canopen_trace.SYNC) >= sync_number else None

        return self.wait_for(f"SYNC {sync_number} on the bus", recorded)

    # Waiting ---------------------------------------------------------------------------------------------------

    @staticmethod
    def wait_for(what, condition, seconds=120, pause_s=0.02):
        """The first true value of condition(). The time is a safety net on a busy host, not a demand."""
        end = time.monotonic() + seconds
        while True:
            value = condition()
            if value:
                return value
            if time.monotonic() > end:
                raise BenchError(f"waited {seconds} s in vain for {what}")
            time.sleep(pause_s)

    def wait_for_state(self, *states, seconds=120):
        last = {}

        def reached():
            if self.processes["contourd"].poll() is not None:
                raise BenchError(f"contourd ended with {self.processes['contourd'].returncode} on the way to {states}")
            try:
                last.update(self.status())
            except BenchError:
                return None  # not listening yet
            return last if last["state"] in states else None

        try:
            return self.wait_for(f"state {' or '.join(states)}", reached, seconds, pause_s=0.1)
        except BenchError as error:
            said = {key: last.get(key) for key in ("state", "reason", "reason_text", "bring_up")}
            raise BenchError(f"{error}; the last status was {said}") from None

    def enable(self):
        self.ask("enable")
        return self.wait_for_state("Ready")


def main(test):
    """Runs test(programs, out); a failure is one message, no stack of the test's own code."""
    programs, out = Path(sys.argv[1]), Path(os.environ["OUT"])
    try:
        test(programs, out)
    except (BenchError, AssertionError) as error:
        print(f"FAILED: {error}")
        sys.exit(1)


def expect(condition, message):
    if not condition:
        raise AssertionError(message)
