"""Work and precision: the cost of every engine against its largest length error, from a table of compare.py.

    plot.py PEERS.csv PICTURE.svg

Hollow marks: the energy at the end is off by more than ENERGY of the largest kinetic energy. Runs that ended early are
left out.
"""

import csv
import sys

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
from matplotlib.lines import Line2D

ENERGY = 0.01

FLOOR = 1e-15
"""Errors below the roundoff of a length are drawn here."""

PANELS = {
    "chain100": "chain100: 100 links, released from horizontal",
    "heavy1000": "heavy1000: its last mass 1000 times heavier",
    "net32": "net32: 32 × 32 particles, planar",
}

# A colour and a mark for each engine. The lines of qhat, one for each integrator, are thick.
STYLES = {
    "qhat": ("#0b3d91", "o", "-"),
    "RATTLE, Eigen": ("#b2182b", "s", "-"),
    "XPBD, C++": ("#e08214", "^", "--"),
    "MuJoCo tree": ("#1b7837", "D", "-"),
    "MuJoCo particles": ("#5aae61", "d", "--"),
    "Rapier tree": ("#762a83", "P", "-"),
    "Rapier hinges": ("#9970ab", "v", "--"),
    "Rapier springs": ("#c2a5cf", "X", "--"),
    "pymunk": ("#8c510a", "<", ":"),
    "OpenMM": ("#01918f", ">", ":"),
    "Exudyn": ("#4d4d4d", "h", "-"),
}


Point = tuple[float, float, bool]
"""Cost, error, and whether the energy error is small."""


def lines(rows: list[dict[str, str]], workload: str, engine: str) -> list[list[Point]]:
    """The lines of an engine, each from its cheapest run to its most expensive."""
    found: dict[str, list[Point]] = {}
    for row in rows:
        name = row["engine"]
        wanted = "qhat" if name.startswith("qhat ") else name
        if row["workload"] == workload and not row["ended"] and engine == wanted:
            error = max(float(row["worst_length_error"]), FLOOR)
            good = abs(float(row["energy_error"])) <= ENERGY
            found.setdefault(name, []).append((float(row["cpu_ms_per_simulated_s"]), error, good))
    return [sorted(points) for points in found.values()]


def panel(axes: plt.Axes, rows: list[dict[str, str]], workload: str) -> None:
    for engine, (colour, mark, dashes) in STYLES.items():
        thick, size, front = (2.4, 7, 3) if engine == "qhat" else (1.3, 6, 2)
        for line in lines(rows, workload, engine):
            axes.plot([p[0] for p in line], [p[1] for p in line], dashes, color=colour, linewidth=thick, zorder=front)
            for cost, error, good in line:
                inside = colour if good else "white"
                axes.plot(cost, error, mark, color=colour, markersize=size, markerfacecolor=inside, zorder=front + 2)
    axes.axvline(1000, color="#bbbbbb", linewidth=1, zorder=1)
    axes.text(1000, 3e3, "real time ", ha="right", va="top", color="#777777", fontsize=8)
    axes.text(0.02, 0.02, "better: left and down", transform=axes.transAxes, color="#777777", fontsize=8)
    axes.set(xscale="log", yscale="log", ylim=(FLOOR / 10, 1e4), xlabel="CPU ms per simulated second")
    axes.set_title(PANELS[workload], fontsize=10)
    axes.grid(True, which="major", color="#e6e6e6", linewidth=0.8)
    axes.set_axisbelow(True)


def entry(engine: str) -> Line2D:
    """The line of the engine in the legend."""
    colour, mark, dashes = STYLES[engine]
    return Line2D([], [], color=colour, marker=mark, linestyle=dashes, label=engine)


def main() -> None:
    table, picture = sys.argv[1:]
    with open(table, newline="") as file:
        rows = list(csv.DictReader(file))
    plt.rcParams.update({"font.size": 9, "font.family": "DejaVu Sans", "svg.hashsalt": "qhat"})
    figure, panels = plt.subplots(1, len(PANELS), figsize=(13, 5.4), sharey=True)
    for axes, workload in zip(panels, PANELS):
        panel(axes, rows, workload)
    panels[0].set_ylabel("worst relative length error over 2 s")
    handles = [entry(engine) for engine in STYLES if any(lines(rows, workload, engine) for workload in PANELS)]
    hollow = Line2D([], [], color="#555555", marker="o", markerfacecolor="white", linestyle="")
    hollow.set_label(f"hollow: energy off by > {100 * ENERGY:.0f} %")
    figure.legend(handles=[*handles, hollow], loc="lower center", ncols=6, frameon=False, fontsize=9)
    figure.tight_layout(rect=(0, 0.11, 1, 1))
    # Without a date, so that the same table gives the same file.
    figure.savefig(picture, metadata={"Date": None}, facecolor="white")


main()
