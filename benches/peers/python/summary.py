"""The cheapest setting of each engine that keeps an error bound, from a table of compare.py.

    summary.py PEERS.csv
"""

import csv
import math
import sys
from collections.abc import Iterable

BOUNDS = (1e-2, 1e-3, 1e-6, 1e-9)
"""Bounds on the largest relative length error of a run."""

WRITTEN_HERE = ("RATTLE", "XPBD")
"""Methods written in C++ for the comparison, not engines that people install."""

ENERGY = 0.01
"""Bound on the energy error at the end, relative to the largest kinetic energy: above it the motion is another one."""


def cheapest(rows: list[dict[str, str]], bound: float, energy: float) -> float | None:
    """The least CPU time per simulated second [ms] within both bounds."""
    costs = [
        float(row["cpu_ms_per_simulated_s"])
        for row in rows
        if not row["ended"] and float(row["worst_length_error"]) <= bound and abs(float(row["energy_error"])) <= energy
    ]
    return min(costs, default=None)


def ratios(engines: dict[str, list[dict[str, str]]]) -> str:
    """The factor by which qhat is cheaper than other engines at small errors.

    The others are the engines that people install, at a loose length error, with any energy and with an energy that is
    about right, and RATTLE in C++ at the same tight errors.
    """
    tight = within(engines, 1e-9, 1e-4)
    own = least((name, cost) for name, cost in tight.items() if name.startswith("qhat"))
    if not own:
        return "qhat: never"
    others = {name: rows for name, rows in engines.items() if not name.startswith(("qhat", *WRITTEN_HERE))}
    rivals = [
        least(within(others, 1e-3, math.inf).items()),
        least(within(others, 1e-3, ENERGY).items()),
        least((name, cost) for name, cost in tight.items() if name.startswith("RATTLE")),
    ]
    cells = [f"{rival[1] / own[1]:.3g} × ({rival[0]})" if rival else "–" for rival in rivals]
    return f"{f'{own[0]} {own[1]:.3g} ms':<24}" + "".join(f"{cell:<28}" for cell in cells)


def within(engines: dict[str, list[dict[str, str]]], bound: float, energy: float) -> dict[str, float | None]:
    return {name: cheapest(rows, bound, energy) for name, rows in engines.items()}


def least(costs: Iterable[tuple[str, float | None]]) -> tuple[str, float] | None:
    known = [(cost, name) for name, cost in costs if cost is not None]
    return min(known)[::-1] if known else None


def shown(cost: float | None) -> str:
    return "–" if cost is None else f"{cost:.3g}"


def main() -> None:
    with open(sys.argv[1], newline="") as file:
        rows = list(csv.DictReader(file))
    by_workload: dict[str, dict[str, list[dict[str, str]]]] = {}
    for row in rows:
        by_workload.setdefault(row["workload"], {}).setdefault(row["engine"], []).append(row)
    print("Least CPU ms per simulated second at which the worst length error stays below a bound;")
    print(f"in brackets with the energy error at the end below {ENERGY:.0%} of the largest kinetic energy; – never.")
    for workload, engines in by_workload.items():
        print(f"\n{workload:<18}" + "".join(f"{f'≤ {bound:.0e}':>20}" for bound in BOUNDS))
        for engine, of_engine in engines.items():
            least_of = [(cheapest(of_engine, b, math.inf), cheapest(of_engine, b, ENERGY)) for b in BOUNDS]
            cells = (f"{shown(any_energy)} ({shown(right)})" for any_energy, right in least_of)
            print(f"{engine:<18}" + "".join(f"{cell:>20}" for cell in cells))
    print("\nHow many times cheaper qhat is, at ≤ 1e-9 in length and ≤ 1e-4 in energy, than the cheapest engine that")
    print(f"people install at ≤ 1e-3 in length, with any energy and with ≤ {ENERGY:.0%}, and than RATTLE on Eigen at")
    print("qhat's own errors:\n")
    print(f"{'':<11}{'qhat':<24}{'any energy':<28}{f'energy ≤ {ENERGY:.0%}':<28}RATTLE")
    for workload, engines in by_workload.items():
        print(f"{workload:<10} {ratios(engines)}")


main()
