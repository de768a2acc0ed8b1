"""When the cycle woke, and when its frames were sent, after the grid point."""
import numpy as np

import style

STAMPS = (("wakeup_late_us", "woken", style.QUIET), ("received_us", "feedback read", style.WINDOW),
          ("stepped_us", "computed", style.PLAIN), ("sent_us", "frames sent", style.COMPENSATED))


def can_draw(run):
    # In virtual time all stamps are zero.
    return run.has("sent_us") and bool(np.any(run.column("sent_us") > 0))


def draw(pyplot, run):
    figure, axes = pyplot.subplots(figsize=(9.5, 4.6))
    columns = {name: run.column(name) for name, _, _ in STAMPS}
    largest = max(float(np.nanmax(values)) for values in columns.values())
    smallest = min(float(np.nanmin(values)) for values in columns.values())
    bins = np.geomspace(max(0.8 * smallest, 1.0), max(1.1 * largest, 10.0), 70)
    for name, title, colour in STAMPS:
        values = np.clip(columns[name], bins[0], None)
        middle, worst = np.percentile(values, 50), values.max()
        axes.hist(values, bins, histtype="step", linewidth=1.5, color=colour,
                  label=f"{title}: median {middle:.3g}, worst {worst:.4g} µs")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("after the grid point (µs)")
    axes.set_ylabel("cycles")
    axes.legend(loc="upper right")
    late, stale = run.metrics["late_cycles"], run.metrics["stale_cycles"]
    figure.suptitle(f"{run.name}, {style.label(run)}: {len(columns['sent_us'])} cycles of "
                    f"{run.metrics['cycle_us']} µs, {late} late, {stale} with stale feedback")
    return figure
