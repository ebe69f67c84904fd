"""Shared by the engines in Python: the workload, the frame loop with its clock, the trajectory.

    ENGINE.py WORKLOAD.json LIMIT OUTPUT key=value …

prints the CPU seconds of the steps alone and the reason of an early end. OUTPUT gets positions [m] and velocities
[m/s] of every frame as little-endian f64 (crates/qhat-bench/src/trajectory.rs reads it).
"""

import json
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

Read = Callable[[], tuple[np.ndarray, np.ndarray]]
"""Returns positions [m] and velocities [m/s], (n, d) numbers each."""

Simulate = Callable[["Recorder"], None]
"""Runs a motion from its start and hands each frame to the recorder, until the recorder ends the run."""

RUNS = 3
"""Number of runs if a run takes under a second; the fastest counts."""


class Workload:
    """Particles, rods and gravity of the neutral file."""

    def __init__(self, path: str):
        file = json.loads(Path(path).read_text())
        self.dimension: int = file["dimension"]
        self.gravity = np.array(file["gravity"])
        self.frame: float = file["frame"]
        self.frames: int = file["frames"]
        self.positions = np.array(file["positions"]).reshape(-1, self.dimension)
        self.masses = np.array(file["masses"])
        self.fixed = np.array(file["fixed"], dtype=bool)
        self.ends = np.array(file["ends"]).reshape(-1, 2)
        self.lengths = np.array(file["lengths"])

    def in_space(self, vectors: np.ndarray) -> np.ndarray:
        """The workload in three dimensions; z = 0 for a workload in the plane."""
        return np.pad(vectors, [(0, 0)] * (vectors.ndim - 1) + [(0, 3 - self.dimension)])


class Recorder:
    """Records the frames of a motion. The clock is stopped while it does."""

    def __init__(self, workload: Workload, limit: float):
        self.workload = workload
        self.limit = limit
        self.frames: list[np.ndarray] = []
        self.cpu = 0.0
        self.ended = ""
        self.since = time.process_time()

    def frame(self, read: Read) -> bool:
        """Adds a frame and returns whether to go on. The clock is stopped while `read` is called."""
        self.cpu += time.process_time() - self.since
        positions, velocities = read()
        if np.isfinite(positions).all() and np.isfinite(velocities).all():
            self.frames += [np.array(part, dtype="<f8").ravel() for part in (positions, velocities)]
            self.judge()
        else:
            self.ended = "diverged"
        self.since = time.process_time()
        return not self.ended and self.count() < self.workload.frames

    def count(self) -> int:
        return len(self.frames) // 2

    def judge(self) -> None:
        # After a tenth of the limit it is clear whether a run will take one and a half times the limit.
        estimate = self.cpu / self.count() * self.workload.frames
        if self.count() < self.workload.frames and (
            self.cpu > self.limit or (self.cpu > self.limit / 10 and estimate > 1.5 * self.limit)
        ):
            self.ended = f"too slow: about {estimate:.0f} s of CPU time"


def by_frames(step: Callable[[], None], read: Read) -> Simulate:
    """A motion of an engine that can be stopped at every frame.

    `step` advances by one frame; `read` returns positions and velocities, (n, d) numbers each.
    """

    def simulate(recorder: Recorder) -> None:
        step()
        while recorder.frame(read):
            step()

    return simulate


def main(begin: Callable[[Workload, dict[str, str]], Simulate]) -> None:
    """The command of one engine; `begin` sets a motion up under a setting."""
    path, limit, output, *words = sys.argv[1:]
    workload = Workload(path)
    setting = dict(word.split("=", 1) for word in words)
    total, best = 0.0, float("inf")
    for _ in range(RUNS):
        simulate = begin(workload, setting)
        recorder = Recorder(workload, float(limit))
        try:
            simulate(recorder)
        except Exception as error:  # Any exception of an engine is the result of this run.
            recorder.ended = " ".join(str(error).split())
        if not recorder.ended and recorder.count() < workload.frames:
            recorder.ended = "the engine gave up"
        total, best = total + recorder.cpu, min(best, recorder.cpu)
        if recorder.ended or total > 1.0:
            break
    Path(output).write_bytes(b"".join(frame.tobytes() for frame in recorder.frames))
    print(best, recorder.ended)
