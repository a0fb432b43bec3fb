"""The restitution that physics engines have where it is a number that the user sets.

The engines are run by `make test-engines`; this module describes what they measured. A ball is
dropped with gravity, and r is √(h′/h) of its first rebound, over balls that meet the ground at
different instants within a time step. Short scripts in docs/bounces, the drivers, drop one ball
each, beside numbers with certified digits.
"""

from bouncing_ball_beyond.inherited.datasets.variables import Variable
from bouncing_ball_contacts.documents import engine_steps

VARIABLES = {
    "asked": Variable("restitution coefficient that was set", symbol="r"),
    "time_step": Variable("time step", units="s"),
    "drop_height": Variable("height of the drop", units="m"),
    "got_mean": Variable("√(h′/h) of the first rebound, mean over instants within a step"),
    "got_least": Variable("√(h′/h) of the first rebound, least over instants within a step"),
    "got_most": Variable("√(h′/h) of the first rebound, greatest over instants within a step"),
    "setting": Variable("engine, and the setting of its solver that is not its default"),
    "driver": Variable("script that drops a ball in an engine"),
    "driver_rule": Variable("rule of the certified number"),
    "driver_step": Variable("time step of the driver", units="s"),
    "driver_height": Variable("height of the first rebound in the driver", units="m"),
    "driver_certified": Variable("height of the first rebound, certified", units="m"),
}
# Engines and their versions are declared where their steps are.
ALL_VARIABLES = VARIABLES | engine_steps.VARIABLES
TITLE = "The bounce that physics engines give where r is a number that the user sets"
DRIVERS_TITLE = "One bounce in the driver of each engine, beside certified numbers"
SETTINGS_TITLE = "The bounce that physics engines give with other settings of their solvers"
