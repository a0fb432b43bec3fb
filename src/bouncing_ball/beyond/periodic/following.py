"""A branch of periodic orbits, followed along a parameter from one orbit to a value or an end."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from bouncing_ball.beyond.periodic.problem import PeriodicOrbits
from bouncing_ball.beyond.periodic.special import Special, events
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.numerics.continuation import (
    Branch,
    ContinuationError,
    StepControl,
    continue_branch,
)
from bouncing_ball.numerics.corrector import NewtonSettings, newton, plane
from bouncing_ball.numerics.events import Event, SpecialPoint

STEPS = StepControl(initial=0.01, smallest=1e-9, largest=0.1, max_angle=0.15)
"""Steps in arclength, over the phases, the velocities and arsinh of the parameter."""
_PATIENT = NewtonSettings(max_iterations=20, longest=0.3)
_BOUND = "bound"
# A test function this small at the last point is the reason why a branch cannot be followed.
_CLOSE = 1e-4


class State(NamedTuple):
    """One orbit of a branch: its unknowns y, and the problem that gives them a meaning."""

    orbits: PeriodicOrbits
    y: np.ndarray

    @property
    def parameters(self) -> dict[str, float]:
        """The values of the parameters that vary."""
        return {name: float(x) for name, x in self.orbits.values(self.y).items()}

    def family_here(self):
        """The balls with the parameters of this orbit."""
        return self.orbits.family.at(self.parameters)

    def along(self, *names: str) -> "State":
        """The same orbit with other parameters that vary."""
        family = self.family_here()
        orbits = replace(self.orbits, family=family, along=names)
        phase, velocity = self.orbits.states(self.y)
        durations = self.orbits.durations(self.y)
        values = {name: family.values[name] for name in names}
        return State(orbits, orbits.point(phase, velocity, durations, **values))

    def multipliers(self) -> np.ndarray:
        """The two Floquet multipliers."""
        m = self.orbits.monodromy(self.y)
        return np.linalg.eigvals(np.array([[m.a, m.b], [m.c, m.d]]))


@dataclass(frozen=True)
class Followed:
    """A branch of orbits with k impacts in m periods along one parameter.

    ``branch`` has the points in order and the special points; ``branch.end`` gives the reason why
    the branch ends, in words.
    """

    orbits: PeriodicOrbits
    branch: Branch

    def __len__(self) -> int:
        return len(self.branch.points)

    def __iter__(self) -> Iterator[State]:
        return (State(self.orbits, y) for y in self.branch.points)

    @property
    def special(self) -> list[tuple[Special, State]]:
        """The special orbits in order, with their kinds."""
        return [
            (Special(each.name), State(self.orbits, each.point)) for each in self.branch.special
            if each.name in list(Special)
        ]

    def first(self, kind: Special) -> State:
        """The first special orbit of a kind.

        Raises
        ------
        NoOrbitError
            If there is none on the branch.
        """
        for name, state in self.special:
            if name is kind:
                return state
        raise NoOrbitError(f"the branch has no {kind}; it ends because {self.branch.end}")


def corrected(state: State) -> State:
    """The orbit at the parameters of an approximate one.

    Raises
    ------
    NoOrbitError
        If Newton's method does not converge.
    """
    axis = np.eye(state.y.size)[-1]
    with np.errstate(all="ignore"):
        found = newton(state.orbits, state.y, plane(axis, state.y), _PATIENT)
    if not found.converged:
        k = state.orbits.impacts
        raise NoOrbitError(
            f"no orbit with {k} impact{'s' if k > 1 else ''} was found near this motion: residual "
            f"{float(found.residual):.1e} after {found.iterations} Newton iterations"
        )
    return State(state.orbits, found.point)


def bounds(orbits: PeriodicOrbits, to: float | None, increasing: bool) -> list[Event]:
    """The ends of the branch at the ends of the parameter's range, and at the value ``to``."""
    (name,) = orbits.along
    low, high = orbits.family.bounds(name)
    if to is not None and increasing:
        high = min(high, to)
    if to is not None and not increasing:
        low = max(low, to)
    found = []
    for bound, sign in ((low, 1.0), (high, -1.0)):
        if np.isfinite(bound):
            at = np.arcsinh(bound)
            reason = f"{name.replace('_', ' ')} = {bound:g} is reached"
            found.append(
                Event(_BOUND, lambda y, at=at, sign=sign: sign * (y[..., -1] - at), True, reason)
            )
    return found


def follow(
    start: State,
    to: float | None = None,
    *,
    increasing: bool = True,
    control: StepControl = STEPS,
    most: int = 2000,
) -> Followed:
    """Follow an orbit along its parameter, up to a value, the end of the branch or of the range.

    Parameters
    ----------
    start : State
        An orbit, or an approximation to one, with a single parameter that varies.
    to : float, optional
        The value at which the branch ends. The parameter first moves towards it; behind a
        saddle-node it moves back, and beyond the value of the start.
    increasing : bool
        The direction if ``to`` is not given.
    control : StepControl
    most : int
        Number of points after which the branch is left unfinished.

    Raises
    ------
    NoOrbitError
        If there is no orbit near the start.
    """
    here = corrected(start)
    (name,) = here.orbits.along
    if to is not None:
        increasing = to > here.parameters[name]
    tests = events(here.orbits)
    with np.errstate(all="ignore"):
        try:
            branch = continue_branch(
                here.orbits,
                here.y,
                increasing=increasing,
                events=[*tests, *bounds(here.orbits, to, increasing)],
                control=control,
                max_points=most,
            )
        except ContinuationError as error:
            raise NoOrbitError(str(error)) from None
        end = _explained(branch, tests)
    return Followed(here.orbits, replace(branch, end=end))


def _explained(branch: Branch, tests) -> object:
    """The end of a branch, with the event that is near if the steps became too short."""
    end = branch.end
    if not end.sentence.startswith("step too small"):
        return end
    last = branch.points[-1]
    near = [event.name for event in tests if abs(float(event.function(last))) < _CLOSE]
    if not near:
        return end
    return end._replace(sentence=f"{end.sentence}; the orbit is next to a {near[-1]}")
