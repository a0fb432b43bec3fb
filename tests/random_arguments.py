"""Random arguments of calls: whole ranges, and what users give by mistake."""

import math
from typing import Any

import numpy as np

import bouncing_ball as bb
from bouncing_ball.contacts.named_laws import LAWS

# Values that users give by mistake, or at the ends of what is allowed.
ODD = (
    0, 0.0, -0.0, 1, 1.0, -1.0, 2, 1e-300, 1e-12, 1e300, 5e-324, 1e8, 10**400, math.nan, math.inf,
    True, None, "1", "0.5", "1e3", "", "fast", [], [1.0], [0.5, 0.9], (1, 2), [[1.0]], ["1"],
    np.float64(0.7), np.int64(1), np.float32(0.5), np.array(0.9), np.array([0.4, 1.2]), 1j, b"1",
    np.array([]), np.array([math.nan]), {}, object,
)  # fmt: skip


class Draw:
    """Random arguments of the calls of a seed; ``said`` is the text of the calls made so far."""

    def __init__(self, seed: int, number: int) -> None:
        self.random = np.random.default_rng([seed, number])
        self.said: list[str] = []

    def odd(self) -> Any:
        return ODD[self.random.integers(len(ODD))]

    def is_odd(self, share: float = 0.04) -> bool:
        return self.random.random() < share

    def pick(self, *values: Any) -> Any:
        return self.odd() if self.is_odd(0.02) else values[self.random.integers(len(values))]

    def number(self, low: float, high: float) -> Any:
        """A number with a uniform logarithm; now and then a list of numbers, or something odd."""
        if self.is_odd():
            return self.odd()
        size = 1 + self.random.integers(3) if self.is_odd() else None
        found = np.exp(self.random.uniform(math.log(low), math.log(high), size))
        return float(found) if size is None else found.tolist()

    def share(self) -> Any:
        return self.odd() if self.is_odd() else float(self.random.random())

    def state(self, high: float = 1e3) -> Any:
        found = self.number(1e-3, high)
        return -found if isinstance(found, float) and self.random.random() < 0.5 else found

    def count(self, low: int, high: int) -> Any:
        found = self.number(low, high)
        return int(found) if isinstance(found, float) and math.isfinite(found) else found

    def some(self, **arguments: Any) -> dict[str, Any]:
        """A random part of the optional arguments, each a function that draws its value."""
        return {k: draw() for k, draw in arguments.items() if self.random.random() < 0.4}

    def call(self, name: str, *args: Any, **arguments: Any) -> Any:
        """The answer of a public function."""
        inside = [f"<{type(x).__name__}>" for x in args]
        inside += [f"{k}={short(v)}" for k, v in arguments.items()]
        self.said.append(f"{name}({', '.join(inside)})")
        return getattr(bb, name)(*args, **arguments)

    def ball(self) -> Any:
        """A ball made by one of the four functions."""
        if self.is_odd(0.01):
            return self.odd()
        match self.random.integers(8):
            case 0 | 1:
                return self.call("rigid", restitution=self.share())
            case 2 | 3:
                return self.spring()
            case 4 | 5 | 6:
                return self.on_law()
            case _:
                return self.call("corrected", self.spring() if self.is_odd(0.5) else self.on_law())

    def loss(self) -> str:
        """The name of a measure of a spring's loss; an unknown name is an error of Python."""
        names = "restitution", "damping_ratio", "measured_restitution"
        loss = self.pick(*names)
        return loss if isinstance(loss, str) and loss in names else "restitution"

    def spring(self) -> Any:
        loss = self.loss()
        release = self.some(release=lambda: self.pick("displacement", "force"))
        of_loss = {loss: self.share()}
        ratio = self.number(0.1, 1e3) if self.random.random() < 0.6 else self.number(1e-8, 1e8)
        return self.call("spring_damper", frequency_ratio=ratio, **of_loss, **release)

    def on_law(self) -> Any:
        law = self.pick(*LAWS)
        if self.random.random() < 0.4 or not isinstance(law, str) or law not in LAWS:
            speed = self.some(speed=lambda: self.number(1e-3, 1e3))
            duration = self.number(1e-6, 10.0)
            return self.call(
                "contact_law", law, restitution=self.share(), duration=duration, **speed
            )
        kind = {
            "stiffness": lambda: self.number(1e-2, 1e9),
            "frequency_ratio": lambda: self.number(1e-2, 1e7),
            "damping_ratio": lambda: self.number(1e-6, 3.0),
            "damping": lambda: self.number(1e-6, 10.0),
        }
        names = LAWS[law].parameter_names()
        fields = {name: kind.get(name, self.share)() for name in names}
        return self.call("contact_law", law, **fields)

    def start(self) -> dict[str, Any]:
        return self.some(phase=self.state, velocity=self.state)

    def amplitude(self) -> Any:
        return self.number(0.05, 20.0) if self.random.random() < 0.7 else self.number(1e-12, 1e8)

    def family(self) -> dict[str, Any]:
        return self.some(n=lambda: self.count(1, 1000) if self.is_odd(0.3) else self.count(1, 5))

    def text(self, unit: str, low: float, high: float) -> Any:
        found = self.number(low, high)
        return f"{found:.4g} {unit}" if isinstance(found, float) and self.is_odd(0.5) else found


def short(value: Any) -> str:
    if callable(value):
        return value.__name__
    text = repr(value)
    return text if len(text) < 60 else text[:57] + "..."
