"""Energies of hyperelastic laws in arithmetic of 50 digits, written from the literature and from nothing else.

Each law is one energy of the deformation gradient; stresses and tangents are its differences. No digits are lost by
that: a difference over 1e-15 is wrong by 1e-30.
"""

from mpmath import mp, mpf

mp.dps = 50

STEP = mpf(10) ** -15


def lame(youngs_modulus, poissons_ratio):
    e, nu = mpf(youngs_modulus), mpf(poissons_ratio)
    return e * nu / ((1 + nu) * (1 - 2 * nu)), e / (2 * (1 + nu))


def determinant(f):
    (a, b, c), (d, e, g), (h, i, k) = f
    return a * (e * k - g * i) - b * (d * k - g * h) + c * (d * i - e * h)


def right_cauchy_green(f):
    return [[sum(f[k][i] * f[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def first_invariant(f):
    return sum(entry * entry for row in f for entry in row)


def second_invariant(f):
    c = right_cauchy_green(f)
    return (first_invariant(f) ** 2 - first_invariant(c)) / 2


def singular_values(f):
    """Of F'F by mpmath; the smallest has the sign of det F."""
    squares = mp.eigsy(mp.matrix(right_cauchy_green(f)), eigvals_only=True)
    values = sorted(mp.sqrt(abs(square)) for square in squares)
    if determinant(f) < 0:
        values[0] = -values[0]
    return values


def neo_hookean(f, la, mu):
    j = determinant(f)
    return mu / 2 * (first_invariant(f) - 3) - mu * mp.log(j) + la / 2 * (j - 1) ** 2


def neo_hookean_log(f, la, mu):
    log = mp.log(determinant(f))
    return mu / 2 * (first_invariant(f) - 3) - mu * log + la / 2 * log**2


def mooney_rivlin(f, la, mu, ratio=4):
    j = determinant(f)
    c2 = mu / 2 / (1 + mpf(ratio))
    first = mp.cbrt(j) ** -2 * first_invariant(f) - 3
    second = mp.cbrt(j) ** -4 * second_invariant(f) - 3
    return ratio * c2 * first + c2 * second + (la + 2 * mu / 3) / 2 * (j - 1) ** 2


def neo_hookean_iso(f, la, mu):
    j = determinant(f)
    first = mp.cbrt(j) ** -2 * first_invariant(f) - 3
    return mu / 2 * first + (la + 2 * mu / 3) / 2 * (j - 1) ** 2


def stable_neo_hookean(f, la, mu):
    j = determinant(f)
    return mu / 2 * (first_invariant(f) - 3) - mu * (j - 1) + (la + mu) / 2 * (j - 1) ** 2


def stable_neo_hookean_log(f, la, mu):
    mu_own, la_own = 4 * mu / 3, la + 5 * mu / 6
    alpha = 1 + 3 * mu_own / (4 * la_own)
    j, i1 = determinant(f), first_invariant(f)
    at_rest = la_own / 2 * (1 - alpha) ** 2 - mu_own / 2 * mp.log(4)
    psi = mu_own / 2 * (i1 - 3) + la_own / 2 * (j - alpha) ** 2 - mu_own / 2 * mp.log(i1 + 1)
    return psi - at_rest


def corotational(f, la, mu):
    values = singular_values(f)
    return mu * sum((s - 1) ** 2 for s in values) + la / 2 * (sum(values) - 3) ** 2


def stvk(f, la, mu):
    c = right_cauchy_green(f)
    e = [[(c[i][j] - (i == j)) / 2 for j in range(3)] for i in range(3)]
    return mu * first_invariant(e) + la / 2 * (e[0][0] + e[1][1] + e[2][2]) ** 2


def yeoh(f, la, mu, c=(1, mpf(1) / 10, mpf(1) / 30)):
    """c1 is mu/2; c gives the ratios of the three constants."""
    j = determinant(f)
    first = mp.cbrt(j) ** -2 * first_invariant(f) - 3
    shape = sum(mpf(own) / mpf(c[0]) * first ** (i + 1) for i, own in enumerate(c))
    return mu / 2 * shape + (la + 2 * mu / 3) / 2 * (j - 1) ** 2


def isochoric_stretches(f):
    """Principal stretches of `F J^-1/3`, by the roots of the characteristic polynomial: mpmath's own eigenvalues have too
    few digits for differences of differences."""
    root = mp.cbrt(determinant(f))
    return [value / root for value in singular_values(f)]


def volume(f, la, mu):
    return (la + 2 * mu / 3) / 2 * (determinant(f) - 1) ** 2


def isochoric_first(f):
    return mp.cbrt(determinant(f)) ** -2 * first_invariant(f)


def gent(f, la, mu, shear_modulus=None, limit="97.2"):
    """The shear modulus is that at small strain."""
    limit = mpf(limit)
    return -mu * limit / 2 * mp.log(1 - (isochoric_first(f) - 3) / limit) + volume(f, la, mu)


def arruda_boyce(f, la, mu, shear_modulus=None, locking_stretch="2.8"):
    """The modulus of the chains follows from that at small strain."""
    over = mpf(locking_stretch) ** -2
    series = [mpf(1), mpf(3) / 5, mpf(99) / 175, mpf(513) / 875, mpf(42039) / 67375]
    own = mu / sum(c * over**k for k, c in enumerate(series))
    c = [mpf(1) / 2, mpf(1) / 20, mpf(11) / 1050, mpf(19) / 7000, mpf(519) / 673750]
    i1 = isochoric_first(f)
    return own * sum(c[k] * over**k * (i1 ** (k + 1) - 3 ** (k + 1)) for k in range(5)) + volume(f, la, mu)


def veronda_westmann(f, la, mu, c1=None, c2="0.5"):
    """c1 is mu/c2."""
    c2 = mpf(c2)
    second = mp.cbrt(determinant(f)) ** -4 * second_invariant(f) - 3
    return mu / c2 * (mp.exp(c2 * (isochoric_first(f) - 3)) - 1) - mu / 2 * second + volume(f, la, mu)


def fung(f, la, mu, c=None, b=("0.02", "0.02", "0.02", "0.005", "0.005", "0.005", "0.015", "0.015", "0.015")):
    """In the axes of coordinates; c follows from the mean of the shear moduli at small strain."""
    b11, b22, b33, b12, b23, b31, g12, g23, g31 = (mpf(entry) for entry in b)
    own = (g12 + g23 + g31 + b11 + b22 + b33 - (b11 + b22 + b33 + 2 * (b12 + b23 + b31)) / 3) / 10
    scale = mp.cbrt(determinant(f)) ** -2
    squared = [[sum(f[k][i] * f[k][j] for k in range(3)) for j in range(3)] for i in range(3)]
    e = [[(scale * squared[i][j] - (i == j)) / 2 for j in range(3)] for i in range(3)]
    normal = b11 * e[0][0] ** 2 + b22 * e[1][1] ** 2 + b33 * e[2][2] ** 2
    coupled = 2 * (b12 * e[0][0] * e[1][1] + b23 * e[1][1] * e[2][2] + b31 * e[2][2] * e[0][0])
    shear = 2 * (g12 * e[0][1] ** 2 + g23 * e[1][2] ** 2 + g31 * e[2][0] ** 2)
    return mu / own / 2 * (mp.exp(normal + coupled + shear) - 1) + volume(f, la, mu)


def ogden(f, la, mu, terms=(1000, mpf("1.3"), 200, 5, 50, -2)):
    """The terms give the ratios of the moduli."""
    pairs = [(mpf(terms[i]), mpf(terms[i + 1])) for i in range(0, len(terms), 2)]
    share = mu / sum(own for own, _ in pairs)
    stretches = isochoric_stretches(f)
    psi = sum(2 * share * own / a**2 * (sum(s**a for s in stretches) - 3) for own, a in pairs)
    return psi + volume(f, la, mu)


LAWS = {
    "neo-hookean": neo_hookean,
    "stable-neo-hookean": stable_neo_hookean,
    "corotational": corotational,
    "stvk": stvk,
    "mooney-rivlin": mooney_rivlin,
    "neo-hookean-log": neo_hookean_log,
    "neo-hookean-iso": neo_hookean_iso,
    "stable-neo-hookean-log": stable_neo_hookean_log,
    "yeoh": yeoh,
    "fung": fung,
    "gent": gent,
    "arruda-boyce": arruda_boyce,
    "veronda-westmann": veronda_westmann,
    "ogden": ogden,
}

# Parameters that laws take beside moduli.
OWN = ["c1_over_c2", "c", "b", "shear_modulus", "limit", "locking_stretch", "c1", "c2", "terms"]

INVERTIBLE = ["stable-neo-hookean", "corotational", "stvk", "stable-neo-hookean-log"]


def fibre_stretch(f, direction, dispersion, split=False):
    kd = mpf(dispersion)
    along = [sum(f[i][j] * direction[j] for j in range(3)) for i in range(3)]
    free = mp.cbrt(determinant(f)) ** -2 if split else 1
    i1, i4 = free * first_invariant(f), free * sum(x * x for x in along)
    return kd * (i1 - 3) + (1 - 3 * kd) * (i4 - 1)


def quadratic_fibres(f, direction, eta):
    stretch = fibre_stretch(f, direction, 0)
    return mpf(eta) / 2 * stretch**2 if stretch > 0 else mpf(0)


def exponential_fibres(f, direction, k1, k2, dispersion, split=False):
    stretch = fibre_stretch(f, direction, dispersion, split)
    k1, k2 = mpf(k1), mpf(k2)
    return k1 / (2 * k2) * (mp.exp(k2 * stretch**2) - 1) if stretch > 0 else mpf(0)


def moved(f, direction, by):
    return [[f[i][j] + by * direction[i][j] for j in range(3)] for i in range(3)]


def unit(i, j):
    return [[mpf((a, b) == (i, j)) for b in range(3)] for a in range(3)]


def slope(psi, f, direction):
    return (psi(moved(f, direction, STEP)) - psi(moved(f, direction, -STEP))) / (2 * STEP)


def stress(psi, f):
    return [[slope(psi, f, unit(i, j)) for j in range(3)] for i in range(3)]


def tangent(psi, f, change):
    """The change of the stress by a change of F."""

    def change_of(i, j):
        return slope(lambda at: slope(psi, at, unit(i, j)), f, change)

    return [[change_of(i, j) for j in range(3)] for i in range(3)]


def diagonal(a, b, c):
    return [[mpf(a), mpf(0), mpf(0)], [mpf(0), mpf(b), mpf(0)], [mpf(0), mpf(0), mpf(c)]]
