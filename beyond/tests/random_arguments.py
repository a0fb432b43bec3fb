"""Random arguments of calls, from the ranges that a package declares, and users' mistakes.

``draw`` is the function that draws from a strategy, as hypothesis gives it to a test. The balls are
those that both houses have; a house that has more of them adds its own ways to make one.
"""

import contextlib
import inspect
import io
import math
import signal
import time
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from types import ModuleType
from typing import Any

import numpy as np
from declared_arguments import Arguments, Declared
from hypothesis import note
from hypothesis import strategies as st

from bouncing_ball_beyond.inherited.errors import ModelError, NoOrbitError, Range
from bouncing_ball_beyond.inherited.models.spring_damper import LOSSES

Draw = Callable[[st.SearchStrategy], Any]

# Values that users give by mistake, or at the ends of what is allowed.
ODD = st.sampled_from((
    0, 0.0, -0.0, 1, 1.0, -1.0, 2, 1e-300, 1e-12, 1e300, 5e-324, 1e8, 10**400, math.nan, math.inf,
    True, None, "1", "0.5", "1e3", "", "fast", [], [1.0], [0.5, 0.9], (1, 2), [[1.0]], ["1"],
    np.float64(0.7), np.int64(1), np.float32(0.5), np.array(0.9), np.array([0.4, 1.2]), 1j, b"1",
    np.array([]), np.array([math.nan]), {}, object,
))  # fmt: skip
# Numbers of the models are dimensionless, and most of those that have an effect are of order one,
# within this factor.
_ORDER = 20.0
_LARGEST = 1e300
# Seconds of processor time after which a call is ended.
_MOST = 6.0


class TimeOver(BaseException):
    """A call takes too long. It is no error, so that no call takes it for one."""


def sometimes(part: int) -> st.SearchStrategy[bool]:
    """True in one of so many cases."""
    return st.sampled_from([True] + [False] * (part - 1))


def _between(low: float, high: float) -> st.SearchStrategy[float]:
    """Positive numbers with a uniform logarithm."""
    return st.floats(math.log(low), math.log(high)).map(math.exp)


def numbers(allowed: Range) -> st.SearchStrategy:
    """Numbers in a range, of order one or of any order."""
    low = max(allowed.low, 1 / _LARGEST)
    high = min(allowed.high, _LARGEST)
    near = max(low, 1 / _ORDER), min(high, _ORDER)
    found = _between(low, high)
    if near[0] < near[1]:
        found = _between(*near) | _between(*near) | found
    if allowed.low < 0:
        found = st.tuples(found, st.sampled_from([1, 1, -1])).map(math.prod)
    if allowed.whole:
        found = found.map(int)
    # Rounding may leave the range at its ends.
    return found.filter(lambda number: number in allowed)


def allowed_by(declared: Declared) -> st.SearchStrategy:
    """Values that a declaration allows."""
    if isinstance(declared, Range):
        return numbers(declared)
    return st.sampled_from(declared)


class Calls:
    """Calls of a package's public functions with random arguments; ``said`` is their text.

    One in four has mistakes, and another one arrays.
    """

    def __init__(self, draw: Draw, package: ModuleType, arguments: Arguments) -> None:
        self.draw = draw
        self.package = package
        self.arguments = arguments
        self.with_mistakes, self.with_arrays = draw(
            st.sampled_from([(False, False), (False, False), (False, True), (True, False)])
        )
        self.said: list[str] = []
        self.spoken = io.StringIO()

    def call(self, name: str, *args: Any, **given: Any) -> Any:
        """The answer of a public function, in which a warning is an error."""
        inside = [f"<{type(x).__name__}>" for x in args]
        inside += [f"{k}={v!r}" for k, v in given.items()]
        self.said.append(f"{name}({', '.join(inside)})")
        with self._watched():
            return getattr(self.package, name)(*args, **given)

    def value(self, declared: Declared) -> Any:
        """A value of an argument, an array or a mistake."""
        right = allowed_by(declared)
        if self.with_mistakes and self.draw(sometimes(6)):
            return self.draw(ODD)
        if self.with_arrays and isinstance(declared, Range) and self.draw(sometimes(3)):
            return self.draw(st.lists(right, min_size=1, max_size=3))
        return self.draw(right)

    def some(self, declared: Mapping[str, Declared], *needed: str, **given: Any) -> dict[str, Any]:
        """A random part of the declared arguments, those that are needed, and those given."""
        optional = [name for name in declared if name not in given and name not in needed]
        drawn = [name for name in optional if self.draw(sometimes(3))]
        return {name: self.value(declared[name]) for name in (*needed, *drawn)} | given

    def random(self, name: str, *args: Any, needed: tuple[str, ...] = (), **given: Any) -> Any:
        """The answer of a public function for a random part of its declared arguments."""
        return self.call(name, *args, **self.some(self.arguments(name), *needed, **given))

    @contextlib.contextmanager
    def _watched(self) -> Iterator[None]:
        start = time.process_time()

        def over(*_: Any) -> None:
            if time.process_time() - start > _MOST:
                raise TimeOver

        signal.signal(signal.SIGPROF, over)
        signal.setitimer(signal.ITIMER_PROF, 0.5, 0.5)
        try:
            with contextlib.redirect_stderr(self.spoken), warnings.catch_warnings():
                warnings.simplefilter("error")
                yield
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0)

    # Balls.

    def makers(self) -> tuple[Callable[[], Any], ...]:
        """The ways to make a ball."""
        return self.rigid, self.spring

    def ball(self) -> Any:
        """A ball made in one of the ways."""
        if self.with_mistakes and self.draw(sometimes(20)):
            return self.draw(ODD)
        return self.draw(st.sampled_from(self.makers()))()

    def rigid(self) -> Any:
        return self.random("rigid", needed=("restitution",))

    def spring(self) -> Any:
        """A ball on a spring and a damper with one of the measures of its loss."""
        allowed = self.arguments("spring_damper")
        of_loss = {name: allowed[name] for name in LOSSES}
        loss = self.draw(st.sampled_from(LOSSES))
        others = {name: allowed[name] for name in allowed.keys() - of_loss.keys()}
        given = self.some(others, "frequency_ratio")
        return self.call("spring_damper", **given, **{loss: self.value(of_loss[loss])})


RandomCall = Callable[[Calls], Any]


def with_ball(name: str, *needed: str) -> RandomCall:
    """A random call of a function of a ball, of which the other arguments are declared."""
    return lambda calls: calls.random(name, calls.ball(), needed=needed)


def check(call: RandomCall, calls: Calls) -> None:
    """A random call is answered, or refused with one line, or takes too long."""
    try:
        call(calls)
    except TimeOver:
        pass
    except (ModelError, NoOrbitError) as error:
        assert "\n" not in str(error), calls.said
    finally:
        note("; ".join(calls.said))
    assert not calls.spoken.getvalue(), calls.said


def undeclared(package: ModuleType, arguments: Arguments, names: Iterable[str]) -> set:
    """The functions and arguments that are numbers of which no range is declared."""
    return {
        (name, argument)
        for name in names
        for argument, about in inspect.signature(getattr(package, name)).parameters.items()
        if str(about.annotation).strip("'") in ("float", "int", "float | None", "int | None")
        and argument not in arguments(name)
    }
