"""The motor's encoder: counts of the angle with noise below a count, from where it was switched on if it is incremental; and its
faults."""
import math
import random


class Encoder:
    def __init__(self, counts_per_turn, absolute, noise_counts, seed, offset_turns=0.0):
        self.counts_per_turn = counts_per_turn
        self.absolute = absolute
        self.noise_counts = noise_counts
        self._random = random.Random(seed)
        self._offset_counts = offset_turns * counts_per_turn
        self._zero_counts = 0.0
        self._jump_counts = 0.0
        self._frozen = None
        self._flickers = False
        self._reversed_about = None

    def read(self, angle_rad):
        """The count that the drive sees."""
        exact = angle_rad / (2.0 * math.pi) * self.counts_per_turn + self._offset_counts - self._zero_counts
        if self._reversed_about is not None:
            exact = 2.0 * self._reversed_about - exact
        count = math.floor(exact + self._jump_counts + self._random.gauss(0.0, self.noise_counts))
        if self._frozen == "now":
            self._frozen = count
        if self._frozen is None:
            return count
        return self._frozen + (self._random.random() < 0.3 if self._flickers else 0)

    def power_up(self, angle_rad):
        """An incremental encoder counts anew from here."""
        if not self.absolute:
            self._zero_counts = angle_rad / (2.0 * math.pi) * self.counts_per_turn + self._offset_counts

    def freeze(self, flickers=False):
        """Stands still, or goes to and fro by a count."""
        self._frozen, self._flickers = "now", flickers

    def jump(self, counts):
        self._jump_counts += counts

    def reverse(self, angle_rad):
        """From here on it counts the wrong way round."""
        self._reversed_about = (angle_rad / (2.0 * math.pi) * self.counts_per_turn + self._offset_counts - self._zero_counts)

    def mend(self):
        """Freezing and reversing end; a jump stays, as a slipped disc does."""
        self._frozen = None
        self._reversed_about = None
