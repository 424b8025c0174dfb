"""A sphere presses a soft cube: the force on it and the largest stress, in twelve lines."""

import sinew_sim as sn
scene = sn.Scene.from_dict({
    "mesh": {"cube": {"cells": 10, "edge": 0.1}},
    "region": [{"density": 1060.0, "model": "neo-hookean", "youngs_modulus": 3500.0, "poissons_ratio": 0.45}],
    "fixed": [{"group": "bottom"}],
    "tool": [{"name": "probe", "shape": {"sphere": {"radius": 0.02}}, "start": [0.05, 0.05, 0.125], "hold": True}],
    "damping": {"mass": 20.0}, "run": {"duration": 1.0, "integrator": "central-difference", "dt": "auto"}})
sim = scene.session()
for k in range(100):
    sim.tool("probe").move_to([0.05, 0.05, 0.125 - 2e-4 * k])
    sim.advance(by=0.01)
print(sim.tool("probe").force, sim.von_mises().max())
