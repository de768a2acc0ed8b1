"""The steps of a batch by fast_steps.c: compiled at first use, kept in build/strangers. Where there is no compiler, numpy goes on alone."""
import ctypes
import hashlib
import shutil
import subprocess
from pathlib import Path

import numpy as np

LAWS = ("LuGre", "Dahl", "GeneralisedMaxwellSlip")
OF_AXIS = ("rated", "friction_on_load", "Fc", "Fs", "vs", "stribeck_exponent", "sigma0", "sigma1", "fast_rad_s")
OF_EFFECT = ("ratio", "saturation", "cogging", "cogging_order", "phase", "vibration", "vibration_Hz", "gap", "ripple", "ripple_order",
             "asymmetry", "soft_share", "soft_ratio", "asymmetry_viscous", "square_drag", "reading", "reading_order")
OF_TICK = ("level_factor", "viscous", "outside")
NUMBERS = OF_AXIS + OF_EFFECT + OF_TICK + ("keep", "kept_mean", "k", "d")
STATE = ("torque", "last_acceleration", "soft", "heat")
OF_MODEL = ("motor_inertia", "load_inertia", "stiffness", "lag_s", "Fc", "Fs", "vs", "stribeck_exponent", "sigma0", "sigma1", "sigma2")
IN_MODEL = ("d", "keep", "share", "q1", "w1", "q2", "w2", "torque", "acceleration", "too_many")


def compiled():
    enum = lambda letter, names: "enum {" + ", ".join(f"{letter}_{name}" for name in names) + "};\n"
    text = enum("P", NUMBERS + ("a",)) + "enum { P_b = P_a + 16 };\n" + enum("S", STATE) + enum("M", OF_MODEL + IN_MODEL)
    text += Path(__file__).with_suffix(".c").read_text(encoding="utf-8")
    library = Path(__file__).parents[2] / "build" / "strangers" / f"{hashlib.sha256(text.encode()).hexdigest()[:16]}.so"
    if not library.exists():
        if shutil.which("cc") is None:
            return None
        library.parent.mkdir(parents=True, exist_ok=True)
        fresh = library.with_suffix(f".{np.random.SeedSequence().entropy}")
        subprocess.run(["cc", "-O2", "-shared", "-fPIC", "-ffp-contract=off", "-x", "c", "-", "-o", fresh, "-lm"], input=text, text=True,
                       check=True)
        fresh.replace(library)
    return ctypes.CDLL(str(library)).steps


def pointer(array):
    return None if array is None else array.ctypes.data_as(ctypes.c_void_p)


def law_of(owner, table):
    law = owner.law if owner else None
    return pointer(table), pointer(getattr(law, "stiffness", None)), pointer(law.z if law else None)


class FastSteps:
    """Of a Batch: its numbers and state in tables; `tick` moves it on and hands back what others look at."""

    def __init__(self, batch, function, step_s):
        self.batch, self.function, self.h, self.n = batch, function, step_s, batch.n
        self.law = LAWS.index(type(batch.law).__name__)
        lag = batch.a["lag_s"] + batch.e["more_lag_s"]
        keep = np.exp(-step_s / lag)
        rows = {**batch.e, **batch.a, "keep": keep, "kept_mean": (1.0 - keep) * lag / step_s}
        self.p = np.zeros((len(NUMBERS) + 24, self.n))
        for name in NUMBERS:
            self.p[NUMBERS.index(name)] = rows.get(name, 0.0)
        self.s, self.m = np.zeros((len(STATE), self.n)), [self.of_model(m) for m in (batch.model, batch.twin)]
        self.mechanics()

    def of_model(self, model):
        if model is None:
            return None
        of = {**vars(model), **model.a}
        return np.stack([np.broadcast_to(of[name], self.n) for name in OF_MODEL + IN_MODEL]).astype(float)

    def mechanics(self):
        b = self.batch
        self.p[NUMBERS.index("k")], self.p[NUMBERS.index("d")] = b.k, b.d
        self.p[len(NUMBERS):] = np.concatenate([b.ad.reshape(-1, 16), b.bd.reshape(-1, 8)], 1).T

    def tick(self, t, commands, noise, stated):
        b = self.batch
        for name in OF_TICK:
            self.p[NUMBERS.index(name)] = getattr(b, name)
        b.x = np.ascontiguousarray(b.x)
        looking = [x for model, table in zip((b.model, b.twin), self.m) for x in law_of(model, table)]
        self.function(self.law, self.n, len(commands), ctypes.c_double(self.h), ctypes.c_double(t), pointer(self.p), pointer(self.s),
                      pointer(b.x), *law_of(b, None)[1:], pointer(commands), pointer(noise), *looking, pointer(stated))
        b.heat = self.s[STATE.index("heat")]
        for model, table in zip((b.model, b.twin), self.m):
            if model:
                model.q2, model.too_many = (table[len(OF_MODEL) + IN_MODEL.index(name)] for name in ("q2", "too_many"))
