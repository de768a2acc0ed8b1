"""Random G-code of the dialect, sound or with one wrong line, from a seed."""
import math
import random

WRONG = [
    "G1 X1 X2", "G0 G1 X1", "G61 G64", "G17 G18", "G90 G91", "G20 G21", "M3 M5", "M7 M8", "G4", "G4 P-1", "G4 P1 G2 X1 I0.5",
    "G80 X1", "G80 G80 X1", "G80 G0 G1 X1", "G1 G80 G0 X1", "G80 G0 G92 X1", "G0 G80 G28 X1", "G80 G53 X1", "G91 G53 G0 X1", "G0 G0 X1", "G80\nX1",
    "WHILE [#1 LT 5]", "IF [#1 EQ 0] GOTO 10", "GOTO 10", "G4 X2", "G92", "G52", "G92 X1 G0", "G10 L2 P10 X1", "G10 P1 X1", "G2 X1", "G3 X3 I1 R5", "G2 X1 Y1 R0", "G2 R5", "G2 X7 I1 P0",
    "G2 X7 I1 P1.5", "G17 G2 I1 K1", "G18 G2 I1 J1", "G90.1 G3 X1 I1", "G2 X300 R2", "G91 G2 X10 I5.1", "G2 I0 J0 X5", "G1 P1", "G0 X1 Q1", "G0 X1 K1",
    "G0 X1 H1", "G0 X1 D1", "G0 X1 L1", "G0 X1 R1", "G0 X1.2.3", "G0 X.", "G0 X1-2", "G0 X", "G0 X1e3", "G0 X1 N5", "N5 /G0 X1", "N5N6 G0",
    "G0 (a (b) X1", "G0 X1 (open", "G0 X1)", "G0 X(a)1", "%", "G1.04 X1", "G1.001", "G100", "G1000", "G-1", "M3.5", "M200", "M31", "S-1", "T-1",
    "F-1", "G1 F0 X1", "G94 G1 X1", "G93 G1 X1\nX2", "M3 M6 M8 M48 M0", "G0 X#<nothing>", "G0 X[1/0]", "G0 X[1+]", "G0 X[1", "G0 X[sqrt[-1]]", "G0 X[asin[2]]",
    "#0=1", "#10000=1", "#1.5=2", "#5420=1", "#=3", "G0 X[2 foo 3]", "G0 X[ln[0]]", "G0 X[[-2]**0.5]", "G0 X##9", "X", 
    "G0X1Y2Z3X4", "g", "G0 X[atan[1]]", "G0 X[foo[1]]", "M", "G0 X--", "M0 M2",
    "G81", "G81 R2", "G81 X1 Z-1", "G81 X1 R2", "G83 X1 Z-1 R2", "G83 X1 Z-1 R2 Q0", "G82 X1 Z-1 R2", "G82 X1 Z-1 R2 P-1", "G81 X1 Z3 R2", "G81 X1 Z-1 R2 P3", "G73 X1 Z-1 R2 Q-1",
    "G81 X1 Z-1 R2 Q1", "G81 X1 Z-1 R2 I1", "G81 X1 Z-1 R2 L0", "G81 X1 Z-1 R2 L1.5", "G93 G81 X1 Z-1 R2 F2", "G53 G81 X1 Z-1 R2", "G0 X1\nG81 X7", "G92 X1 G81",
    "G0 @1 X2", "G18 G0 X1\nG0 @1 ^2", "@1 ^30", "G92 @1", "#<_metric>=2",
]
AXES = "XYZUVW"


class RandomProgram:
    def __init__(self, seed):
        self.r = random.Random(seed)
        self.lines = []
        self.label = 100
        self.incremental = False
        self.inverse = False

    def number(self, low=-60.0, high=60.0):
        value = self.r.uniform(low, high)
        text = f"{value:.{self.r.choice([0, 1, 2, 3, 3, 4, 6])}f}"
        if text.lstrip("-").startswith("0.") and self.r.random() < 0.3:
            text = text.replace("0.", ".", 1)
        if "." not in text and self.r.random() < 0.3:
            text += "."
        if self.r.random() < 0.05 and not text.startswith("-"):
            text = "+" + text
        return text

    def value(self, low=-60.0, high=60.0):
        kind = self.r.random()
        if kind < 0.85:
            return self.number(low, high)
        if kind < 0.90:
            return f"[{self.number()} {self.r.choice(['+', '-', '*'])} {self.number(0.1, 3)}]"
        if kind < 0.94:
            return f"#{self.r.choice([1, 5, 31, 32])}"
        return self.r.choice([
            f"[sin[{self.number()}]*{self.number(1, 20)}]", f"[{self.number(1, 9)}**2/[1+{self.number(0, 3)}]]",
            f"[atan[{self.number(1, 9)}]/[{self.number(1, 9)}]]", f"[round[{self.number()}] mod 7]", f"-[{self.number()}]",
            f"[10 * [{self.number()} gt {self.number()}]+fix[{self.number()}]]", f"sqrt[{self.number(0, 99)}]",
            f"[abs[{self.number()}] - fup[{self.number()}] + 2*3-4/5]", f"[#<_x> + {self.number(-1, 1)}]", "[#5421 / 2]",
            "[#<_metric> + 2*#<_absolute> - #<_plane>/17]", "[#<_coord_system>/50 + #<_incremental>]", "[#<_motion_mode> / 5]",
        ])

    def words(self, most=4, axes=AXES):
        chosen = self.r.sample(axes, self.r.randint(1, min(most, len(axes))))
        if self.r.random() < 0.75:
            chosen = [a for a in chosen if a in "XYZ"] or ["X"]
        return [a + self.value() for a in chosen]

    def feed(self):
        return ["F" + self.number(1, 3000)] if self.inverse or self.r.random() < 0.2 else []

    def straight(self):
        block = self.words() + self.feed()
        if self.r.random() < 0.5:
            block.append(self.r.choice(["G0", "G1", "G01", "G1", "g00"]))
            block += self.r.choice([["G80"], ["G80", "G80"]] + [[]] * 8)
        else:
            self.lines.append("G1" + (" F100" if self.inverse else ""))
        self.r.shuffle(block)
        return block

    def rounded_arc(self):
        """An arc by its centre, written with a few decimals, so that its radii differ a little."""
        plane, first, second, i, j, normal = self.r.choice(
            [("G17", "X", "Y", "I", "J", "Z"), ("G18", "Z", "X", "K", "I", "Y"), ("G19", "Y", "Z", "J", "K", "X")])
        radius, begin = 10 ** self.r.uniform(-1, 2), self.r.uniform(0, 2 * math.pi)
        sweep = self.r.choice([self.r.uniform(0.1, 6.2), 2 * math.pi, math.pi])
        ccw = self.r.random() < 0.5
        end = begin + (sweep if ccw else -sweep)
        places = self.r.choice([2, 3, 4, 5])
        block = [plane, "G91", "G3" if ccw else "G2", f"{i}{-radius * math.cos(begin):.{places}f}",
                 f"{j}{-radius * math.sin(begin):.{places}f}", f"{first}{radius * (math.cos(end) - math.cos(begin)):.{places}f}",
                 f"{second}{radius * (math.sin(end) - math.sin(begin)):.{places}f}"]
        if self.r.random() < 0.4:
            block.append(normal + self.number(-5, 5))
        if self.r.random() < 0.2:
            block.append(f"P{self.r.randint(1, 4)}")
        if self.r.random() < 0.1:
            block.append("U" + self.number(-5, 5))
        self.incremental = True
        return block + self.feed()

    def radius_arc(self):
        plane, axes = self.r.choice([("G17", "XY"), ("G18", "ZX"), ("G19", "YZ")])
        block = [plane, self.r.choice(["G2", "G3", "G03"]), axes[0] + self.number(), axes[1] + self.number(),
                 "R" + self.number(150, 900) if self.r.random() < 0.7 else "R-" + self.number(150, 900).lstrip("+")]
        if self.r.random() < 0.3:
            block.append("P2")
        return self.r.choice([["G80"], []]) + block + self.feed()

    def full_circle(self):
        return ["G17", self.r.choice(["G2", "G3"]), "I" + self.number(1, 20), "J" + self.number(-20, 20)] + self.feed() + self.r.choice([[], ["Z" + self.number()]])

    def polar(self):
        words = self.r.sample(["@" + self.number(0.1, 40), "^" + self.number(-400, 400)], self.r.choice([1, 2, 2]))
        self.lines.append("G17")
        return [self.r.choice(["G0", "G1"])] + words + self.feed() + self.r.choice([[], ["Z" + self.number()]])

    def cycles(self):
        """A series of holes, ended by G80: what becomes of one in another mode is refused here, and to a higher R it first goes up."""
        plane, axes, normal = self.r.choice([("G17", "XY", "Z"), ("G17", "XY", "Z"), ("G18", "ZX", "Y"), ("G19", "YZ", "X")])
        code = self.r.choice(["G73", "G81", "G82", "G83", "G85", "G89"])

        clear = self.r.uniform(-5, 5) if self.incremental else self.r.uniform(-20, 20)

        def depth():
            return f"{normal}{(0 if self.incremental else clear) - self.r.uniform(0.5, 15):.3f}"

        def place():
            if plane == "G17" and self.r.random() < 0.1:
                return ["@" + self.number(0.1, 40), "^" + self.number(-400, 400)]
            return [a + self.number() for a in self.r.sample(axes, self.r.choice([1, 2]))]
        own = {"G73": ["Q" + self.number(1, 6)], "G83": ["Q" + self.number(1, 6)], "G82": ["P" + self.number(0, 2)],
               "G89": ["P" + self.number(0, 2)]}.get(code, [])
        first = [code, *place(), f"R{clear:.3f}", depth(), *own] + self.r.choice([[], ["L" + str(self.r.randint(1, 3))]])
        self.r.shuffle(first)
        self.lines.append(" ".join([plane, *self.r.choice([["G98"], ["G99"], []]), *first]))
        for _ in range(self.r.randint(0, 3)):
            again = place() + self.r.choice([[], [], [], [code], [depth()], [["G98"], ["G99"]][self.r.randint(0, 1)][0:1], own, ["L2"]])
            self.lines.append(self.dressed(again).lstrip("/"))
        return ["G80"]

    def home(self):
        """Positions of the machine, whose zero is program zero for both readers."""
        if self.r.random() < 0.5:
            return [self.r.choice(["G28", "G30"])] + self.r.choice([[], self.words()])
        self.incremental = False
        return ["G90", "G53", "G0"] + self.words()

    def mode(self):
        kind = self.r.randint(0, 13)
        if kind == 12:
            return self.home()
        if kind == 13:
            return self.r.choice([["G43", f"H{self.r.randint(1, 9)}"], ["G49"]])
        if kind == 0:
            return [self.r.choice(["G20", "G21", "G21"])]
        if kind == 1:
            self.incremental = self.r.random() < 0.5
            return ["G91" if self.incremental else "G90"]
        if kind == 2:
            return [self.r.choice(["G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3"])]
        if kind == 3:
            return ["G92"] + self.words(axes="XYZUVW")
        if kind == 4:
            return [self.r.choice(["G92.1", "G92.2", "G92.3"])]
        if kind == 5:
            return ["G10", self.r.choice(["L2", "L20"]), f"P{self.r.randint(0, 9)}"] + self.words()
        if kind == 6:
            return [self.r.choice(["G61", "G61.1", "G64", "G64 P0.02", "G64 P0.01 Q0.005", "G64 P0"])]
        if kind == 7:
            return ["G4", "P" + self.number(0, 3)]
        if kind == 8:
            self.inverse = not self.inverse
            return ["G93"] if self.inverse else ["G94", "F" + self.number(1, 3000)]
        if kind == 9:
            return [self.r.choice(["M3 S1000", "M5", "M8", "M9", "M7", "S500", "M0", "M1", "M4", "M48"])]
        if kind == 10:
            return [self.r.choice(["G40", "G49", "G80 G40", "G17 G21 G40 G49", "G98", "G99", "G8 G97", "G00 G17 G40 G49 G80 G90"])]
        return ["F" + self.number(1, 3000)] if not self.inverse else ["G52 X" + self.number()]

    def parameters(self):
        return [f"#{self.r.choice([1, 5, 31, 32])}={self.value(-9, 9)}"]

    def flow(self):
        self.label += 1
        name = self.r.choice([str(self.label), f"<part {self.label}>"])
        inner = [" ".join(self.words()) for _ in range(self.r.randint(1, 3))]
        kind = self.r.randint(0, 4)
        self.lines.append("G0")
        if kind == 0:
            self.lines += [f"O{name} repeat [{self.r.randint(0, 3)}]", *inner, f"o{name} endrepeat"]
        elif kind == 1:
            self.lines += [f"#7=0", f"o{name} while [#7 lt {self.r.randint(0, 3)}]", *inner, "#7=[#7+1]", f"o{name} endwhile (end)"]
        elif kind == 2:
            self.lines += [f"o{name} if [{self.number()} gt 0]", *inner, f"o{name} elseif [{self.number()} lt 5]", "Y3", f"o{name} else", "Z4", f"o{name} endif"]
        elif kind == 3:
            self.lines += [f"o{name} sub", "G0 X#1 Y[#2*2]", *inner, f"o{name} endsub", f"o{name} call [{self.number()}] [{self.number()}]"]
        else:
            self.lines += ["#8=2", f"o{name} do", *inner, "#8=[#8-1]", f"o{name} while [#8 gt 0]"]

    def dressed(self, block):
        text = self.r.choice([" ", "", "  "]).join(block)
        if self.r.random() < 0.1:
            text = " ".join(text) if "(" not in text else text
        if self.r.random() < 0.2:
            text = text.lower()
        if self.r.random() < 0.15:
            text = f"N{len(self.lines) * 10} " + text
        if self.r.random() < 0.05:
            text = "/" + text
        if self.r.random() < 0.1:
            text += self.r.choice([" (a comment, G99)", " ; the rest", "\t(x)"])
        return text

    def text(self, wrong):
        self.lines = ["G21 G90 G17 G94 F500 (begin)"]
        outside = []  # of loops and subs, where lines may be skipped, and then are not read here
        for _ in range(self.r.randint(5, 40)):
            outside.append(len(self.lines))
            kind = self.r.random()
            if kind < 0.04:
                self.flow()
                continue
            if kind < 0.08:
                block = self.parameters()
            elif kind < 0.30:
                block = self.mode()
            elif kind < 0.45:
                block = self.rounded_arc()
            elif kind < 0.52:
                block = self.radius_arc()
            elif kind < 0.57:
                block = self.full_circle()
            elif kind < 0.61:
                block = self.polar()
            elif kind < 0.65 and not self.inverse:
                block = self.cycles()
            else:
                block = self.straight()
            self.lines.append(self.dressed(block))
            if self.r.random() < 0.05:
                self.lines.append(self.r.choice(["", "  ", "(only a comment)", "; only a comment"]))
        if wrong is not None:
            self.lines.insert(self.r.choice(outside), wrong)
        framed = self.r.random() < 0.2
        self.lines.append("%" if framed and self.r.random() < 0.5 else self.r.choice(["M2", "M30", "m02"]))
        return self.r.choice(["\n", "\n", "\r\n"]).join((["%"] if framed else []) + self.lines) + "\n"


def programs(count, seed):
    """(number, text): three of four sound as far as chance goes, each wrong line once or more."""
    wrong = list(WRONG)
    random.Random(seed).shuffle(wrong)
    for number in range(count):
        fault = wrong[(number // 4) % len(wrong)] if number % 4 == 3 else None
        yield number, RandomProgram(seed * 100003 + number).text(fault)
