"""Friction of the peer's axis: stop elements in parallel, each a spring that yields. Written for this plant alone; it shares neither
code nor law with the product, whose filters believe in a bristle that relaxes (LuGre).

Below its yield an element is a pure spring, so pre-sliding is elastic and a hysteresis closes exactly; what it yields at falls
with speed (Stribeck) and depends on direction.
"""
import math


class StopFriction:
    """force(velocity, step) in the unit of the yields; `elements` are (share of the yield, stiffness)."""

    def __init__(self, coulomb_plus, coulomb_minus, static_over_coulomb, stribeck_velocity, viscous, elements, damping):
        if abs(sum(share for share, _ in elements) - 1.0) > 1e-9:
            raise ValueError("the shares of the yield must add up to 1")
        self.coulomb = (coulomb_plus, coulomb_minus)
        self.excess = static_over_coulomb - 1.0
        self.stribeck_velocity = stribeck_velocity
        self.viscous = viscous
        self.shares = [share for share, _ in elements]
        self.stiffnesses = [float(stiffness) for _, stiffness in elements]
        self.damping = damping
        self.springs = [0.0] * len(elements)

    def force(self, velocity, step_s):
        """The force against the motion at this velocity; moves the springs on by one step."""
        ratio = velocity / self.stribeck_velocity
        scale = 1.0 + self.excess / (1.0 + ratio * ratio)
        plus, minus = self.coulomb[0] * scale, -self.coulomb[1] * scale
        total, stuck = 0.0, 0.0
        travel = velocity * step_s
        springs = self.springs
        for i, share in enumerate(self.shares):
            spring = springs[i] + self.stiffnesses[i] * travel
            if spring > share * plus:
                spring = share * plus
            elif spring < share * minus:
                spring = share * minus
            else:
                stuck += share
            springs[i] = spring
            total += spring
        return total + (self.viscous + self.damping * stuck) * velocity

    def breakaway_travel(self):
        """Travel from the middle of stiction until all elements yield, upwards."""
        limit = self.coulomb[0] * (1.0 + self.excess)
        return max(share * limit / stiffness for share, stiffness in zip(self.shares, self.stiffnesses))

    def stored_energy(self):
        return math.fsum(0.5 * spring * spring / stiffness for spring, stiffness in zip(self.springs, self.stiffnesses))
