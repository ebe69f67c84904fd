"""Runs qhat and every other engine on the same workloads, one after the other, and measures the trajectory of each.

    compare.py BUILT PEERS.csv [WORKLOAD …]

BUILT is the folder of the built engines and of qhat-bench. If workloads are named, only these are run, and no file is
written. A setting that takes more than LIMIT of CPU time is stopped, and the more expensive settings are skipped.
"""

import csv
import math
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

PYTHON = Path(__file__).parent
ROOT = PYTHON.parents[2]
BUILT = Path(sys.argv[1])
QHAT = BUILT / "qhat-bench"

LIMIT = 10.0
"""CPU time of one run [s]: five times real time, and with ten workloads and ten engines a quarter of an hour."""

WORKLOADS = "chain100 chain1000 heavy100 heavy1000 truss20 truss20r truss200 truss200r net32 cloth32".split()

COLUMNS = (
    "workload engine version setting cpu_ms_per_simulated_s frames worst_length_error rms_length_error "
    "energy_error energy_error_max ended"
).split()


@dataclass
class Engine:
    """An engine used in one way, with settings from its default or cheapest to its most expensive."""

    name: str
    version: str
    command: list[str]
    settings: list[str]
    suits: str = ""
    """A pattern of the names of the workloads that the engine can simulate."""


def substeps(*counts: int, then: str = "") -> list[str]:
    return [f"substeps={count} {then}".strip() for count in counts]


def engines() -> list[Engine]:
    """All engines except qhat. Substeps are steps in a frame of 1/60 s."""
    chains, plane, meshes = "chain|heavy", "chain|heavy|truss|net", "truss|net|cloth"
    manifest = (PYTHON.parent / "rapier/Cargo.toml").read_text()
    rapier = re.search(r'rapier2d-f64 = "=(.*)"', manifest)[1]
    macros = Path("/usr/include/eigen3/Eigen/src/Core/util/Macros.h").read_text()
    parts = ("WORLD", "MAJOR", "MINOR")
    eigen = ".".join(re.search(rf"define EIGEN_{part}_VERSION (\d+)", macros)[1] for part in parts)

    def python(file: str) -> list[str]:
        return [sys.executable, str(PYTHON / f"{file}.py")]

    return [
        Engine(
            "pymunk",
            version("pymunk"),
            python("pymunk_engine"),
            substeps(1, 8, 32, 128, then="iterations=10") + substeps(32, 128, 512, then="iterations=50"),
            plane,
        ),
        Engine(
            "Rapier hinges",
            rapier,
            [str(BUILT / "rapier-peer")],
            substeps(1, 8, 32, 128, 256, 512, then="iterations=4 joint=hinge"),
            chains,
        ),
        Engine(
            "Rapier tree",
            rapier,
            [str(BUILT / "rapier-peer")],
            substeps(1, then="iterations=1 joint=tree") + substeps(1, 4, 8, then="iterations=4 joint=tree"),
            chains,
        ),
        Engine(
            "Rapier springs",
            rapier,
            [str(BUILT / "rapier-peer")],
            substeps(1, 8, 32, 64, 128, 512, then="iterations=4 joint=spring"),
            meshes,
        ),
        Engine(
            "MuJoCo particles",
            version("mujoco"),
            python("mujoco_particles"),
            substeps(8, then="integrator=Euler stiff=0") + substeps(8, 32, 128, 512, then="integrator=Euler stiff=1"),
        ),
        Engine(
            "MuJoCo tree",
            version("mujoco"),
            python("mujoco_tree"),
            substeps(8, 64, then="integrator=Euler") + substeps(8, 16, 32, 64, 128, then="integrator=RK4"),
            chains,
        ),
        Engine(
            "OpenMM",
            version("openmm"),
            python("openmm_engine"),
            substeps(8, 32, then="tolerance=1e-5") + substeps(128, 512, then="tolerance=1e-8"),
        ),
        Engine(
            "Exudyn",
            version("exudyn"),
            python("exudyn_engine"),
            substeps(8, then="radius=0.9") + substeps(1, 8, 32, 64, 128, then="radius=0.5"),
        ),
        Engine("XPBD, C++", "", [str(BUILT / "xpbd")], substeps(1, 8, 32, 128, 512, 2048)),
        Engine("RATTLE, Eigen", eigen, [str(BUILT / "rattle")], substeps(8, 16, 32, 64, 128, 256)),
    ]


def qhat(workload: str) -> list[Engine]:
    """An engine for each integrator of qhat, with its tolerances."""
    by_integrator: dict[str, list[str]] = {}
    for line in said([QHAT, "settings", workload]).split():
        integrator, tolerance = line.split(":")
        by_integrator.setdefault(integrator, []).append(tolerance)
    release = re.search(r'^version = "(.*)"', (ROOT / "Cargo.toml").read_text(), re.M)[1]
    return [Engine(f"qhat {name}", release, [], tolerances) for name, tolerances in by_integrator.items()]


def said(command: list[object]) -> str:
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True).stdout


def simulate(command: list[object], folder: Path) -> tuple[float, str]:
    """CPU seconds of the steps, and the reason of an early end."""
    # No other limit covers the work before the first frame or within a frame. This limit is on real time, because a
    # limit of the system on CPU time makes the clock of CPU time advance in steps of 4 ms.
    last = 4 * LIMIT + 30
    words = [str(word) for word in command]
    try:
        run = subprocess.run(words, cwd=folder, capture_output=True, text=True, timeout=last)
    except subprocess.TimeoutExpired:
        return math.nan, f"too slow: ended from outside after {last:.0f} s"
    lines = run.stdout.strip().splitlines()
    try:
        # An engine may have printed warnings of its own before.
        cpu, _, ended = lines[-1].partition(" ")
        return float(cpu), ended
    except (IndexError, ValueError):
        return math.nan, "failed: " + (run.stderr.strip().splitlines() or ["it said nothing"])[-1]


def row(engine: Engine, workload: str, setting: str, folder: Path) -> dict[str, object]:
    """One run and its errors."""
    output = folder / "trajectory.f64"
    output.unlink(missing_ok=True)
    if engine.command:
        command = [*engine.command, folder / f"{workload}.json", LIMIT, output, *setting.split()]
    else:
        command = [QHAT, "trajectory", workload, f"{engine.name.split()[1]}:{setting}", LIMIT, output]
    cpu, ended = simulate(command, folder)
    frames, worst, rms, energy, energy_max = ["0", "nan", "nan", "nan", "nan"]
    if output.exists() and output.stat().st_size > 0:
        frames, worst, rms, energy, energy_max = said([QHAT, "measure", workload, output]).split()
    cost = cpu * 1e3 / (int(frames) / 60) if int(frames) else math.nan
    errors = [worst, rms, energy, energy_max]
    values = [workload, engine.name, engine.version, setting, f"{cost:.4f}", frames, *errors, ended]
    return dict(zip(COLUMNS, values))


def line(told: dict[str, object]) -> str:
    """A row of results, to be read while the other runs continue."""
    columns = ("cpu_ms_per_simulated_s", "worst_length_error", "energy_error")
    cost, worst, energy = (float(told[name]) for name in columns)
    what = f"{told['workload']:<10} {told['engine']:<17} {told['setting']:<42}"
    return f"{what} {cost:>12.3f} {worst:>8.0e} {energy:>8.0e}  {told['ended']}"


def rows(workloads: list[str]) -> Iterator[dict[str, object]]:
    """All runs, one after the other."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        for workload in workloads:
            said([QHAT, "neutral", workload, folder / f"{workload}.json"])
            for engine in [*qhat(workload), *engines()]:
                for setting in engine.settings if re.match(engine.suits, workload) else []:
                    told = row(engine, workload, setting, folder)
                    yield told
                    if engine.command and str(told["ended"]).startswith("too slow"):
                        break


def main() -> None:
    results, wanted = Path(sys.argv[2]), sys.argv[3:]
    errors = f"{'worst':>8} {'energy':>8}"
    print(f"{'workload':<10} {'engine':<17} {'setting':<42} {'CPU ms/sim s':>12} {errors}", flush=True)
    if wanted:
        for told in rows(wanted):
            print(line(told), flush=True)
        return
    # Written beside the table until it is complete, so that an interrupted run keeps the old table.
    unfinished = results.with_suffix(".unfinished")
    with open(unfinished, "w", newline="", buffering=1) as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        for told in rows(WORKLOADS):
            print(line(told), flush=True)
            writer.writerow(told)
    unfinished.replace(results)


main()
