"""Contour error over time, for shapes other than circles."""
import style


def draw(pyplot, runs):
    figure, axes = pyplot.subplots(figsize=(9.5, 4.2))
    for run in runs:
        plain = run.controller == "mpc"
        axes.plot(run.column("path_time_s"), run.column("contour_error_m") * 1e6, "--" if plain else "-",
                  color=style.PLAIN if plain else style.COMPENSATED, linewidth=1.1, label=style.label(run))
    axes.axvspan(0, 1, color=style.QUIET, alpha=0.15, linewidth=0, label="not scored")
    axes.set_xlim(0, None)
    axes.set_xlabel("time since the program began (s)")
    axes.set_ylabel("contour error at the encoder (µm)")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, 1.14), ncol=3)
    figure.suptitle(f"{runs[-1].name}: shortest distance to the path")
    return figure
