"""Compares energies, stresses and tangents of laws, a JSON file, with differences of energies in 50 digits.

Prints a line for each law; the exit status is 1 where one is off.
"""

import json
import sys

from mpmath import mpf

import law_energies as laws

# Of the largest entry; what is compared are doubles that went through some tens of roundings.
TOLERANCE = 1e-11


def tensor(numbers):
    return [[mpf(numbers[3 * i + j]) for j in range(3)] for i in range(3)]


def gradient(numbers):
    h = tensor(numbers)
    return [[h[i][j] + (i == j) for j in range(3)] for i in range(3)]


def energy_of(case):
    name = case["law"]
    if name in laws.LAWS:
        la, mu = laws.lame(case["youngs_modulus"], case["poissons_ratio"])
        own = [case[key] for key in laws.OWN if key in case]
        return lambda f: laws.LAWS[name](f, la, mu, *own)
    direction = [mpf(x) for x in case["direction"]]
    if "eta" in case:
        return lambda f: laws.quadratic_fibres(f, direction, case["eta"])
    parameters = [case[key] for key in ("k1", "k2", "dispersion", "split")]
    return lambda f: laws.exponential_fibres(f, direction, *parameters)


def error(numbers, reference, floor):
    flat = [entry for row in reference for entry in row]
    size = max(max(map(abs, flat)), floor)
    return float(max(abs(a - b) for a, b in zip(numbers, flat)) / size)


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        cases = json.load(file)
    is_off = False
    for case in cases:
        psi = energy_of(case)
        worst = [0.0, 0.0, 0.0]
        for sample in case["samples"]:
            f, change = gradient(sample["h"]), tensor(sample["change"])
            scale = mpf(case["scale"])
            value = psi(f)
            errors = [
                float(abs(sample["energy"] - value) / max(abs(value), scale)),
                error(sample["stress"], laws.stress(psi, f), scale),
                error(sample["tangent"], laws.tangent(psi, f, change), scale),
            ]
            worst = [max(pair) for pair in zip(worst, errors)]
        is_good = all(error <= TOLERANCE for error in worst) and case["samples"]
        is_off = is_off or not is_good
        energy, stress, tangent = worst
        print(
            f"{case['law']}: {len(case['samples'])} deformations, relative error of the energy {energy:.1e}, "
            f"the stress {stress:.1e}, the tangent {tangent:.1e}{'' if is_good else ': OFF'}"
        )
    known = {case["law"] for case in cases}
    for law in sorted(set(laws.LAWS) - known):
        print(f"{law}: OFF, not among the laws that were written")
        is_off = True
    sys.exit(1 if is_off else 0)


main()
