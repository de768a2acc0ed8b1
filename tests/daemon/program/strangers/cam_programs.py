"""Part programs as strangers write them: sixteen kinds, each drawn by a seed, in the manners of many posts and hands.

Nothing here knows contourd. Programs begin where the machine stands and stay within 45 mm of there on every axis, 12 mm on Z.
"""

import math
import random

IN_SPACE = ("helices", "surface", "raster")
KINDS = ("chords3", "chords4", "text", "spiral", "pocket", "rounded_pocket", "zigzag", "anything", "near_reversals", "tiny_arcs",
         "noisy_scan", "inverse_time", "long_and_short", "bolt_circle") + IN_SPACE


class Post:
    """Writes moves the way one post does: decimals, units, case, block numbers, line ends, modal words or not."""

    def __init__(self, draw, decimals=None, may_be_relative=True):
        self.draw = draw
        self.inch = draw.random() < 0.15
        self.decimals = (decimals or draw.choice([3, 4])) + (1 if self.inch else 0)
        self.relative = may_be_relative and draw.random() < 0.15
        self.numbers = draw.random() < 0.3
        self.modal = draw.random() < 0.5
        self.small = draw.random() < 0.2
        self.blanks = draw.choice(["", " ", " ", "\t"])
        self.end = draw.choice(["\n", "\n", "\r\n"])
        self.percent = draw.random() < 0.3
        self.lines, self.code, self.at = [], None, {}
        self.write("G20" if self.inch else "G21", "G91" if self.relative else "G90", "G17", draw.choice(["", "G40 G49 G80", "G94"]))

    def write(self, *words):
        words = [w for w in words if w]
        if words:
            self.lines.append(self.blanks.join(words))

    def number(self, mm):
        """As it is written, and what that is in mm."""
        text = f"{mm / 25.4 if self.inch else mm:.{self.decimals}f}"
        return text, float(text) * (25.4 if self.inch else 1.0)

    def words(self, targets):
        """Coordinates; a relative post does not let its rounding add up."""
        out = []
        for letter, mm in targets.items():
            if self.relative:
                text, moved = self.number(mm - self.at.get(letter, 0.0))
                self.at[letter] = self.at.get(letter, 0.0) + moved
            else:
                text, self.at[letter] = self.number(mm)
            out.append(letter + text)
        return out

    def move(self, code, **targets):
        said = [] if self.modal and code == self.code else [code]
        self.code = code
        self.write(*said, *self.words(targets))

    def feed(self, mm_min):
        self.write(f"F{mm_min / 25.4 if self.inch else mm_min:.{2 if self.inch else 1}f}")

    def tolerance(self, mm, naive_mm=None):
        self.write(f"G64 P{self.number(mm)[0]}" + (f" Q{self.number(naive_mm)[0]}" if naive_mm else ""))

    def arc(self, clockwise, end, centre, plane="XY", **others):
        """By its centre, rounded as everything is; `end` None: a whole turn."""
        code = "G2" if clockwise else "G3"
        letters = {"X": "I", "Y": "J", "Z": "K"}
        offsets = [letters[a] + self.number(c - self.at.get(a, 0.0))[0] for a, c in zip(plane, centre)]
        targets = dict(zip(plane, end)) if end else {}
        self.code = code
        self.write(code, *self.words({**targets, **others}), *offsets)

    def text(self):
        lines = self.lines + [self.draw.choice(["M2", "M30"])]
        if self.numbers:
            lines = [f"N{10 * (k + 1)}{self.blanks}{line}" for k, line in enumerate(lines)]
        if self.percent:
            lines = ["%"] + lines + ["%"]
        text = self.end.join(lines) + self.end
        return text.lower() if self.small else text


def opened(draw, feed, decimals=None, may_be_relative=True, tolerance=True):
    post = Post(draw, decimals, may_be_relative)
    if tolerance and draw.random() < 0.5:
        post.tolerance(draw.choice([0.005, 0.01, 0.02, 0.05]), draw.choice([None, None, 0.002]))
    if draw.random() < 0.3:
        post.write(f"T{draw.randrange(1, 9)}", "")
        post.write(f"S{draw.randrange(500, 12000)} M3")
    post.feed(feed)
    return post


def follow(post, points, code="G1"):
    for point in points:
        post.move(code, **dict(zip("XYZ", point)))


def blob(draw, chord):
    """A closed curve of a few waves in chords, from its first point back to it."""
    radius, waves, depth, phase = draw.uniform(4, 14), draw.randrange(2, 7), draw.uniform(0, 0.25), draw.uniform(0, 6.28)
    length = 2 * math.pi * radius * (1 + depth)
    n = min(2500, max(12, int(length / chord)))

    def at(k):
        a = 2 * math.pi * k / n
        r = radius * (1 + depth * math.cos(waves * a + phase))
        return r * math.cos(a), r * math.sin(a)
    x0, y0 = at(0)
    return [(at(k)[0] - x0, at(k)[1] - y0) for k in range(1, n + 1)]


def chords3(draw):
    post = opened(draw, draw.uniform(800, 8000), 3)
    follow(post, blob(draw, 10 ** draw.uniform(-2, -0.3)))
    return post


def chords4(draw):
    post = opened(draw, draw.uniform(800, 12000), 4)
    follow(post, blob(draw, 10 ** draw.uniform(-2, -0.3)))
    return post


def text(draw):
    post = opened(draw, draw.uniform(600, 3000))
    chord = draw.uniform(0.03, 0.3)
    for letter in range(draw.randrange(4, 9)):
        x, y = 3.0 * letter, 0.0
        for _ in range(draw.randrange(1, 4)):
            post.move("G0", X=x, Y=y)
            for _ in range(draw.randrange(1, 4)):
                if draw.random() < 0.6:
                    r, begin, sweep = draw.uniform(0.2, 1.2), draw.uniform(0, 6.28), draw.uniform(-5, 5)
                    cx, cy = x - r * math.cos(begin), y - r * math.sin(begin)
                    n = 2 + int(abs(sweep) * r / chord)
                    stroke = [(cx + r * math.cos(begin + sweep * i / n), cy + r * math.sin(begin + sweep * i / n)) for i in range(1, n + 1)]
                else:
                    stroke = [(x + draw.uniform(-1, 1), y + draw.uniform(-2, 2))]
                follow(post, stroke)
                x, y = stroke[-1]
            x, y = 3.0 * letter + draw.uniform(0, 1.5), draw.uniform(-1, 2)
    return post


def spiral(draw):
    post = opened(draw, draw.uniform(2000, 12000))
    pitch, chord, turns, angle, points = draw.uniform(0.2, 1.5), 10 ** draw.uniform(-1.7, -0.3), draw.uniform(4, 9), 0.0, []
    while angle < 2 * math.pi * turns and len(points) < 3000:
        r = 0.2 + pitch * angle / (2 * math.pi)
        angle += min(0.5, chord / r)
        points.append((r * math.cos(angle) - 0.2, r * math.sin(angle)))
    follow(post, points)
    return post


def pocket(draw, rounded=False):
    post = opened(draw, draw.uniform(1000, 6000), may_be_relative=False)
    step = draw.uniform(0.8, 3)
    loops = draw.randrange(3, 7)
    for k in range(loops, 0, -1):
        a, b = step * k + 3, step * k
        x0, y0 = 20 - a, 15 - b
        radius = draw.uniform(0.3, 0.9 * step) if rounded else 0.0
        post.move(draw.choice(["G0", "G1"]), X=x0 + radius, Y=y0)
        corners = [(x0 + 2 * a, y0), (x0 + 2 * a, y0 + 2 * b), (x0, y0 + 2 * b), (x0, y0)]
        headings = [(1, 0), (0, 1), (-1, 0), (0, -1)]
        for i, (x, y) in enumerate(corners):
            (ux, uy), (vx, vy) = headings[i], headings[(i + 1) % 4]
            post.move("G1", X=x - radius * ux, Y=y - radius * uy)
            if rounded:
                post.code = "G3"
                post.write("G3", *post.words({"X": x + radius * vx, "Y": y + radius * vy}), "R" + post.number(radius)[0])
    return post


def rounded_pocket(draw):
    return pocket(draw, True)


def zigzag(draw):
    post = opened(draw, 3000)
    step, width = draw.uniform(0.2, 3), draw.uniform(4, 25)
    for k in range(draw.randrange(5, 12)):
        post.move("G0", X=width if k % 2 == 0 else 0.0)
        if draw.random() < 0.3:
            post.move("G0", Y=step * k + draw.uniform(0.001, 0.02))
        post.move("G0", Y=step * (k + 1))
    return post


def anything(draw):
    post = opened(draw, 1000, may_be_relative=False)
    x = y = 0.0
    for _ in range(draw.randrange(30, 70)):
        if draw.random() < 0.2:
            post.feed(10 ** draw.uniform(1.8, 4.2))
        if draw.random() < 0.04:
            post.write(draw.choice(["G61", "G61.1", "G64", "G64 P0.02" if not post.inch else "G64 P0.001"]))
        length, heading = 10 ** draw.uniform(-3, 1.3), draw.uniform(-math.pi, math.pi)
        tx, ty = x + length * math.cos(heading), y + length * math.sin(heading)
        if max(abs(tx), abs(ty)) > 40:
            tx, ty = draw.uniform(-5, 5), draw.uniform(-5, 5)
            length, heading = math.hypot(tx - x, ty - y), math.atan2(ty - y, tx - x)
        what = draw.random()
        if what < 0.1:
            post.move("G0", X=tx, Y=ty)
        elif what < 0.2 and length > 0.05:
            r = draw.uniform(0.5, 2) * length
            cx, cy = x + r * math.cos(heading), y + r * math.sin(heading)
            if max(abs(cx), abs(cy)) + r < 44:
                post.arc(draw.random() < 0.5, None, (cx, cy))
        elif what < 0.35 and length > 0.05:
            # Symmetric to its chord: the centre is rounded, both radii stay alike within a unit.
            mx, my, h = (x + tx) / 2, (y + ty) / 2, draw.uniform(-1, 1) * length
            cx, cy = mx - h * math.sin(heading), my + h * math.cos(heading)
            r = math.hypot(cx - x, cy - y)
            if max(abs(cx), abs(cy)) + r < 44:
                post.arc(draw.random() < 0.5, (tx, ty), (cx, cy))
        elif what < 0.4:
            post.move("G1", X=x, Y=y)
        else:
            post.move("G1", X=tx, Y=ty)
        x, y = post.at.get("X", x), post.at.get("Y", y)
    return post


def near_reversals(draw):
    post = opened(draw, draw.uniform(1000, 9000))
    for k in range(draw.randrange(15, 40)):
        across = draw.uniform(-1, 1) * 10 ** draw.uniform(-3, 0)
        post.move("G1", X=draw.uniform(0.5, 12) if k % 2 == 0 else draw.uniform(-3, 0.3), Y=0.05 * k + across)
    return post


def tiny_arcs(draw):
    post = opened(draw, draw.uniform(500, 5000), 4, may_be_relative=False)
    x = y = 0.0
    for _ in range(draw.randrange(20, 60)):
        r, begin, sweep = 10 ** draw.uniform(-1.3, 0), draw.uniform(0, 6.28), draw.uniform(0.3, 5)
        clockwise = draw.random() < 0.5
        cx, cy = x - r * math.cos(begin), y - r * math.sin(begin)
        end = begin + (-sweep if clockwise else sweep)
        post.arc(clockwise, (cx + r * math.cos(end), cy + r * math.sin(end)), (cx, cy))
        x, y = post.at["X"], post.at["Y"]
        if max(abs(x), abs(y)) > 35:
            post.move("G0", X=0.0, Y=0.0)
            x = y = 0.0
    return post


def noisy_scan(draw):
    post = opened(draw, draw.uniform(800, 5000), 3)
    y = 0.0
    for row in range(draw.randrange(2, 5)):
        n = draw.randrange(60, 250)
        order = range(n + 1) if row % 2 == 0 else range(n, -1, -1)
        for k in order:
            y += draw.gauss(0, 0.003)
            post.move("G1", X=24.0 * k / n, Y=1.2 * row + 0.8 * math.sin(9 * k / n) + draw.gauss(0, 0.002))
    return post


def inverse_time(draw):
    post = opened(draw, 2000)
    post.write("G93")
    points, last = blob(draw, draw.uniform(0.1, 1)), (0.0, 0.0)
    feed = draw.uniform(1000, 6000)
    for x, y in points:
        length = max(1e-3, math.hypot(x - last[0], y - last[1]))
        post.write("G1", *post.words({"X": x, "Y": y}), f"F{feed / length:.3f}")
        last = (x, y)
    return post


def long_and_short(draw):
    post = opened(draw, draw.uniform(2000, 12000))
    x = y = 0.0
    for _ in range(draw.randrange(8, 16)):
        x, y = draw.uniform(-30, 30), draw.uniform(-30, 30)
        post.move("G1", X=x, Y=y)
        heading = draw.uniform(-3.14, 3.14)
        for _ in range(draw.randrange(0, 15)):
            length = 10 ** draw.uniform(-2.3, 0)
            heading += draw.gauss(0, 0.4)
            x, y = x + length * math.cos(heading), y + length * math.sin(heading)
            post.move("G1", X=x, Y=y)
    return post


def bolt_circle(draw):
    """Holes on a circle, milled round, with rapids between them."""
    post = opened(draw, draw.uniform(600, 4000), may_be_relative=False)
    holes, ring, radius = draw.randrange(3, 9), draw.uniform(8, 25), draw.uniform(0.5, 2.5)
    for k in range(holes):
        a = 2 * math.pi * k / holes
        x, y = ring * math.cos(a), ring * math.sin(a)
        post.move("G0", X=x, Y=y)
        post.move("G1", X=x + radius, Y=y)
        post.arc(draw.random() < 0.5, None, (post.at["X"] - radius, post.at["Y"]))
        post.move("G1", X=x, Y=y)
    return post


def helices(draw):
    post = opened(draw, draw.uniform(800, 5000), 4, may_be_relative=False)
    for k in range(draw.randrange(2, 5)):
        x, radius = 10.0 * k, draw.uniform(1, 5)
        post.move("G0", X=x, Y=0.0, Z=0.0)
        z = 0.0
        for _ in range(draw.randrange(2, 6)):
            z -= draw.uniform(0.2, 2)
            post.arc(False, (post.at["X"], post.at["Y"]), (post.at["X"] - radius, post.at["Y"]), Z=z)
    return post


def surface(draw):
    post = opened(draw, draw.uniform(1500, 8000))
    chord, length = 10 ** draw.uniform(-1.3, -0.3), draw.uniform(8, 20)
    n = min(400, int(length / chord))
    wave, depth = draw.uniform(0.2, 1.2), draw.uniform(0.2, 2)
    for row in range(draw.randrange(2, 6)):
        for k in (range(n + 1) if row % 2 == 0 else range(n, -1, -1)):
            x, y = length * k / n, 0.4 * row
            post.move("G1", X=x, Y=y, Z=depth * (math.sin(wave * x + 0.3 * y) - 1) * 0.5)
    return post


def raster(draw):
    """Rows at depth, up and over between them."""
    post = opened(draw, draw.uniform(1500, 8000))
    step, width, depth = draw.uniform(0.5, 2), draw.uniform(5, 20), draw.uniform(0.5, 4)
    for row in range(draw.randrange(3, 8)):
        post.move("G1", Z=-depth)
        post.move("G1", X=width if row % 2 == 0 else 0.0)
        if draw.random() < 0.6:
            post.move("G0", Z=1.0)
        post.move("G0", Y=step * (row + 1))
    return post


def program(kind, seed):
    """Its text. The same for the same seed."""
    draw = random.Random(f"{kind} {seed}")
    return globals()[kind](draw).text()
