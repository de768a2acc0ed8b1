"""Part programs as a CAM post or a hand would write them, from a seed, and machines to run them on."""

import math
import random

MACHINES = {
    "table": {"velocity": 0.25, "acceleration": 5.0, "jerk": 200.0, "tolerance": 1e-5},
    "fine5": {"velocity": 0.1, "acceleration": 4.85, "jerk": 194.0, "tolerance": 1e-5},
    "gantry500": {"velocity": 0.625, "acceleration": 1.87, "jerk": 69.4, "tolerance": 1e-5},
}

# What tools/test looks at; the rest is for tools/nightly.
SHORT = {("table", "square"), ("table", "circle, 0.02 mm")}


def moves(points, feed, decimals):
    return f"G21 G90\nF{feed}\n" + "".join(f"G1 X{x:.{decimals}f} Y{y:.{decimals}f}\n" for x, y in points) + "M2\n"


def circle(radius, chord, decimals, feed):
    n = round(2 * math.pi * radius / chord)
    return moves([(radius * (math.cos(2 * math.pi * k / n) - 1), radius * math.sin(2 * math.pi * k / n))
                  for k in range(1, n + 1)], feed, decimals)


def spiral(turns, pitch, chord, decimals, feed):
    points, angle = [], 0.0
    while angle < 2 * math.pi * turns:
        radius = 0.2 + pitch * angle / (2 * math.pi)
        angle += chord / radius
        points.append((radius * math.cos(angle) - 0.2, radius * math.sin(angle)))
    return moves(points, feed, decimals)


def text(seed, letters, chord, decimals, feed):
    draw = random.Random(seed)
    out = f"G21 G90\nF{feed}\n"
    for k in range(letters):
        x, y = 2.5 * k, 0.0
        out += f"G0 X{x:.{decimals}f} Y{y:.{decimals}f}\n"
        for _ in range(3):
            if draw.random() < 0.5:
                radius, begin, sweep = draw.uniform(0.3, 1.2), draw.uniform(0, 6.28), draw.uniform(-5, 5)
                cx, cy = x - radius * math.cos(begin), y - radius * math.sin(begin)
                n = 2 + int(abs(sweep) * radius / chord)
                for i in range(1, n + 1):
                    x, y = cx + radius * math.cos(begin + sweep * i / n), cy + radius * math.sin(begin + sweep * i / n)
                    out += f"G1 X{x:.{decimals}f} Y{y:.{decimals}f}\n"
            else:
                x, y = x + draw.uniform(-1, 1), y + draw.uniform(-2, 2)
                out += f"G1 X{x:.{decimals}f} Y{y:.{decimals}f}\n"
    return out + "M2\n"


def surface(rows, chord, decimals, feed):
    """Rows of a finishing pass over waves, linked by rapids."""
    out = f"G21 G90\nF{feed}\n"
    for row in range(rows):
        n = round(20 / chord)
        steps = range(n + 1) if row % 2 == 0 else range(n, -1, -1)
        for i in steps:
            x, y = chord * i, 0.3 * row
            z = 0.8 * math.sin(0.6 * x + 0.3 * row) * math.cos(0.2 * x)
            out += f"G1 X{x:.{decimals}f} Y{y:.{decimals}f} Z{z:.{decimals}f}\n"
    return out + "M2\n"


def anything(seed, count):
    draw = random.Random(seed)
    out = "G21 G91 F1000\n"
    for k in range(count):
        if k % 7 == 0:
            out += f"F{10 ** draw.uniform(1.5, 4.5):.1f}\n"
        length, heading = 10 ** draw.uniform(-2.5, 1), draw.uniform(-3.14, 3.14)
        out += f"{'G0' if draw.random() < 0.1 else 'G1'} X{length * math.cos(heading):.4f} " \
               f"Y{length * math.sin(heading):.4f}\n"
    return out + "M2\n"


def programs(everything):
    yield "square", "F3000\n" + "G1 X10\nY10\nX0\nY0\n" * 2
    yield "diamond", "F3000\nG1 X7.071 Y7.071\nX0 Y14.142\nX-7.071 Y7.071\nX0 Y0\n"
    yield "slot", "F5000\nG1 X20\nG3 Y10 J5\nG1 X0\nG3 Y0 J-5\nG1 X20\n"
    yield "zigzag of G0", "".join(f"G0 X{20 if k % 2 == 0 else 0}\nG0 Y{k + 1}\n" for k in range(10))
    yield "circle, arc", "F3000\nG3 X0 Y0 I-10\n"
    yield "circle, 0.5 mm", circle(10, 0.5, 3, 3000)
    yield "circle, 0.02 mm", circle(10, 0.02, 3, 3000)
    yield "text", text(3, 3, 0.2, 3, 1500)
    if not everything:
        return
    yield "circle, 0.02 mm, 10 m/min", circle(10, 0.02, 4, 10000)
    yield "spiral", spiral(8, 0.8, 0.1, 3, 4000)
    yield "text, 0.05 mm", text(4, 12, 0.05, 3, 1500)
    yield "surface", surface(6, 0.2, 3, 3000)
    for seed in range(1, 5):
        yield f"anything {seed}", anything(seed, 80)
