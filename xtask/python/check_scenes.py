"""Checks the JSON schema of scenes, and scenes against it, with the package jsonschema.

Usage: check_scenes.py ROOT. Prints the numbers of scenes that are taken and of spoilt ones that are refused.
"""

import copy
import json
import sys
from pathlib import Path

from jsonschema import Draft7Validator

SPOILT = [
    (("region", 0, "density"), 0),
    (("region", 0, "densty"), 1060.0),
    (("region", 0, "poissons_ratio"), 0.5),
    (("region", 0, "springs"), {"rule": "lloyd"}),
    (("load", 0, "force"), [1.0, 2.0, 3.0]),
    (("load", 0, "ramp", "from"), 1.0),
    (("fixed", 0, "where"), {}),
    (("fixed", 0, "axes"), "xx"),
    (("probe", 0, "name"), "a b"),
    (("run", "rho_inf"), 0.5),
    (("run", "beta"), 1.5),
    (("run", "dt"), "fast"),
    (("oscillator",), {"mass": 1.0, "stiffness": 1.0, "damping": 0.0, "velocity": 0.0}),
]
"""Values that spoil scenes/ready/vessel.toml, by their keys."""


def main(root):
    if sys.version_info < (3, 11):
        return print("left out, as Python before 3.11 reads no TOML")
    import tomllib

    schema = json.loads((root / "docs/scene.schema.json").read_text())
    Draft7Validator.check_schema(schema)
    validator = Draft7Validator(schema)
    taken = sorted((root / "scenes").glob("**/*.toml"))
    for path in taken:
        validator.validate(tomllib.loads(path.read_text()))
    vessel = tomllib.loads((root / "scenes/ready/vessel.toml").read_text())
    for keys, value in SPOILT:
        scene = copy.deepcopy(vessel)
        table = scene
        for key in keys[:-1]:
            table = table[key]
        table[keys[-1]] = value
        if validator.is_valid(scene):
            sys.exit(f"the schema takes {'.'.join(map(str, keys))} = {value}")
    print(f"{len(taken)} scenes taken, {len(SPOILT)} spoilt ones refused")


main(Path(sys.argv[1]))
