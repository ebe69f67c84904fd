"""MuJoCo, every particle a body of its own on slides, every rod a spatial tendon held at its length by an equality.

    substeps     steps a frame
    stiff        1: the shortest time constant that MuJoCo allows (two steps) and impedance 0.9999, else its defaults
    integrator   Euler, implicitfast or RK4
"""

import mujoco
import numpy as np
from adapter import Simulate, Workload, by_frames, main


def begin(workload: Workload, setting: dict[str, str]) -> Simulate:
    substeps = int(setting["substeps"])
    spec = mujoco.MjSpec()
    spec.option.timestep = workload.frame / substeps
    spec.option.gravity = workload.in_space(workload.gravity)
    spec.option.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{setting['integrator'].upper()}")
    # Without the second flag, MuJoCo would restart a motion that diverged, without an error.
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_AUTORESET
    starts = workload.in_space(workload.positions)
    for i, (start, mass, fixed) in enumerate(zip(starts, workload.masses, workload.fixed)):
        inertia = [mass * 1e-6] * 3
        body = spec.worldbody.add_body(name=f"p{i}", pos=start, mass=mass, inertia=inertia, explicitinertial=True)
        body.add_site(name=f"s{i}")
        for axis in np.eye(3)[: 0 if fixed else workload.dimension]:
            body.add_joint(type=mujoco.mjtJoint.mjJNT_SLIDE, axis=axis)
    for i, ((a, b), length) in enumerate(zip(workload.ends, workload.lengths)):
        tendon = spec.add_tendon(name=f"t{i}")
        tendon.wrap_site(f"s{a}")
        tendon.wrap_site(f"s{b}")
        # A tendon has the length of its rod at the start; the equality keeps it at that length.
        equality = spec.add_equality(type=mujoco.mjtEq.mjEQ_TENDON, name1=f"t{i}")
        if setting["stiff"] == "1":
            equality.solref = [2 * spec.option.timestep, 1.0]
            equality.solimp = [0.9999, 0.9999, 0.001, 0.5, 2.0]
    model = spec.compile()
    data = mujoco.MjData(model)
    free = ~workload.fixed

    def step() -> None:
        mujoco.mj_step(model, data, nstep=substeps)

    def read() -> tuple[np.ndarray, np.ndarray]:
        positions, velocities = workload.positions.copy(), np.zeros_like(workload.positions)
        positions[free] += data.qpos.reshape(-1, workload.dimension)
        velocities[free] = data.qvel.reshape(-1, workload.dimension)
        return positions, velocities

    return by_frames(step, read)


main(begin)
