"""Prints the figures that crates/sinew-verify asks of laws (src/closed_forms), fibres and relaxation (src/subjects), from
energies in 50 digits. Run it with mpmath: `python law_figures.py`."""

from mpmath import mp, mpf

import law_energies as laws
from law_energies import diagonal, slope, stress, tangent, unit

LA, MU = laws.lame(3500, "0.45")
RATE = mpf(10) ** -35


def by(law):
    return lambda f: laws.LAWS[law](f, LA, MU)


def text(value):
    return mp.nstr(value, 15, strip_zeros=True)


def d(function, x):
    h = laws.STEP
    return (function(x + h) - function(x - h)) / (2 * h)


def lateral(psi, stretch, start):
    """The one lateral stretch that needs no force, of two alike."""
    across = lambda t: d(lambda x: psi(diagonal(stretch, x, x)), t)
    # With a wide step for the second derivative, secants end at the digits of the first.
    return mp.findroot(across, (mpf(start), mpf(start) * mpf("1.001")), solver="secant", tol=mpf(10) ** -60)


def uniaxial():
    print("# uniaxial: law, stretch, lateral stretch, P")
    for law in laws.LAWS:
        t = mpf(1)
        for stretches in (["0.9", "0.7", "0.5"], ["1.1", "1.5", "2"]):
            t = mpf(1)
            for l in map(mpf, stretches):
                if law == "stvk" and l == 2:
                    continue
                t = lateral(by(law), l, t * (1 - (l - 1) * mpf("0.3")) if t == 1 else t)
                print(law, text(l), text(t), text(d(lambda x: by(law)(diagonal(x, t, t)), l)))


def shear():
    print("# simple shear: law, gamma, s12, s11 - s22, P21")
    for law in laws.LAWS:
        for g in map(mpf, ("0.5", "1")):
            f = diagonal(1, 1, 1)
            f[0][1] = g
            p = stress(by(law), f)
            s = [[sum(p[i][k] * f[j][k] for k in range(3)) for j in range(3)] for i in range(3)]
            print(law, text(g), text(s[0][1]), text(s[0][0] - s[1][1]), text(p[1][0]))


def dilation():
    print("# dilation: law, P11 at .8 .9 1.1 1.25")
    for law in laws.LAWS:
        figures = [slope(by(law), diagonal(a, a, a), unit(0, 0)) for a in ("0.8", "0.9", "1.1", "1.25")]
        print(law, *map(text, figures))


def inversion():
    print("# inversion diag(a, 1, 1): law, P11 at -1 -.5 -.1 0 .1; energy at F = 0 and at diag(-1, 1, 1)")
    for law in laws.INVERTIBLE:
        figures = [slope(by(law), diagonal(a, 1, 1), unit(0, 0)) for a in ("-1", "-0.5", "-0.1", "0", "0.1")]
        print(law, *map(text, figures), text(by(law)(diagonal(0, 0, 0))), text(by(law)(diagonal(-1, 1, 1))))


def eigenvalues():
    print("# smallest eigenvalue of the tangent over mu at diag(.7, 1, 1), diag(2, 1, 1), .8 I")
    for law in laws.LAWS:
        figures = []
        for stretches in (("0.7", 1, 1), (2, 1, 1), ("0.8", "0.8", "0.8")):
            f = diagonal(*stretches)
            matrix = mp.matrix(9, 9)
            for j in range(9):
                column = tangent(by(law), f, unit(j // 3, j % 3))
                for i in range(9):
                    matrix[i, j] = column[i // 3][i % 3]
            symmetric = (matrix + matrix.T) / 2
            figures.append(min(mp.eigsy(symmetric, eigvals_only=True)) / MU)
        print(law, *map(text, figures))


def incompressible():
    print("# incompressible, l = .7, 1.5, 2: 2 (l - l^-2) (C1 + C2/l)")
    for law, ratio in (("neo-hookean", mp.inf), ("mooney-rivlin", mpf(4))):
        c1 = MU / 2 if ratio == mp.inf else MU / 2 * ratio / (1 + ratio)
        c2 = MU / 2 - c1
        figures = [2 * (l - l**-2) * (c1 + c2 / l) for l in map(mpf, ("0.7", "1.5", "2"))]
        print(law, *map(text, figures))


FIBRES = {
    "quadratic 2000": lambda f, a: laws.quadratic_fibres(f, a, 2000),
    "exponential 1000 2 0": lambda f, a: laws.exponential_fibres(f, a, 1000, 2, 0),
    "exponential 1000 2 .1": lambda f, a: laws.exponential_fibres(f, a, 1000, 2, "0.1"),
}


def fibres():
    print("# fibres along: kind, l, t, P")
    for name, fibre in FIBRES.items():
        psi = lambda f: by("neo-hookean")(f) + fibre(f, (mpf(1), mpf(0), mpf(0)))
        for l in map(mpf, ("0.9", "1.1", "1.3")):
            t = lateral(psi, l, 1 - (l - 1) * mpf("0.4"))
            print(name, text(l), text(t), text(d(lambda x: psi(diagonal(x, t, t)), l)))
    print("# fibres across a compression to .9: kind, stretch along the fibre, across, P")
    for name, fibre in FIBRES.items():
        # Pressed along x, fibres along y.
        psi = lambda f: by("neo-hookean")(f) + fibre(f, (mpf(0), mpf(1), mpf(0)))
        l = mpf("0.9")
        free = lambda y, z: (
            d(lambda x: psi(diagonal(l, x, z)), y),
            d(lambda x: psi(diagonal(l, y, x)), z),
        )
        y, z = mp.findroot(free, (mpf("1.02"), mpf("1.07")), tol=mpf(10) ** -50)
        print(name, text(y), text(z), text(d(lambda x: psi(diagonal(x, y, z)), l)))
    print("# fibres (1, 1, 0)/sqrt 2 in simple shear .5: kind, P12, P21, P11, P22")
    half = 1 / mp.sqrt(2)
    for name, fibre in FIBRES.items():
        f = diagonal(1, 1, 1)
        f[0][1] = mpf("0.5")
        p = stress(lambda at: by("neo-hookean")(at) + fibre(at, (half, half, mpf(0))), f)
        print(name, *map(text, (p[0][1], p[1][0], p[0][0], p[1][1])))


def relaxation():
    print("# relaxation, E 3500, g .3/.2, tau .05/.5")
    terms = [(mpf("0.3"), mpf("0.05")), (mpf("0.2"), mpf("0.5"))]
    stays = 1 - sum(g for g, _ in terms)
    ramp = lambda t, rate: 3500 * rate * (stays * t + sum(g * tau * (1 - mp.exp(-t / tau)) for g, tau in terms))
    print("ramp .1/s to 1 s", text(ramp(mpf(1), mpf("0.1"))))
    step = 350 * (stays + sum(g * mp.exp(-1 / tau) for g, tau in terms))
    print("step of .1 at 1 s", text(step))
    for dt in map(mpf, ("0.1", "0.01", "0.001")):
        # The strain rises over the first step, and is held.
        risen = ramp(mpf(1), mpf("0.1") / dt) - ramp(1 - dt, mpf("0.1") / dt)
        print("ramp over the first step", text(dt), text(risen))
    w = 4 * mp.pi
    storage = 3500 * (stays + sum(g * (w * tau) ** 2 / (1 + (w * tau) ** 2) for g, tau in terms))
    loss = 3500 * sum(g * w * tau / (1 + (w * tau) ** 2) for g, tau in terms)
    print("storage and loss modulus at 2 Hz", text(storage), text(loss))
    dt = mpf("0.01")
    factor = stays + sum(g * (1 - mp.exp(-dt / tau)) / (dt / tau) for g, tau in terms)
    print("tangent factor at .01 s", text(factor))


if __name__ == "__main__":
    for table in (uniaxial, shear, dilation, inversion, eigenvalues, incompressible, fibres, relaxation):
        table()
