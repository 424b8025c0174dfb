"""Tasks of surgery for learners, as environments of Gymnasium.

`import sinew_sim.gym` registers four tasks:

* `sinew/Retract-v0`: seize a flap of tissue and draw it back (`Retract`).
* `sinew/BimanualRetract-v0`: open an incision with two jaws (`BimanualRetract`).
* `sinew/GraspLift-v0`: lift a loose piece of tissue from its bed (`GraspLift`).
* `sinew/Dissect-v0`: free a layer of tissue with a burner while a jaw holds it (`Dissect`).

>>> import gymnasium, sinew_sim.gym
>>> env = gymnasium.make("sinew/Retract-v0", randomise={"region.1.youngs_modulus": (2000.0, 8000.0)})
>>> observation, info = env.reset(seed=1)

`Task` says what all of them share: actions, observations, `info`, random values, pictures. `policies` has a scripted
policy for each task, and a random one.
"""

try:
    import gymnasium
except ImportError as missing:
    raise ImportError("sinew_sim.gym needs gymnasium: pip install 'sinew-sim[gym]'") from missing

from ._hand import Hand
from ._task import Task
from .bimanual_retract import BimanualRetract
from .dissect import Dissect
from .grasp_lift import GraspLift
from .retract import Retract

#: The tasks by their ids.
TASKS: dict[str, type[Task]] = {
    "sinew/Retract-v0": Retract,
    "sinew/BimanualRetract-v0": BimanualRetract,
    "sinew/GraspLift-v0": GraspLift,
    "sinew/Dissect-v0": Dissect,
}

for _id, _task in TASKS.items():
    gymnasium.register(_id, entry_point=f"{_task.__module__}:{_task.__name__}")

__all__ = ["TASKS", "BimanualRetract", "Dissect", "GraspLift", "Hand", "Retract", "Task"]
