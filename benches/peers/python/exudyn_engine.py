"""Exudyn: mass points and distance constraints, generalized-α with sparse direct solves.

    substeps     steps a frame
    radius       the spectral radius at infinity: its default of 0.9 fails on chains, 0.5 damps the fastest motions more
"""

from collections.abc import Callable

import exudyn as exu
import numpy as np
from adapter import Recorder, Simulate, Workload, main
from exudyn.itemInterface import (
    Force,
    MarkerNodePosition,
    MassPoint,
    NodePoint,
    NodePointGround,
    ObjectConnectorDistance,
)


def begin(workload: Workload, setting: dict[str, str]) -> Simulate:
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    gravity = workload.in_space(workload.gravity)
    markers = []
    for start, mass, fixed in zip(workload.in_space(workload.positions), workload.masses, workload.fixed):
        node = mbs.AddNode((NodePointGround if fixed else NodePoint)(referenceCoordinates=list(start)))
        marker = mbs.AddMarker(MarkerNodePosition(nodeNumber=node))
        if not fixed:
            mbs.AddObject(MassPoint(physicsMass=mass, nodeNumber=node))
            mbs.AddLoad(Force(markerNumber=marker, loadVector=list(mass * gravity)))
        markers.append(marker)
    for (a, b), length in zip(workload.ends, workload.lengths):
        mbs.AddObject(ObjectConnectorDistance(markerNumbers=[markers[a], markers[b]], distance=length))
    mbs.Assemble()
    settings = exu.SimulationSettings()
    integration = settings.timeIntegration
    integration.generalizedAlpha.spectralRadius = float(setting["radius"])
    integration.endTime = workload.frames * workload.frame
    integration.numberOfSteps = workload.frames * int(setting["substeps"])
    settings.linearSolverType = exu.LinearSolverType.EigenSparse
    settings.solution.file.write = False
    d = workload.dimension

    def coordinates(read: Callable[[], list[float]], start: np.ndarray) -> np.ndarray:
        told = start.copy()
        told[~workload.fixed] += np.array(read()).reshape(-1, 3)[:, :d]
        return told

    def simulate(recorder: Recorder) -> None:
        def read() -> tuple[np.ndarray, np.ndarray]:
            data = mbs.systemData
            positions = coordinates(data.GetODE2Coordinates, workload.positions)
            return positions, coordinates(data.GetODE2Coordinates_t, np.zeros_like(positions))

        def after_step(mbs: exu.MainSystem, time: float) -> bool:
            due = time > (recorder.count() + 1) * workload.frame - 1e-9
            return recorder.frame(read) if due else True

        mbs.SetPostStepUserFunction(after_step)
        mbs.SolveDynamic(settings, showHints=False, showCausingItems=False)

    return simulate


main(begin)
