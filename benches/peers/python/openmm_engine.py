"""OpenMM: particles with distance constraints (CCMA), with gravity only, on its Reference platform in f64.

    substeps     steps a frame
    tolerance    of the constraints, relative (its default is 1e-5)

Units are nm, ps and u in OpenMM; here they stand for m, s and kg. This has no effect, because only gravity acts.
"""

import numpy as np
import openmm
from adapter import Simulate, Workload, by_frames, main

HELD = 1e12
"""Mass of fixed particles, without weight [kg]: OpenMM allows no constraints on particles that it holds itself."""


def begin(workload: Workload, setting: dict[str, str]) -> Simulate:
    substeps = int(setting["substeps"])
    system = openmm.System()
    weight = openmm.CustomExternalForce("-m*(gx*x+gy*y+gz*z)")
    for name, value in zip(["gx", "gy", "gz"], workload.in_space(workload.gravity)):
        weight.addGlobalParameter(name, value)
    weight.addPerParticleParameter("m")
    for i, (mass, fixed) in enumerate(zip(workload.masses, workload.fixed)):
        system.addParticle(HELD if fixed else mass)
        weight.addParticle(i, [0.0 if fixed else mass])
    system.addForce(weight)
    for (a, b), length in zip(workload.ends, workload.lengths):
        system.addConstraint(int(a), int(b), length)
    integrator = openmm.VerletIntegrator(workload.frame / substeps)
    integrator.setConstraintTolerance(float(setting["tolerance"]))
    context = openmm.Context(system, integrator, openmm.Platform.getPlatformByName("Reference"))
    context.setPositions(workload.in_space(workload.positions))
    context.setVelocities(np.zeros((len(workload.masses), 3)))
    d, held = workload.dimension, {}

    def velocities() -> np.ndarray:
        return context.getState(velocities=True).getVelocities(asNumpy=True)._value[:, :d]

    def step() -> None:
        # Leapfrog velocities lie half a step from the positions. The velocity of a frame is the mean of the two around
        # it, so the first step of the next frame is taken here.
        integrator.step(substeps if not held else substeps - 1)
        held["positions"] = context.getState(positions=True).getPositions(asNumpy=True)._value[:, :d]
        before = velocities()
        integrator.step(1)
        held["velocities"] = (before + velocities()) / 2

    return by_frames(step, lambda: (held["positions"], held["velocities"]))


main(begin)
