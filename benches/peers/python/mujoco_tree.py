"""A chain in MuJoCo as an articulated tree of hinges, whose rods cannot change their length. The error is in the angles
of the hinges, so only the energy shows it. Chains only.

    substeps     steps a frame
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
    parent, at = spec.worldbody, starts[0]
    for i in range(1, len(starts)):
        # A body begins at its hinge and has one particle at its end. MuJoCo needs a moment of inertia: a millionth of m
        # r² changes the motion less than the steps do.
        rod = starts[i] - starts[i - 1]
        pos = starts[0] if i == 1 else starts[i - 1] - at
        inertia = [workload.masses[i] * 1e-6 * (rod @ rod)] * 3
        parent = parent.add_body(pos=pos, mass=workload.masses[i], ipos=rod, inertia=inertia, explicitinertial=True)
        parent.add_joint(type=mujoco.mjtJoint.mjJNT_HINGE, axis=[0, 0, 1])
        at = starts[i - 1]
    model = spec.compile()
    data = mujoco.MjData(model)

    def step() -> None:
        mujoco.mj_step(model, data, nstep=substeps)

    def read() -> tuple[np.ndarray, np.ndarray]:
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        positions, velocities = starts.copy(), np.zeros_like(starts)
        positions[1:] = data.xipos[1:]
        spatial = np.zeros(6)
        for body in range(1, model.nbody):
            mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_BODY, body, spatial, 0)
            velocities[body] = spatial[3:]
        d = workload.dimension
        return positions[:, :d], velocities[:, :d]

    return by_frames(step, read)


main(begin)
