"""What LinuxCNC's interpreter makes of a program, as canonical moves in millimetres from program zero.

Twice: its Python module `gcode` gives every number in full, its program `rs274` prints four decimals, and the names of modes and events.
"""
import multiprocessing
import re
import subprocess
from pathlib import Path

INCH = 25.4
PLANES = {"XY": (0, 1, 2), "XZ": (2, 0, 1), "YZ": (1, 2, 0)}
TOOLS = range(1, 10)
PLANE_NUMBERS = {1: "XY", 2: "YZ", 3: "XZ", 170: "XY", 180: "XZ", 190: "YZ"}


def tool_length(number):
    """Of the tools that programs may ask for, mm."""
    return 1.75 * number if number in TOOLS else 0.0


def tool_table(unit):
    return "".join(f"T{n} P{n} Z{tool_length(n) / unit!r}\n" for n in TOOLS)


class Canon:
    """Keeps units and offsets, and makes moves of what is called."""

    def __init__(self, unit):
        self.unit = unit
        self.g5x = [0.0] * 6
        self.g92 = [0.0] * 6
        self.tool = [0.0] * 6
        self.plane = "XY"
        self.feed = 0.0
        self.moves = []

    def offset(self, k):
        return self.g5x[k] + self.g92[k] + self.tool[k]

    def target(self, values):
        return [v * self.unit + self.offset(k) for k, v in enumerate(values)]

    def straight(self, name, values):
        self.moves.append({"move": name, "to": self.target(values), "feed": self.feed if name == "STRAIGHT_FEED" else None})

    def arc(self, first_end, second_end, first, second, turns, normal_end, uvw):
        axes = PLANES[self.plane]
        values = [0.0] * 3
        for axis, value in zip(axes, (first_end, second_end, normal_end)):
            values[axis] = value
        centre = [first * self.unit + self.offset(axes[0]), second * self.unit + self.offset(axes[1])]
        self.moves.append({"move": "ARC_FEED", "to": self.target(values + list(uvw)), "centre": centre, "turns": turns,
                           "plane": {"XY": "G17", "XZ": "G18", "YZ": "G19"}[self.plane], "feed": self.feed})

    def dwell(self, seconds):
        self.moves.append({"move": "DWELL", "seconds": seconds})


class ModuleCanon(Canon):
    """Called by the module `gcode`, which speaks inches."""

    def __init__(self, parameter_file):
        super().__init__(INCH)
        self.parameter_file = str(parameter_file)

    def straight_traverse(self, *p):
        self.straight("STRAIGHT_TRAVERSE", [*p[:3], *p[6:9]])

    def straight_feed(self, *p):
        self.straight("STRAIGHT_FEED", [*p[:3], *p[6:9]])

    def arc_feed(self, first_end, second_end, first, second, turns, normal_end, a, b, c, u, v, w):
        self.arc(first_end, second_end, first, second, turns, normal_end, (u, v, w))

    def set_g5x_offset(self, index, *p):
        self.g5x = [v * INCH for v in [*p[:3], *p[6:9]]]

    def set_g92_offset(self, *p):
        self.g92 = [v * INCH for v in [*p[:3], *p[6:9]]]

    def tool_offset(self, *p):
        self.tool = [v * INCH for v in [*p[:3], *p[6:9]]]

    def set_plane(self, plane):
        self.plane = PLANE_NUMBERS[plane]

    def set_feed_rate(self, rate):
        self.feed = rate * INCH

    def get_tool(self, number):
        return (number, 0.0, 0.0, tool_length(number)) + (0.0,) * 9 + (0,)

    def get_axis_mask(self):
        return 0b111000111

    def get_external_length_units(self):
        return 1.0

    get_external_angular_units = get_external_length_units

    def get_block_delete(self):
        return False

    check_abort = get_block_delete

    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        return lambda *_: None


def by_module(gcode, program, scratch):
    """(moves, line of the error or None, its text); the line may be the one after. In a process of its own, as some programs crash the module."""
    ours, theirs = multiprocessing.Pipe(False)
    child = multiprocessing.get_context("fork").Process(target=lambda: theirs.send(run_module(gcode, program, scratch)))
    child.start()
    theirs.close()
    try:
        return ours.recv() if ours.poll(60) else None
    except EOFError:
        return None
    finally:
        child.kill()
        child.join()


def run_module(gcode, program, scratch):
    parameters = Path(scratch) / "module.var"
    parameters.write_text("".join(f"{n}\t0.0\n" for n in [*range(5161, 5170), *range(5181, 5190)]))
    canon = ModuleCanon(parameters)
    result, line = gcode.parse(str(program), canon, "G21", "")
    refused = result > gcode.MIN_ERROR
    return canon.moves, line if refused else None, gcode.strerror(result) if refused else ""


def by_program(program, scratch):
    """(moves and events or None where it crashes, text of the line that is refused or None). X Y Z only, in the four decimals that it prints."""
    parameters, tools = Path(scratch) / "program.var", Path(scratch) / "tools.tbl"
    parameters.write_text("".join(f"{n}\t0.0\n" for n in [*range(5161, 5170), *range(5181, 5190)]))
    tools.write_text(tool_table(INCH))  # in rs274's own unit
    done = subprocess.run(["rs274", "-g", "-v", str(parameters), "-t", str(tools), str(program)], capture_output=True, text=True, timeout=60)
    canon = Canon(1.0)
    ended = False
    for line in done.stdout.splitlines():
        call = re.match(r"\s*\d+\s+N\S*\s+(\w+)\((.*)\)\s*$", line)
        if call:
            ended = ended or call[1] in ("PROGRAM_END", "FINISH")
            if not ended:
                take_printed(canon, call[1], [w.strip() for w in call[2].split(",")])
    said = [line for line in done.stderr.splitlines() if line.strip()]
    crashed = done.returncode < 0 or (not ended and said[-1:] == ["executing"])
    return None if crashed else canon.moves, None if ended or crashed else said[-1].strip()


# The end of a program stops spindle and coolant too: these two are left out.
EVENTS = {"START_SPINDLE_CLOCKWISE": "M3", "START_SPINDLE_COUNTERCLOCKWISE": "M4", "MIST_ON": "M7", "FLOOD_ON": "M8",
          "PROGRAM_STOP": "M0", "OPTIONAL_PROGRAM_STOP": "M1"}


def take_printed(canon, name, words):
    numbers = lambda: [float(w) for w in words]
    if name in ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED"):
        canon.straight(name, numbers()[:3] + [0.0] * 3)
    elif name == "ARC_FEED":
        n = numbers()
        canon.arc(n[0], n[1], n[2], n[3], int(n[4]), n[5], (0.0, 0.0, 0.0))
    elif name == "DWELL":
        canon.dwell(float(words[0]))
    elif name == "USE_LENGTH_UNITS":
        canon.unit = INCH if "INCH" in words[0] else 1.0
    elif name == "SET_G5X_OFFSET":
        canon.g5x = [v * canon.unit for v in numbers()[1:4]] + [0.0] * 3
    elif name == "USE_TOOL_LENGTH_OFFSET":
        n = [float(w) for w in " ".join(words).split()]
        canon.tool = [v * canon.unit for v in [*n[:3], *n[6:9]]]
    elif name == "SET_G92_OFFSET":
        canon.g92 = [v * canon.unit for v in numbers()[:3]] + [0.0] * 3
    elif name == "SELECT_PLANE":
        canon.plane = words[0].rsplit("_", 1)[1]
    elif name == "SET_FEED_RATE":
        canon.feed = float(words[0]) * canon.unit
    elif name in EVENTS:
        canon.moves.append({"move": "EVENT", "name": EVENTS[name]})
