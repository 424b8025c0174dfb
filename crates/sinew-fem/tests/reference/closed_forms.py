"""Prints the figures of `tests/all/large/closed_forms.rs`: states of one point in closed form, from energies of the
literature in principal stretches, in 50 digits. Run it with mpmath: `python closed_forms.py`."""

from mpmath import mp, mpf

mp.dps = 50

NU = mpf("0.45")


def bulk(mu):
    return 2 * mu * (1 + NU) / (3 * (1 - 2 * NU))


def free(stretches):
    j = stretches[0] * stretches[1] * stretches[2]
    return j, [l / mp.cbrt(j) for l in stretches]


def ogden(l, terms):
    return sum(2 * mpf(mu) / mpf(a) ** 2 * (sum(x ** mpf(a) for x in l) - 3) for mu, a in terms)


def first(l):
    return sum(x**2 for x in l)


def gent(l, mu, limit):
    return -mpf(mu) * mpf(limit) / 2 * mp.log(1 - (first(l) - 3) / mpf(limit))


def arruda_boyce(l, mu, lm):
    c = [mpf(1) / 2, mpf(1) / 20, mpf(11) / 1050, mpf(19) / 7000, mpf(519) / 673750]
    i1, lm = first(l), mpf(lm)
    return mpf(mu) * sum(c[k] * lm ** (-2 * k) * (i1 ** (k + 1) - 3 ** (k + 1)) for k in range(5))


def veronda_westmann(l, c1, c2):
    c1, c2 = mpf(c1), mpf(c2)
    second = sum(x**-2 for x in l)
    return c1 * (mp.exp(c2 * (first(l) - 3)) - 1) - c1 * c2 / 2 * (second - 3)


def at_rest(lm):
    over = mpf(lm) ** -2
    series = [mpf(1), mpf(3) / 5, mpf(99) / 175, mpf(513) / 875, mpf(42039) / 67375]
    return sum(c * over**k for k, c in enumerate(series))


TERMS = [("1000", "1.3"), ("200", "5"), ("50", "-2")]
CASES = {
    "ogden": (lambda l: ogden(l, TERMS), mpf(1250)),
    "gent": (lambda l: gent(l, 1200, 30), mpf(1200)),
    "arruda-boyce": (lambda l: arruda_boyce(l, 1200, "2.8"), 1200 * at_rest("2.8")),
    "veronda-westmann": (lambda l: veronda_westmann(l, 400, "1.5"), mpf(600)),
}


def energy(law, stretches):
    psi, mu = CASES[law]
    j, l = free(stretches)
    return psi(l) + bulk(mu) / 2 * (j - 1) ** 2


def slope(law, stretches, axis):
    step = mpf(10) ** -15
    moved = lambda by: energy(law, [l + by * (i == axis) for i, l in enumerate(stretches)])
    return (moved(step) - moved(-step)) / (2 * step)


def unloaded(law, shape, axis, start):
    """The stretch that leaves an axis without stress, and with it the stress along the first."""
    t = mp.findroot(lambda t: slope(law, shape(t), axis), (start, start * mpf("1.01")), solver="secant", tol=mpf(10) ** -55)
    return t, slope(law, shape(t), 0)


def show(law, load, by, *figures):
    print("    (" + ", ".join([f'"{law}"', f"Load::{load}", by] + [mp.nstr(f, 16, strip_zeros=True) for f in figures]) + "),")


def main():
    for law in CASES:
        for by in ("0.6", "1.3", "2.2"):
            l = mpf(by)
            show(law, "Uniaxial", by, *unloaded(law, lambda t: [l, t, t], 1, l ** mpf("-0.45")))
        for by in ("0.8", "1.4"):
            l = mpf(by)
            show(law, "Equibiaxial", by, *unloaded(law, lambda t: [l, l, t], 2, l ** mpf("-1.8")))
        for by in ("0.7", "1.8"):
            l = mpf(by)
            show(law, "Planar", by, *unloaded(law, lambda t: [l, 1, t], 2, l ** mpf("-0.9")))
        for by in ("0.4", "1.2"):
            # F = [[1, g], [0, 1]] has the stretches l and 1/l with l - 1/l = g, and energy psi(g) has the slope P12.
            g = mpf(by)
            step = mpf(10) ** -15
            long = lambda g: (g + mp.sqrt(g**2 + 4)) / 2
            psi = lambda g: energy(law, [long(g), 1 / long(g), 1])
            show(law, "Shear", by, mpf(1), (psi(g + step) - psi(g - step)) / (2 * step))
        for by in ("0.7", "0.95"):
            show(law, "Confined", by, mpf(1), slope(law, [mpf(by), mpf(1), mpf(1)], 0))


if __name__ == "__main__":
    main()
