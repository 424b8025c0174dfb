"""Central difference with scipy, on a system that `cargo xtask bench --beside scipy` wrote.

    python central_difference.py DIRECTORY DT

Reads one command a line and answers each with one line:

    hello            versions, as JSON
    displacements    writes DIRECTORY/displacements.f64, samples x degrees of freedom, t = 0 first
    lap              CPU seconds of one run's steps

The steps are written as cheaply as numpy and scipy allow: dt^2 M^-1 is in the matrix and in the
load, the velocity is kept as dt v, and nothing but the product makes a new array.
"""

import json
import pathlib
import platform
import sys
import time

import numpy
import scipy
from scipy.sparse import csr_matrix


class Body:
    def __init__(self, directory, dt):
        self.directory = pathlib.Path(directory)
        head = json.loads((self.directory / "system.json").read_text())
        dofs = head["dofs"]
        self.samples = head["samples"]
        self.steps = round(head["duration_s"] / dt)
        if self.steps % self.samples:
            sys.exit(f"a step of {dt} s does not meet the {self.samples} samples")
        stiffness = csr_matrix(
            (self.read("values", "f64"), self.read("columns", "i32"), self.read("row-starts", "i32")),
            shape=(dofs, dofs),
        )
        scale = dt * dt / self.read("mass", "f64")
        self.matrix = csr_matrix(stiffness.multiply(scale[:, None]))
        self.load = scale * self.read("force", "f64")
        self.dofs = dofs

    def read(self, name, kind):
        dtype = {"f64": "<f8", "i32": "<i4"}[kind]
        return numpy.fromfile(self.directory / f"{name}.{kind}", dtype=dtype)

    def rest(self):
        """Displacement and dt times the velocity half a step before the first one."""
        return numpy.zeros(self.dofs), -0.5 * self.load

    def advance(self, u, w, steps):
        """w[n+1/2] = w[n-1/2] + dt^2 a[n], u[n+1] = u[n] + w[n+1/2], in place."""
        matrix, load = self.matrix, self.load
        for _ in range(steps):
            w += load
            w -= matrix @ u
            u += w

    def displacements(self):
        u, w = self.rest()
        out = [u.copy()]
        for _ in range(self.samples):
            self.advance(u, w, self.steps // self.samples)
            out.append(u.copy())
        path = self.directory / "displacements.f64"
        numpy.asarray(out, dtype="<f8").tofile(path)
        return "written"

    def lap(self):
        u, w = self.rest()
        before = time.thread_time()
        self.advance(u, w, self.steps)
        return repr(time.thread_time() - before)


def hello():
    return json.dumps(
        {
            "scipy": scipy.__version__,
            "numpy": numpy.__version__,
            "python": platform.python_version(),
        }
    )


def main():
    directory, dt = sys.argv[1], float(sys.argv[2])
    body = Body(directory, dt)
    answers = {"hello": hello, "displacements": body.displacements, "lap": body.lap}
    for line in sys.stdin:
        print(answers[line.strip()](), flush=True)


main()
