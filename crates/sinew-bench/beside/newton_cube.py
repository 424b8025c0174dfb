"""The bench's cube in Newton, by its SolverSemiImplicit on the CPU.

    python newton_cube.py target/bench-beside/cube.json [--check]

Each node is a particle with the lumped mass of the file; those that are held are not active. Loads are forces on particles,
copied before each step in the place of `State.clear_forces`. There are no triangles, no contacts and no gravity.

The law of its tetrahedra is that of Smith, de Goes and Kim (2018) with the logarithm. Its `k_mu` and `k_lambda` are that
paper's before section 3.4, so that the true moduli are given as 4/3 mu and lambda + 5/6 mu; it then is sinew's
`stable-neo-hookean-log`.
"""

import platform
import sys
import time

import numpy
import warp

import cube as bench

warp.config.quiet = True
import newton  # noqa: E402  (it prints what warp finds while it is imported)


class Program:
    NAME = "newton"
    METHODS = (bench.Method("SemiImplicit", "stable-neo-hookean-log"),)

    def __init__(self, cube):
        self.cube = cube
        lam, mu = cube.lame()
        builder = newton.ModelBuilder(gravity=(0.0, 0.0, 0.0))
        for point, mass, is_free in zip(cube.points, cube.mass, cube.is_free):
            flags = newton.ParticleFlags.ACTIVE if is_free else 0
            builder.add_particle(
                pos=warp.vec3(*point), vel=warp.vec3(0.0), mass=mass if is_free else 0.0, radius=1e-4, flags=flags
            )
        for nodes in cube.tets:
            builder.add_tetrahedron(*map(int, nodes), k_mu=4 / 3 * mu, k_lambda=lam + 5 / 6 * mu, k_damp=0.0)
        self.model = builder.finalize(device="cpu")
        if self.model.tet_count != len(cube.tets):
            sys.exit(f"Newton took {self.model.tet_count} of {len(cube.tets)} tetrahedra")
        # Nothing is to look for contacts.
        self.model.particle_grid = None
        self.solver = newton.solvers.SolverSemiImplicit(self.model, enable_tri_contact=False)
        self.control = self.model.control()
        self.rest = self.model.state()
        self.states = [self.model.state(), self.model.state()]

    def versions(self):
        return {
            "Newton": newton.__version__,
            "Warp": warp.__version__,
            "numpy": numpy.__version__,
            "Python": platform.python_version(),
        }

    def run(self, method, forces, dt, steps):
        now, after = self.states
        for state in self.states:
            state.particle_q.assign(self.rest.particle_q)
            state.particle_qd.assign(self.rest.particle_qd)
        load = warp.array(forces.astype(numpy.float32), dtype=warp.vec3, device="cpu")
        step, control, copy = self.solver.step, self.control, warp.copy
        instants = self.cube.instants
        motion = numpy.zeros((instants, *self.cube.points.shape))
        rest = self.rest.particle_q.numpy().astype(float)
        spent = 0.0
        for instant in motion:
            before = time.process_time()
            for _ in range(steps // instants):
                copy(now.particle_f, load)
                step(now, after, control, None, dt)
                now, after = after, now
            spent += time.process_time() - before
            instant[:] = now.particle_q.numpy() - rest
        return spent, motion if numpy.isfinite(motion).all() else None


if __name__ == "__main__":
    bench.main(Program, __doc__.splitlines()[0])
