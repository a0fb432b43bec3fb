"""Contacts of any force law, and the laws that have names."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from bouncing_ball_beyond.balls import H, Ball, Impact, Signature
from bouncing_ball_beyond.root_time import Motion, follow


@dataclass(frozen=True)
class ForceLaw(Ball):
    """A contact whose force per mass f(p, p′) is any function of the penetration and its rate."""

    force: Callable
    values: Mapping
    root: int = 1
    release: str = "displacement"
    lag: Callable | None = None
    kinks: tuple = ()
    units: Mapping = field(default_factory=dict)

    lasts: ClassVar[bool] = True

    @property
    def parameters(self):
        """Names and values of the parameters of the force."""
        return dict(self.values)

    def at(self, **values):
        """The same law with other values of parameters, which are not checked."""
        new = object.__new__(type(self))
        vars(new).update(vars(self), values={**self.values, **values})
        return new

    @property
    def kappa(self):
        """κ of a release where p + κp′ = 0; 0 for a release at p = 0."""
        return self.lag(**self.values) if self.lag else 0.0

    @property
    def frequency_powers(self):
        """Powers of the frequency of the table to which the parameters are proportional."""
        return {name: 2 * length + time for name, (_, length, time) in self.units.items()}

    def start(self, u):
        """The gap at the start: 0 after a flight (u > 0), κu where a contact resumes (u < 0)."""
        return np.where(np.real(u) < 0, self.kappa * u, 0.0)

    def _motion(self, given):
        def acceleration(p, v, t, given):
            load = given["gravity"] - given["amplitude"] * np.sin(given["tau"] + t)
            return load - self.force(p, v, **{name: given[name] for name in self.values})

        def release(q, v, t, given):
            if self.release == "displacement":
                return -q
            parameters = {name: given[name] for name in self.values}
            if self.lag:
                return -(q**self.root) - self.lag(**parameters) * v
            return -self.force(q**self.root, v, **parameters)

        return Motion(self.root, acceleration, release, (), given)

    def _ends(self, tau, u, amplitude, gravity, T=None):
        arguments = {"tau": tau, "u": u, "amplitude": amplitude, "gravity": gravity}
        if T is not None:
            arguments["T"] = T
        every = {**self.values, **arguments}
        names = [name for name in every if np.ndim(every[name]) or name in ("u", "T")]
        arrays = np.broadcast_arrays(*(every[name] for name in names))
        shape = arrays[0].shape
        columns = {
            name: array.reshape(-1, 1) for name, array in zip(names, arrays, strict=True)
        }
        given = {**every, **columns}
        dtype = np.result_type(*given.values(), float)
        v = given["u"].astype(dtype)
        limit = given.get("T")
        q = 0 * v
        motion = self._motion(given)
        if limit is None:
            first = self._first_length(given)
        else:
            first = np.real(limit) / 4
        ends = follow(motion, q, v, first, limit)
        return ends.reshape(4, *shape), motion

    def _first_length(self, given):
        u = np.real(given["u"])
        low, high = np.full(u.shape, -40.0), np.full(u.shape, 10.0)
        parameters = {name: np.real(given[name]) for name in self.values}
        for _ in range(10):
            middle = (low + high) / 2
            depth = np.exp(middle)
            soft = depth * self.force(depth, 0 * u, **parameters) < u * u
            low, high = np.where(soft, middle, low), np.where(soft, high, middle)
        return 0.3 * np.exp(low / self.root) / u

    def contact(self, tau, u, T, amplitude, gravity=1.0):
        """The state of the contact at the root time T, with its release function."""
        (_, q, v, t), motion = self._ends(tau, u, amplitude, gravity, T)
        return Impact(t, -(q**self.root), -v, -q if self.release == "displacement" else None)

    def free(self, u):
        """T of a free impact."""
        return self._ends(0.0, u, 0.0, 0.0)[0][0]

    def first_release(self, tau, u, amplitude, gravity=1.0):
        """T of the first release, NaN for a ball that stays in contact."""
        return self._ends(tau, u, amplitude, gravity)[0][0]

    def signature(self, u):
        """r, D, t_c and σ of free impacts."""
        raise NotImplementedError


def tsuji(stiffness=None, damping=None):
    """f = K p^{3/2} + C √K p^{1/4} p′."""

    def force(p, v, stiffness, damping):
        root = np.sqrt(p)
        return stiffness * p * root + damping * np.sqrt(stiffness) * np.sqrt(root) * v

    return ForceLaw(force, {"stiffness": stiffness, "damping": damping}, root=4)
