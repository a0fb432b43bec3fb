"""The restitution that physics engines have where it is a number that the user sets.

The engines are run by `make test-engines`; this module describes what they measured. A ball is
dropped with gravity, and r is √(h′/h) of its first rebound, over balls that meet the ground at
different instants within a time step.
"""

from bouncing_ball.datasets.variables import Variable

VARIABLES = {
    "engine": Variable("physics engine"),
    "engine_version": Variable("version of an engine that ran"),
    "asked": Variable("restitution coefficient that was set", symbol="r"),
    "time_step": Variable("time step", units="s"),
    "drop_height": Variable("height of the drop", units="m"),
    "got_mean": Variable("√(h′/h) of the first rebound, mean over instants within a step"),
    "got_least": Variable("√(h′/h) of the first rebound, least over instants within a step"),
    "got_most": Variable("√(h′/h) of the first rebound, greatest over instants within a step"),
}
