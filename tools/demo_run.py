#!/usr/bin/env python3
"""Shows contourd at work: the daemon, in real time on its in-process bus, draws the circle of 100 um at both
readings of "pi/4", first with MPC only and then compensated. Then every rival draws it in virtual time, and
table and pictures say what came of it.

    demo_run.py [--out DIR] [--build DIR]

Exit status: 0 done, 1 a run failed, 3 something is missing.
"""
import argparse
import concurrent.futures
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools" / "plots"))
from compare_runs import table_text  # noqa: E402  the path comes first

CONFIG = ROOT / "config" / "xy_emulated.yaml"
# Rivals without compensation hold the axes more softly: a frozen encoder shows later, and takes more room.
ROOM = [f"axes.{axis}.limits.safe_travel_mm=6" for axis in "xy"]
# The paper's circle, amplitude 1e-4 m: sin(pi t / 4), and pi/4 Hz. The first turn is not scored.
PROGRAMS = {
    "circle_100um_slow": "shape: circle\nradius_mm: 0.1\nfrequency_hz: 0.125\nturns: 2\n",
    "circle_100um_fast": "shape: circle\nradius_mm: 0.1\nfrequency_hz: 0.7853981634\nturns: 4\n",
}
REAL_TIME = ("mpc", "full")
RIVALS = ("pid", "csp", "mpc", "mpc_observer", "mpc_srukf4", "mpc_ekf7", "mpc_srukf7", "full")
START_TIMEOUT_S = 20.0
END_TIMEOUT_S = 10.0
ATTEMPTS = 4
# Reasons of stops where the computer was too busy: for the cycle, or for the I/O station, which is emulated beside it.
HELD_UP = ("grid_points_skipped", "io_stale")


class DemoError(Exception):
    def __init__(self, message, status=1):
        super().__init__(message)
        self.status = status


class HeldUp(DemoError):
    """The computer took the CPU away in motion: no fault of the program, ordinary on a shared machine."""


def say(text):
    print(text, flush=True)


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Daemon:
    """contourd on its in-process bus, for as long as the `with` block lasts."""

    def __init__(self, binaries, controller, out):
        self._binaries = binaries
        self.truth = out / f"truth_{controller}.csv"
        self._messages = out / f"contourd_{controller}.txt"
        # Paths of sockets have to be short, whatever the folder of the results is called.
        self._folder = tempfile.mkdtemp(prefix="contour_demo_")
        self.socket = str(Path(self._folder) / "control")
        port = free_port()
        settings = ["realtime.required=false", f"io.modbus.port={port}", f"emulator.io.port={port}", *ROOM]
        if (os.cpu_count() or 1) < 2:
            settings.append("realtime.cpu=0")
        self._command = [str(binaries / "contourd"), "--config", str(CONFIG), "--controller", controller,
                         "--socket", self.socket, "--truth", str(self.truth),
                         "--log", str(out / f"cycles_{controller}.lcm")]
        for setting in settings:
            self._command += ["--set", setting]

    def __enter__(self):
        with open(self._messages, "w", encoding="utf-8") as messages:
            self._process = subprocess.Popen(self._command, stdout=messages, stderr=subprocess.STDOUT,
                                             cwd=self._folder)
        try:
            self._await_idle()
        except BaseException:
            self.__exit__()
            raise
        for line in self._messages.read_text(encoding="utf-8").splitlines():
            if "warning" in line:
                say(f"     {line}")
        return self

    def __exit__(self, *_):
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGTERM)
            try:
                self._process.wait(END_TIMEOUT_S)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
        shutil.rmtree(self._folder, ignore_errors=True)

    def _await_idle(self):
        deadline = time.monotonic() + START_TIMEOUT_S
        state = "silent"
        while time.monotonic() < deadline:
            if self._process.poll() is not None:
                text = self._messages.read_text(encoding="utf-8").strip()
                raise DemoError(f"contourd ended with status {self._process.returncode}:\n{text}",
                                3 if self._process.returncode == 3 else 1)
            answer = subprocess.run([self._binaries / "contour", "status", "--json", "--socket", self.socket],
                                    capture_output=True, text=True, check=False)
            if answer.returncode == 0:
                state = json.loads(answer.stdout)["state"]
                if state == "Idle":
                    return
            time.sleep(0.1)
        raise DemoError(f"contourd is still {state} after {START_TIMEOUT_S:.0f} s; see {self._messages}")

    def contour(self, *arguments):
        # The companion shows its progress on a terminal by itself.
        result = subprocess.run([self._binaries / "contour", *arguments, "--socket", self.socket],
                                stdout=subprocess.PIPE, text=True, check=False)
        if result.returncode != 0:
            said = self._messages.read_text(encoding="utf-8")
            held_up = any(reason in said for reason in HELD_UP)
            raise (HeldUp if held_up else DemoError)(
                f"contour {arguments[0]} failed; what contourd says is in {self._messages}")


def write_programs(out):
    files = [out / f"{name}.yaml" for name in PROGRAMS]
    for file, text in zip(files, PROGRAMS.values()):
        file.write_text(text, encoding="utf-8")
    return files


def draw_with(binaries, controller, programs, out):
    with Daemon(binaries, controller, out) as daemon:
        daemon.contour("enable")
        directories = []
        for program in programs:
            directory = out / f"{program.stem}_{controller}"
            say(f"  {controller:5s} draws {program.stem}")
            daemon.contour("run", str(program), "--out", str(directory), "--truth", str(daemon.truth))
            directories.append(directory)
        return directories


def run_in_real_time(binaries, programs, out):
    directories = []
    for controller in REAL_TIME:
        for left in reversed(range(ATTEMPTS)):
            try:
                directories += draw_with(binaries, controller, programs, out)
                break
            except HeldUp:
                if not left:
                    raise
                say("  the host was too busy; contourd stopped the axes, as it should. Once more")
    return directories


def simulate(binaries, out, controller, program):
    directory = out / "virtual" / f"{program.stem}_{controller}"
    result = subprocess.run([binaries / "contour", "simulate", "--config", CONFIG, "--program", program,
                             "--controller", controller, "--out", directory,
                             *[word for setting in ROOM for word in ("--set", setting)]],
                            capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise DemoError(f"contour simulate with {controller} failed: {result.stderr.strip()}")
    return directory


def simulate_rivals(binaries, programs, out):
    wanted = [(controller, program) for program in programs for controller in RIVALS]
    directories = []
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for directory in pool.map(lambda job: simulate(binaries, out, *job), wanted):
            directories.append(directory)
            if sys.stderr.isatty():
                print(f"\r\x1b[K  {len(directories)} of {len(wanted)}", end="", file=sys.stderr, flush=True)
    if sys.stderr.isatty():
        print("\r\x1b[K", end="", file=sys.stderr, flush=True)
    return directories


def metrics_of(directories):
    return [json.loads((d / "metrics.json").read_text(encoding="utf-8")) for d in directories]


def say_gain(metrics):
    for program in PROGRAMS:
        at_table = {m["controller"]: m["contour"]["table"]["circular_deviation_um"] for m in metrics
                    if Path(m["program"]).stem == program}
        plain, full = (at_table[controller] for controller in REAL_TIME)
        say(f"{program}: circular deviation at the table {plain:.3g} um with MPC only, {full:.3g} um "
            f"compensated: {plain / full:.0f} times smaller")


def draw(directories, out):
    command = [sys.executable, ROOT / "tools" / "plots" / "plot_run.py", *directories, "--out", out]
    result = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
    if result.returncode != 0:
        raise DemoError("the pictures could not be drawn")
    return result.stdout.split("\n")[:-1]


def demo(binaries, out):
    for program in ("contourd", "contour"):
        if not (binaries / program).exists():
            raise DemoError(f"{binaries / program} is missing; run tools/setup first", 3)
    out.mkdir(parents=True, exist_ok=True)
    programs = write_programs(out)
    say("== contourd in real time on the in-process bus")
    try:
        real_time = run_in_real_time(binaries, programs, out)
    except HeldUp:
        say(f"  this computer is too busy for real time ({ATTEMPTS} attempts); what follows is in virtual time only")
        real_time = []
    say("== every controller in virtual time")
    virtual = simulate_rivals(binaries, programs, out)
    shown = real_time or [d for d in virtual if d.name.endswith(tuple(f"_{c}" for c in REAL_TIME))]
    metrics = metrics_of(real_time + virtual)
    say("")
    say(table_text(metrics))
    say("")
    say_gain(metrics_of(shown))
    say("")
    say(f"== pictures of the runs in {'real' if real_time else 'virtual'} time")
    for picture in draw(shown, out):
        say(f"  {picture}")
    say(f"logs of every cycle for lcm-logplayer, tables and metrics are in {out}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--out", default=ROOT / "out" / "demo", type=Path, help="where the results go")
    parser.add_argument("--build", default=ROOT / "build" / "release", type=Path, help="build directory")
    arguments = parser.parse_args()
    try:
        demo(arguments.build.resolve() / "bin", arguments.out.resolve())
    except DemoError as error:
        print(f"demo: {error}", file=sys.stderr)
        return error.status
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
