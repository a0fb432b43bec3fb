"""What a row of an engine is: the names of its parameters, their rule for two bodies, its steps.

A row of :data:`.ENGINES` says how a contact with k, c and m is written in the parameters of an
engine, and which scheme then moves the body. Laws are per unit of mass (:mod:`.schemes`). A row of
:data:`.BY_NUMBER` has the restitution number and the rule of its steps (:mod:`.step_rules`).
"""

import difflib
import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from importlib.resources import files
from typing import Any, NamedTuple

from bouncing_ball_contacts.schemes import Array, Implicit, Law, Linear, SemiImplicit
from bouncing_ball_contacts.step_rules import Fall, Steps
from bouncing_ball_contacts.units import STANDARD_GRAVITY, Refused, show

Parameters = Mapping[str, Any]


@dataclass(frozen=True)
class Setting:
    """Setting of a contact.

    Attributes
    ----------
    mass, radius
        Mass in kg and radius in m.
    step
        Time step in s.
    points
        Number of contact points that share the force.
    """

    mass: float
    step: float
    points: int = 1
    radius: float = 0.01


@dataclass(frozen=True)
class Rule:
    """How an engine combines a parameter of two bodies.

    Attributes
    ----------
    text
        The rule in words.
    of
        Combined value of two values.
    alike
        Value that both bodies need for a combined value.
    """

    text: str
    of: Callable[[Any, Any], Any]
    alike: Callable[[Any], Any]


SERIES = Rule("in series", lambda a, b: a * b / (a + b), lambda x: 2 * x)
SUM = Rule("added", lambda a, b: a + b, lambda x: x / 2)
MEAN = Rule("averaged", lambda a, b: (a + b) / 2, lambda x: x)
PRODUCT = Rule("multiplied", lambda a, b: a * b, math.sqrt)
LEAST = Rule("the least of both", min, lambda x: x)
LARGER = Rule("the larger of both counts", max, lambda x: x)
PAIR = Rule("of the pair", lambda a, b: a, lambda x: x)
OF_PAIR = "sets the contact of a pair of bodies, and not of one body"
"""Why an engine whose rules are all of the pair has no other body."""


class Sliding(NamedTuple):
    """How sliding widens the range of r.

    Attributes
    ----------
    takes
        Maximum decrease of r.
    adds
        Maximum increase of an r, at a speed along the surface divided by the speed of the fall.
    speeds
        Such speeds, of which the largest one was measured.
    """

    takes: float = 0.0
    adds: Callable[[float, float], float] = lambda r, speed: 0.0
    speeds: tuple[float, ...] = ()


@dataclass(frozen=True)
class Engine:
    """A physics engine and one of its contacts.

    Parameters
    ----------
    names : tuple of str
        The parameters of the stiffness and of the damping; that of the damping sets r.
    rules : mapping
        How the engine combines each parameter of two bodies.
    write : callable
        The combined parameters of a law in a setting.
    spring : tuple of str
        Names of a spring in N/m and a damper in N s/m, which `write` converts at a step.
    beside : mapping
        What is written beside them.
    read : callable
        The law of combined parameters in a setting.
    meaning : str
        The parameters in terms of k, c and m, both bodies alike.
    of_depth : callable
        The law of an undamped depth, a ratio of damping and a speed, see :class:`.Linear`.
    units : mapping
        The SI units of the parameters that have one.
    defaults : mapping
        The parameters of a body for which none are set.
    deepest : float
        The largest penetration in radii at which the engine still sees the contact.
    resolution : float
        The least depth at rest in radii that the precision of the engine's positions resolves.
    ran, borrows : str
        See :func:`ran_in`.
    notes : tuple of str
        What a user has to know.
    box : str
        What a user has to know of a body with several points.
    friction : str
        What friction does to r.
    rubs : str
        What is pasted with the friction ``mu`` if one is given, of which each body has the ``root``
        if those of two bodies are multiplied. Without it the friction is the engine's own.
    sliding : Sliding
        By how much r of a body that slides may leave the range of one that does not.
    not_for : tuple of str
        Scenes in which r is another one.
    not_of_one_point : tuple of str
        Scenes in which r of a contact for one point is another one.
    """

    name: str
    names: tuple[str, str]
    scheme: SemiImplicit | Implicit
    write: Callable[[Law, Setting], dict[str, Any]]
    read: Callable[[Parameters, Setting], Law]
    meaning: str
    rules: Mapping[str, Rule]
    spring: tuple[str, ...] = ()
    beside: Parameters = field(default_factory=dict)
    of_depth: Callable[[Array, Array, float], Law] = Linear.of_depth
    units: Mapping[str, str] = field(default_factory=dict)
    defaults: Parameters = field(default_factory=dict)
    deepest: float = math.inf
    resolution: float = 0.0
    ran: str = ""
    borrows: str = ""
    notes: tuple[str, ...] = ()
    box: str = ""
    sliding: Sliding = Sliding()
    rubs: str = ""
    friction: str = "friction acts along the surface only, and leaves r as it is"
    not_for: tuple[str, ...] = ()
    not_of_one_point: tuple[str, ...] = ()

    def combined(self, one: Parameters, other: Parameters) -> dict[str, Any]:
        """Return the parameters of the contact of two bodies."""
        return {
            name: self.rules[name].of(value, other.get(name, value))
            for name, value in {**other, **one}.items()
        }

    def of_each(self, combined: Parameters) -> dict[str, Any]:
        """Return the parameters that both bodies need for the parameters of their contact."""
        return {name: self.rules[name].alike(value) for name, value in combined.items()}


MODES = {"average": MEAN, "min": LEAST, "multiply": PRODUCT, "max": LARGER}
"""How PhysX combines a restitution; of two materials the later one in this list counts."""


def as_compared(name: str) -> str:
    """Return the form in which names are compared.

    SetKn, set_kn and kn are the same name; E and e are different names. Only the last part of a
    name such as ``Physics.bounceThreshold`` counts.
    """
    last = re.split("[.:/>]", name)[-1]
    return last if len(last) == 1 else re.sub(r"^(set|geom_)(?!$)|[\W_]", "", last.lower())


# In 1/s², the default gravity of matter-js.
PIXELS = 1000.0


@dataclass(frozen=True)
class ByNumber:
    """An engine whose restitution is a number.

    Attributes
    ----------
    name : str
    ran, borrows : str
        See :func:`ran_in`.
    rule : callable
        Steps of a ball, see :mod:`.step_rules`.
    parameter, pair, default, lowest
        Name of the number, how the engine combines the numbers of two bodies, the number of a body
        for which none is set, and the smallest number that one of two bodies may have.
    threshold : float
        Speed in m/s below which an impact has no restitution; with ``is_of_rebound`` the speed of
        the rebound counts.
    set_by : str
        Name of the threshold; empty if it has none.
    has_defaults : bool
        Whether the threshold has a default. A contact of ODE is a struct of C, which has none.
    lines : mapping
        Lines to paste, by the names of the number, the threshold, the settings, and "step" in s,
        and with pixels "gravity" in pixels/ms². A threshold without a line is a constant.
    settings : mapping
        Other parameters that change r, with their defaults.
    designed : tuple of mappings
        Values of the settings that are tried, one after the other, if r is not kept without them.
    damped_by, kept
        Name of the linear damping, and the share of a velocity that it leaves in a step.
    free : callable
        Velocity after a step of free flight, if its damping is not linear.
    ahead : callable
        Height in m below which a contact is found, of the settings, the size and the points.
    springs : str
        Row of the same engine in :data:`.ENGINES`, for a stiffness.
    sinks, remembers
        How many times g h² a body falls farther in a step than with the velocity before it, and how
        many steps before an impact matter.
    depends_on_mass : bool
        Whether r depends on the mass, because contacts have a softness. Without a mass it is 1 kg.
    is_physx : bool
        Whether materials say how their numbers are combined.
    is_restless, calmed_by
        Whether each step of gravity is thrown back, so that only a threshold above g h/(1 - r) lets
        a body come to rest; and a setting with which it comes to rest.
    pixels : float
        Number of pixels in a metre, of an engine whose lengths are pixels.
    either : tuple of mappings
        Settings that nobody chooses, over which r is taken: how a ball that is a polygon is turned,
        in half sides, 0 with a corner below; and how the engine rounds.
    skin : float
        Height in m above a polygon at which a ball touches it.
    reach : float
        Height in m above which a body that rises flies freely, and below which a contact is found.
    ignored_by : str
        A backend of the product that ignores the number.
    own_step : float
        Default time step in s; 0 if a program has to choose one.
    """

    name: str
    rule: Callable[[Fall, float, float], Steps]
    ran: str
    lines: Mapping[str, str]
    parameter: str = "restitution"
    pair: Rule = MEAN
    default: float = 0.0
    lowest: float = 0.0
    threshold: float = 0.0
    is_of_rebound: bool = False
    set_by: str = ""
    has_defaults: bool = True
    settings: Mapping[str, float] = field(default_factory=dict)
    designed: tuple[Mapping[str, float], ...] = ()
    damped_by: str = ""
    kept: Callable[[float, float], float] = lambda damping, step: 1.0
    free: Callable[[Fall, Array], Array] | None = None
    ahead: Callable[[Parameters, float, int], float] | None = None
    springs: str = ""
    sinks: float = 1.0
    remembers: int = 2
    depends_on_mass: bool = False
    is_physx: bool = False
    is_restless: bool = False
    calmed_by: str = ""
    pixels: float = 0.0
    either: tuple[Mapping[str, float], ...] = ({},)
    skin: float = 0.0
    reach: float = 0.06
    borrows: str = ""
    ignored_by: str = ""
    own_step: float = 0.0
    notes: tuple[str, ...] = ()
    not_for: tuple[str, ...] = ()

    @property
    def is_constant(self) -> bool:
        """Whether the threshold cannot be set."""
        return self.set_by not in self.lines

    @property
    def names(self) -> dict[str, str]:
        """Meaning of the names that may be typed, by their compared forms."""
        modes = ("combine", "bounceCombine", "restitutionCombineMode")
        typed = {
            "number": ("restitution", self.parameter),
            "threshold": ("threshold", "" if self.pixels else self.set_by) if self.set_by else (),
            "threshold in pixels": (self.set_by,) if self.pixels else (),
            "combine": modes if self.is_physx else (),
            "pixels": ("pixels",) if self.pixels else (),
            **{name: (name,) for name in self.settings},
        }
        return {as_compared(name): what for what, names in typed.items() for name in names if name}

    @property
    def unit(self) -> float:
        """Unit of the threshold in m/s; with pixels one pixel in 1/60 s."""
        return 60 / self.pixels if self.pixels else 1.0

    def limit(self, threshold: float) -> str:
        """Return a threshold in m/s with its name."""
        pixels = f"{threshold / self.unit:.3g} pixels in 1/60 s" if self.pixels else ""
        return ", ".join(filter(None, [show(threshold, "m/s"), pixels, self.set_by]))

    def scaled(self, gravity: float, pixels: float | None = None) -> "ByNumber":
        """Return the engine with `pixels` in a metre; by default its own gravity sets them."""
        if not self.pixels:
            return self
        scale = pixels or PIXELS / (gravity or STANDARD_GRAVITY)
        return replace(self, pixels=scale, threshold=self.threshold * self.pixels / scale)


_SAME = {
    **dict.fromkeys(("e", "cor", "bounciness", "bounce", "elasticity"), "restitution"),
    "k": "stiffness",
    "c": "damping",
}
"""What other engines and papers call a parameter, as names are compared."""
_TIME_STEPS = ("timestep", "dt", "fixedtimestep", "fixeddeltatime", "maxstepsize", "stepsize")
"""What engines call the time step, as names are compared."""


def parameters_of(
    engine: str,
    known: Mapping[str, str],
    names: Sequence[str],
    typed: Parameters,
    springs: Sequence[str] = (),
) -> dict[str, Any]:
    """Return typed values by their names in the engine.

    ``known`` maps names as they are compared to names of the engine; ``names`` are listed in
    messages, and the names of ``springs``, which are computed in place of a number.

    Raises
    ------
    Refused
        If a name is unknown, or given twice.
    """
    parameters: dict[str, Any] = {}
    for typed_name, value in typed.items():
        name = known.get(as_compared(str(typed_name)))
        if name is None:
            near = [
                f"; did you mean {one}?"
                for one in difflib.get_close_matches(typed_name, [*names, *springs], 1, 0.7)
                if one != typed_name
            ]
            said = ["; the time step is --time-step, or time_step= in Python"]
            same = _SAME.get(as_compared(str(typed_name)), "")
            meant = [f"; did you mean {same}?"] * (same in known)
            hint = "".join(said * (as_compared(str(typed_name)) in _TIME_STEPS) or meant or near)
            known_here = ", ".join(names)
            if springs:
                known_here += f"; without a restitution {', '.join(springs)}"
            raise Refused(
                f"{engine}: {typed_name!r} is not computed here; computed are {known_here}{hint}"
            )
        if name in parameters:
            raise Refused(f"{typed_name!r} gives {name} twice")
        parameters[name] = value
    return parameters


def ran_in(row: Engine | ByNumber) -> str:
    """Return the version in which a row was compared with its engine.

    A product that was not run itself ``borrows`` the rule of another row.
    """
    if not row.borrows:
        return f"run in {row.ran}" if row.ran else "not run"
    return f"not run: the rule of {row.borrows}, run in {row.ran}"


def one_of(name: str, value: Any, words: Iterable[str]) -> str:
    """Return the word that begins with the first three letters of a value."""
    for word in words:
        if str(value).lower()[:3] == word[:3]:
            return word
    raise Refused(f"{name} = {value} is none of {', '.join(words)}")


def snippet_of(name: str) -> str:
    """Return the text of a snippet; empty if there is none."""
    path = files(__package__).joinpath("snippets", f"{name}.txt")
    return path.read_text("utf-8") if path.is_file() else ""
