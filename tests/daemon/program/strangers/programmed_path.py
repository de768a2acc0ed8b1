"""The programmed path, from the canonical moves that `contour check --canon` prints, and how far points are from it. mm."""

import math

import numpy as np

AXES = "xyzuvw"
SAGITTA = 2e-5     # of chords that stand for an arc
MACHINE = -1.0     # tolerance: what the machine file says


class ProgrammedPath:
    """Straight pieces; arcs in chords of them."""

    def __init__(self, canon, axes):
        self.columns = [AXES.index(a) for a in axes]
        begins, ends, allowed = [], [], []
        self.off_radius = 0.0  # radii of one arc that differ: its post has few decimals
        at = np.zeros(6)
        for line in canon.splitlines():
            words = line.split()
            if words[1] in ("DWELL", "EVENT"):
                continue
            to = np.array([float(w[1:]) for w in words[2:8]])
            tolerance = float(words[-1][1:]) if words[-1][0] == "P" and words[-2] == "G64" else MACHINE
            points = self.arc(at, to, words) if words[1] == "ARC_FEED" else [at, to]
            for a, b in zip(points[:-1], points[1:]):
                begins.append(a[self.columns])
                ends.append(b[self.columns])
                allowed.append(tolerance)
            at = to
        self.begin, self.end = np.array(begins), np.array(ends)
        self.tolerance = np.array(allowed)

    def arc(self, at, to, words):
        plane = {"G17": (0, 1), "G18": (2, 0), "G19": (1, 2)}[words[8]]
        centre = np.array([float(words[10]), float(words[11])])
        turns = int(words[13])
        first, last = at[list(plane)] - centre, to[list(plane)] - centre
        begin, end = math.atan2(first[1], first[0]), math.atan2(last[1], last[0])
        sweep = (end - begin) % (2 * math.pi) if turns > 0 else -((begin - end) % (2 * math.pi))
        if abs(sweep) < 1e-9:
            sweep = math.copysign(2 * math.pi, turns)
        sweep += math.copysign(2 * math.pi * (abs(turns) - 1), turns)
        r0, r1 = math.hypot(*first), math.hypot(*last)
        self.off_radius = max(self.off_radius, abs(r0 - r1))
        n = max(4, math.ceil(abs(sweep) / math.sqrt(8 * SAGITTA / max(r0, r1, 1e-3))))
        points = []
        for k in range(n + 1):
            s, a = k / n, begin + sweep * k / n
            r = r0 + s * (r1 - r0)
            p = at + s * (to - at)
            p[plane[0]], p[plane[1]] = centre[0] + r * math.cos(a), centre[1] + r * math.sin(a)
            points.append(p)
        points[0], points[-1] = at, to
        return points

    def distances(self, points):
        """Of each point: to the nearest piece, and the tolerance there. Pieces are looked through by boxes of many."""
        lot = 32
        direction = self.end - self.begin
        squared = np.maximum(np.sum(direction**2, axis=1), 1e-30)
        lots = range(0, len(self.begin), lot)
        low = np.array([np.minimum(self.begin[i:i + lot], self.end[i:i + lot]).min(axis=0) for i in lots])
        high = np.array([np.maximum(self.begin[i:i + lot], self.end[i:i + lot]).max(axis=0) for i in lots])
        nearest, which = np.full(len(points), np.inf), np.zeros(len(points), dtype=int)
        # What is certainly that near: the distance to some piece of the nearest box.
        for block in range(0, len(points), 512):
            p = points[block:block + 512]
            outside = np.maximum(0, np.maximum(low[None] - p[:, None], p[:, None] - high[None]))
            to_box = np.sqrt(np.sum(outside**2, axis=2))
            far = np.maximum(np.abs(low[None] - p[:, None]), np.abs(high[None] - p[:, None]))
            certain = np.min(np.sqrt(np.sum(far**2, axis=2)), axis=1)
            for k in np.nonzero(np.any(to_box <= certain[:, None], axis=0))[0]:
                rows = np.nonzero(to_box[:, k] <= np.minimum(certain, nearest[block:block + 512]))[0]
                if len(rows) == 0:
                    continue
                i = slice(k * lot, k * lot + lot)
                away = p[rows, None] - self.begin[None, i]
                share = np.clip(np.sum(away * direction[None, i], axis=2) / squared[None, i], 0, 1)
                d = np.linalg.norm(away - share[..., None] * direction[None, i], axis=2)
                best = np.argmin(d, axis=1)
                d = d[np.arange(len(rows)), best]
                closer = d < nearest[block + rows]
                nearest[block + rows[closer]] = d[closer]
                which[block + rows[closer]] = k * lot + best[closer]
        around = [self.tolerance[np.clip(which + k, 0, len(self.tolerance) - 1)] for k in (-1, 0, 1)]
        return nearest, np.array(around)
