"""What mujoco_cube.py and newton_cube.py share: the file of the cube, stable steps, laps, the check.

A program is a class with

    versions()              names and versions, as a dict
    METHODS                 its methods, each a Method
    run(method, forces, dt, steps)   from rest: CPU seconds of all steps, and displacements (m, instants x nodes x 3), or
                                     None where the run has failed

`main` reads the file that `cargo xtask bench --beside ..` writes and prints one JSON object a line:

    {"versions": {..}}
    {"check": {"method": .., "off": ..}}          with --check, and then nothing else
    {"case": .., "method": .., "law": .., "dt_s": .., "is_limit": .., "steps": .., "cpu_s": .., "file": ..}

"cpu_s" is the CPU time of this process for the steps of a run, without building and compiling, the least of the laps;
"file" has the displacements at equally spaced instants, the last at the end, as raw little-endian f64, instants x nodes x 3,
in the folder of the cube.
"""

import argparse
import dataclasses
import json
import math
import pathlib
import sys

import numpy

# Programs print on their own; nothing but our lines is to be on standard output.
OUT, sys.stdout = sys.stdout, sys.stderr

# A stable run of half the step is at most this far away (relative); beyond it, motion is noise that grows.
STABLE = 0.5

# The step (s) at which the search for the largest stable one begins.
LARGEST = 0.01

# The check: share of the load of the first case, time (s), step (s), and how far the displacements may be from those of
# linear elasticity (relative L2).
CHECK_LOAD, CHECK_TIME, CHECK_STEP, CHECK_OFF = 2e-3, 0.1, 1e-4, 0.01


@dataclasses.dataclass(frozen=True)
class Method:
    """A method of a program."""

    name: str
    # The law by sinew's name.
    law: str
    # Step (s) of a method that no step makes unstable; None: the largest stable step is looked for.
    dt: float | None = None


class Cube:
    """Mesh, masses, moduli and loads."""

    def __init__(self, path):
        self.folder = path.parent
        data = json.loads(path.read_text())
        self.points = numpy.array(data["points_m"], dtype=float)
        self.tets = numpy.array(data["tets"], dtype=int)
        self.fixed = numpy.array(data["fixed"], dtype=int)
        self.mass = numpy.array(data["mass_kg"], dtype=float)
        self.youngs_modulus = data["youngs_modulus_pa"]
        self.poissons_ratio = data["poissons_ratio"]
        self.duration = data["duration_s"]
        self.instants = data["instants"]
        self.laps = data["laps"]
        self.cases = {case["name"]: numpy.array(case["forces_n"], dtype=float) for case in data["cases"]}
        corners = self.points[self.tets]
        if not (numpy.linalg.det(corners[:, 1:] - corners[:, :1]) > 0).all():
            sys.exit("a tetrahedron is inside out")
        self.is_free = numpy.ones(len(self.points), dtype=bool)
        self.is_free[self.fixed] = False

    def lame(self):
        """Lame's constants lambda and mu (Pa)."""
        e, nu = self.youngs_modulus, self.poissons_ratio
        return e * nu / ((1 + nu) * (1 - 2 * nu)), e / (2 * (1 + nu))

    def steps_of(self, duration, dt):
        """The number of steps of at most `dt` that meet the instants."""
        return self.instants * max(1, math.ceil(duration / (self.instants * dt) - 1e-9))


def apart(found, expected):
    """Relative L2 difference."""
    return numpy.linalg.norm(found - expected) / numpy.linalg.norm(expected)


class Stable:
    """Looks for the largest stable step by halving."""

    def __init__(self, cube, program, method, forces):
        self.cube, self.program, self.method, self.forces = cube, program, method, forces
        self.known = {}

    def motion(self, steps):
        """Displacements of a run of so many steps, None where it has failed."""
        if steps not in self.known:
            dt = self.cube.duration / steps
            _, self.known[steps] = self.program.run(self.method, self.forces, dt, steps)
        return self.known[steps]

    def is_stable(self, steps):
        coarse, fine = self.motion(steps), self.motion(2 * steps)
        return coarse is not None and fine is not None and apart(coarse, fine) <= STABLE

    def steps(self):
        """The least number of steps that are stable and meet the instants."""
        unit = self.cube.instants
        stable = max(1, self.cube.steps_of(self.cube.duration, LARGEST) // unit)
        while not self.is_stable(unit * stable):
            if stable > 100_000:
                sys.exit(f"{self.method.name}: no stable step")
            stable *= 2
        unstable = stable // 2
        while stable - unstable > 1:
            middle = (stable + unstable) // 2
            if self.is_stable(unit * middle):
                stable = middle
            else:
                unstable = middle
        return unit * stable


def stiffness(cube):
    """The matrix of linear elasticity (N/m) of linear tetrahedra."""
    from scipy.sparse import coo_matrix

    lam, mu = cube.lame()
    corners = cube.points[cube.tets]
    edges = corners[:, 1:] - corners[:, :1]
    volumes = numpy.linalg.det(edges) / 6
    # Rows of the inverse of the edges are gradients of the last three shape functions.
    last = numpy.linalg.inv(edges).transpose(0, 2, 1)
    gradients = numpy.concatenate([-last.sum(axis=1, keepdims=True), last], axis=1)
    inner = numpy.einsum("tak,tbk->tab", gradients, gradients)
    blocks = lam * numpy.einsum("tai,tbj->taibj", gradients, gradients)
    blocks += mu * numpy.einsum("taj,tbi->taibj", gradients, gradients)
    blocks += mu * numpy.einsum("tab,ij->taibj", inner, numpy.eye(3))
    blocks *= volumes[:, None, None, None, None]
    dofs = (3 * cube.tets[:, :, None] + numpy.arange(3)).reshape(len(cube.tets), 12)
    rows, columns = numpy.repeat(dofs, 12, axis=1), numpy.tile(dofs, (1, 12))
    size = 3 * len(cube.points)
    return coo_matrix((blocks.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size)).tocsr()


def linear_motion(cube, forces, duration):
    """Displacements (m) of linear elasticity under a sudden load, by central difference at a twentieth of the stable step."""
    from scipy.sparse import diags
    from scipy.sparse.linalg import eigsh

    free = numpy.flatnonzero(numpy.repeat(cube.is_free, 3))
    matrix = stiffness(cube)[free][:, free]
    mass = numpy.repeat(cube.mass, 3)[free]
    scaled = diags(mass**-0.5) @ matrix @ diags(mass**-0.5)
    largest = eigsh(scaled, k=1, which="LA", tol=1e-3, return_eigenvectors=False)[0]
    steps = cube.steps_of(duration, 0.05 * 2 / math.sqrt(largest))
    dt = duration / steps
    load = forces.ravel()[free] / mass
    u, w = numpy.zeros(len(free)), -0.5 * dt * load
    motion = numpy.zeros((cube.instants, 3 * len(cube.points)))
    for instant in motion:
        for _ in range(steps // cube.instants):
            w += dt * (load - matrix @ u / mass)
            u += dt * w
        instant[free] = u
    return motion.reshape(cube.instants, -1, 3)


def check(cube, program):
    """Compares each method under a small load with linear elasticity on the same mesh."""
    forces = CHECK_LOAD * next(iter(cube.cases.values()))
    expected = linear_motion(cube, forces, CHECK_TIME)
    steps = cube.steps_of(CHECK_TIME, CHECK_STEP)
    worst = 0.0
    for method in program.METHODS:
        _, motion = program.run(method, forces, CHECK_TIME / steps, steps)
        if motion is None:
            sys.exit(f"{method.name}: the run under a small load has failed")
        off = apart(motion, expected)
        say({"check": {"method": method.name, "off": off}})
        worst = max(worst, off)
    if worst > CHECK_OFF:
        sys.exit(f"{100 * worst:.2f} % from linear elasticity under a small load, more than {100 * CHECK_OFF:.0f} %")


def measure(cube, program):
    for name, forces in cube.cases.items():
        for method in program.METHODS:
            if method.dt is None:
                steps = Stable(cube, program, method, forces).steps()
            else:
                steps = cube.steps_of(cube.duration, method.dt)
            dt = cube.duration / steps
            # The first lap brings memory and clocks up to speed and counts for nothing.
            laps = [program.run(method, forces, dt, steps) for _ in range(cube.laps + 1)][1:]
            motion = laps[-1][1]
            if motion is None:
                sys.exit(f"{method.name}: {name}: the run has failed")
            file = cube.folder / f"{program.NAME}-{name}-{method.name}.f64"
            numpy.asarray(motion, dtype="<f8").tofile(file)
            say(
                {
                    "case": name,
                    "method": method.name,
                    "law": method.law,
                    "dt_s": dt,
                    "is_limit": method.dt is None,
                    "steps": steps,
                    "cpu_s": min(lap for lap, _ in laps),
                    "file": file.name,
                }
            )


def say(line):
    print(json.dumps(line), file=OUT, flush=True)


def main(make, description):
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("cube", type=pathlib.Path, help="cube.json, as `cargo xtask bench --beside` writes it")
    parser.add_argument(
        "--check", action="store_true", help="only compare the motion under a small load with linear elasticity (needs scipy)"
    )
    arguments = parser.parse_args()
    cube = Cube(arguments.cube)
    program = make(cube)
    say({"versions": program.versions()})
    if arguments.check:
        check(cube, program)
    else:
        measure(cube, program)
