"""The bench's cube in MuJoCo, as a flex of tetrahedra.

    python mujoco_cube.py target/bench-beside/cube.json [--check]

Each node that moves is a body with three slides and the lumped mass of the file; nodes that are held are vertices of the
world. Loads are generalised forces of the slides (`qfrc_applied`), constant in the world's axes. Contact, constraints and
gravity are off. The law is MuJoCo's Saint Venant-Kirchhoff with `young` and `poisson`.
"""

import platform
import time
import warnings

import mujoco
import numpy

import cube as bench

INTEGRATORS = {
    "Euler": mujoco.mjtIntegrator.mjINT_EULER,
    "RK4": mujoco.mjtIntegrator.mjINT_RK4,
    "discrete": mujoco.mjtIntegrator.mjINT_DISCRETE,
}

DISABLED = (
    mujoco.mjtDisableBit.mjDSBL_CONTACT,
    mujoco.mjtDisableBit.mjDSBL_CONSTRAINT,
    # A failed run is to be seen, not to begin anew.
    mujoco.mjtDisableBit.mjDSBL_AUTORESET,
)

FAILURES = (
    mujoco.mjtWarning.mjWARN_BADQPOS,
    mujoco.mjtWarning.mjWARN_BADQVEL,
    mujoco.mjtWarning.mjWARN_BADQACC,
)


# Runs that fail are looked at by their warnings; the text of each would go to a file of its own.
mujoco.set_mju_user_warning(lambda _: None)


class Program:
    NAME = "mujoco"
    METHODS = (
        bench.Method("Euler", "stvk"),
        bench.Method("RK4", "stvk"),
        bench.Method("discrete", "stvk", dt=0.01),
    )

    def __init__(self, cube):
        self.cube = cube
        self.made = {}

    def versions(self):
        return {"MuJoCo": mujoco.__version__, "numpy": numpy.__version__, "Python": platform.python_version()}

    def model(self, integrator):
        cube = self.cube
        spec = mujoco.MjSpec()
        spec.option.gravity = [0, 0, 0]
        spec.option.integrator = INTEGRATORS[integrator]
        spec.option.disableflags = int(sum(DISABLED))
        bodies, places = [], []
        for node, (point, mass, is_free) in enumerate(zip(cube.points, cube.mass, cube.is_free)):
            if not is_free:
                bodies.append("world")
                places.extend(point)
                continue
            body = spec.worldbody.add_body(name=f"node-{node}", pos=point)
            body.mass, body.explicitinertial = mass, True
            # A slide does not turn, so that no number but the mass has a meaning.
            body.inertia = [mass * 1e-6] * 3
            for axis in numpy.eye(3):
                body.add_joint(type=mujoco.mjtJoint.mjJNT_SLIDE, axis=axis)
            bodies.append(body.name)
            places.extend([0.0] * 3)
        flex = spec.add_flex(
            name="cube",
            dim=3,
            radius=1e-4,
            young=cube.youngs_modulus,
            poisson=cube.poissons_ratio,
            contype=0,
            conaffinity=0,
            selfcollide=mujoco.mjtFlexSelf.mjFLEXSELF_NONE,
        )
        flex.vertbody, flex.vert = bodies, places
        flex.elem = cube.tets.ravel().tolist()
        with warnings.catch_warnings():
            # It says "no passive forces" of any flex without damping; --check shows that they are there.
            warnings.filterwarnings("ignore", message=".*no equality constraints or passive forces.*")
            model = spec.compile()
        slides = [model.body(f"node-{node}").dofadr[0] for node in numpy.flatnonzero(cube.is_free)]
        return model, mujoco.MjData(model), numpy.array(slides)[:, None] + numpy.arange(3)

    def run(self, method, forces, dt, steps):
        if method.name not in self.made:
            self.made[method.name] = self.model(method.name)
        model, data, slides = self.made[method.name]
        free = self.cube.is_free
        model.opt.timestep = dt
        mujoco.mj_resetData(model, data)
        data.qfrc_applied[slides] = forces[free]
        instants = self.cube.instants
        motion = numpy.zeros((instants, *self.cube.points.shape))
        spent = 0.0
        for instant in motion:
            before = time.process_time()
            mujoco.mj_step(model, data, nstep=steps // instants)
            spent += time.process_time() - before
            # A slide's place in qpos is that of its velocity: no other joint is there.
            instant[free] = data.qpos[slides]
        failed = any(data.warning[failure].number for failure in FAILURES)
        return spent, None if failed or not numpy.isfinite(motion).all() else motion


if __name__ == "__main__":
    bench.main(Program, __doc__.splitlines()[0])
