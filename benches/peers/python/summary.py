"""The cheapest setting of each engine that keeps an error, from a table that compare.py wrote.

    summary.py PEERS.csv
"""

import csv
import sys

BOUNDS = (1e-2, 1e-3, 1e-6, 1e-9)
"""Of the worst relative length error over the run."""

ENERGY = 0.01
"""Of the largest kinetic energy: a motion that has lost or gained more at the end is another motion."""


def cheapest(rows: list[dict[str, str]], bound: float, energy: float) -> float | None:
    """The least CPU time per simulated second [ms] within both bounds."""
    costs = [
        float(row["cpu_ms_per_simulated_s"])
        for row in rows
        if not row["ended"] and float(row["worst_length_error"]) <= bound and abs(float(row["energy_error"])) <= energy
    ]
    return min(costs, default=None)


def shown(cost: float | None) -> str:
    return "–" if cost is None else f"{cost:.3g}"


def main() -> None:
    with open(sys.argv[1], newline="") as file:
        rows = list(csv.DictReader(file))
    by_workload: dict[str, dict[str, list[dict[str, str]]]] = {}
    for row in rows:
        by_workload.setdefault(row["workload"], {}).setdefault(row["engine"], []).append(row)
    print("Least CPU ms per simulated second at which the worst length error stays below a bound;")
    print(f"in brackets with the energy error at the end below {ENERGY:.0%} of the largest kinetic energy too; – never.")
    for workload, engines in by_workload.items():
        print(f"\n{workload:<18}" + "".join(f"{f'≤ {bound:.0e}':>20}" for bound in BOUNDS))
        for engine, of_engine in engines.items():
            cells = (f"{shown(cheapest(of_engine, b, float('inf')))} ({shown(cheapest(of_engine, b, ENERGY))})" for b in BOUNDS)
            print(f"{engine:<18}" + "".join(f"{cell:>20}" for cell in cells))


main()
