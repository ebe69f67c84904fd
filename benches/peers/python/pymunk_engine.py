"""pymunk (Chipmunk2D): point masses and pin joints, sequential impulses.

    substeps     steps a frame
    iterations   of the solver a step (its default is 10)
    bias         part of a joint's error that remains after a second; the default is 0.9^60, the least 0
"""

import numpy as np
import pymunk
from adapter import Simulate, Workload, by_frames, main


def begin(workload: Workload, setting: dict[str, str]) -> Simulate:
    space = pymunk.Space()
    space.gravity = tuple(workload.gravity)
    space.iterations = int(setting["iterations"])
    bodies = []
    for position, mass, fixed in zip(workload.positions, workload.masses, workload.fixed):
        # Pins act on the centre, so no body turns and the moment of inertia has no effect.
        body = pymunk.Body(mass, float("inf"), pymunk.Body.STATIC if fixed else pymunk.Body.DYNAMIC)
        body.position = tuple(position)
        bodies.append(body)
        space.add(body)
    for a, b in workload.ends:
        joint = pymunk.PinJoint(bodies[a], bodies[b])
        if "bias" in setting:
            joint.error_bias = float(setting["bias"])
        space.add(joint)
    substeps = int(setting["substeps"])

    def step() -> None:
        for _ in range(substeps):
            space.step(workload.frame / substeps)

    def read() -> tuple[np.ndarray, np.ndarray]:
        return np.array([b.position for b in bodies]), np.array([b.velocity for b in bodies])

    return by_frames(step, read)


main(begin)
