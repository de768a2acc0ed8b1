"""The bounds that `contour check` prints for faults of feedback and torque, as numbers."""
import re


class PrintedBounds:
    """What `contour check` prints under "Faults of feedback and torque", and its stopping bounds."""

    TITLE = "Faults of feedback and torque"

    def __init__(self, text):
        self.bounds = {}  # (axis, row): [(feed, departure in mm, time in ms)]
        feeds, axis, row = [], None, None
        _, _, table = text.partition(self.TITLE)
        for line in table.splitlines()[1:]:
            if line and not line.startswith(" "):
                break  # the next section
            cells = re.split(r"\s{2,}", line.strip())
            numbers = [self._number(cell) for cell in cells[1:]]
            if cells[0].startswith("axis ") and len(cells) > 1:
                axis, feeds = cells[0].removeprefix("axis "), numbers
            elif axis and cells[0] == "within" and row:
                self.bounds[row] = [(f, d, t) for (f, d, _), t in zip(self.bounds[row], numbers)]
            elif axis and len(numbers) == len(feeds) and None not in numbers:
                row = (axis, cells[0])
                self.bounds[row] = [(f, d, None) for f, d in zip(feeds, numbers)]
            elif axis and cells[0].startswith("worst"):
                axis = row = None

    @staticmethod
    def _number(cell):
        if cell == "rest":
            return 0.0
        if cell in ("not seen", "-"):
            return float("inf")
        match = re.match(r"(\d[\d.]*(?:e-?\d+)?)( m|$)", cell)
        return float(match.group(1)) if match else None

    def of(self, axis, row, feed_mm_s):
        """Departure [mm] and time [ms] at a feed; between two of the table's columns the larger of theirs. None: not printed."""
        columns = self.bounds.get((axis, row))
        if not columns:
            return None
        below = max((c for c in columns if c[0] <= feed_mm_s + 1e-9), key=lambda c: c[0])
        above = min((c for c in columns if c[0] >= feed_mm_s - 1e-9), key=lambda c: c[0], default=columns[-1])
        return max(below[1], above[1]), max(below[2] or 0.0, above[2] or 0.0) or None
