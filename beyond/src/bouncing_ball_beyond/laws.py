"""Contacts of any force law, and the laws that have names."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from bouncing_ball_beyond.balls import H, Ball, Impact, Signature
from bouncing_ball_beyond.root_time import Motion, follow


FIRST = 0.4


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

    def _parameters(self, given):
        return {name: given[name] for name in self.values}

    def _force(self, p, v, a, given):
        return self.force(p, v, **self._parameters(given))

    def _release(self, q, v, a, given):
        if self.release == "displacement":
            return -q
        if self.lag:
            return -(q**self.root) - self.lag(**self._parameters(given)) * v
        return -self._force(q**self.root, v, a, given)

    def _ends(self, tau, u, amplitude, gravity, T=None):
        arguments = {"tau": tau, "u": u, "amplitude": amplitude, "gravity": gravity}
        if T is not None:
            arguments["T"] = T
        every = {**self.values, **arguments}
        arrays = [np.asarray(value) for value in every.values()]
        shape = np.broadcast_shapes(*(array.shape for array in arrays))
        is_complex = any(map(np.iscomplexobj, arrays))
        beside = bool(shape) and all(
            array.ndim < len(shape) or (array.real == array.real[:1]).all() for array in arrays
        )
        inner = shape[1:] if is_complex and beside else shape
        count = (shape[0] if beside else 1) if is_complex else 0
        given, steps = {}, {}
        for name, array in zip(every, arrays, strict=True):
            if np.ndim(array) or name in arguments:
                real = array.real[0] if array.ndim > len(inner) else array.real
                given[name] = np.broadcast_to(real, inner).ravel()
            else:
                given[name] = array.real[()]
            if is_complex and np.iscomplexobj(array) and array.imag.any():
                step = np.broadcast_to(array.imag, (count, *inner) if beside else (1, *inner))
                steps[name] = step.reshape(count, -1).T
                given[name] = np.broadcast_to(given[name], steps[name].shape[0])
        u, limit = given["u"], given.get("T")
        none = np.zeros((u.size, count))
        by = np.array([none, steps.get("u", none)])
        motion = Motion(self.root, self._force, self._release, (), given, steps)
        first = self._first_length(given) if limit is None else limit / (self.root + 2)
        ends, by = follow(motion, 0 * u, u, by, first, limit, steps.get("T", none))
        if is_complex:
            ends = ends[:, None] + 1j * np.moveaxis(by, -1, 1)
        return ends.reshape(4, *shape)

    def _first_length(self, given):
        u = given["u"]
        low, high = np.full(u.shape, -40.0), np.full(u.shape, 10.0)
        for _ in range(10):
            middle = (low + high) / 2
            depth = np.exp(middle)
            soft = depth * self._force(depth, 0 * u, 0.0, given) < u * u
            low, high = np.where(soft, middle, low), np.where(soft, high, middle)
        return FIRST * np.exp(low / self.root) / u

    def contact(self, tau, u, T, amplitude, gravity=1.0):
        """The state of the contact at the root time T, with its release function."""
        _, q, v, t = self._ends(tau, u, amplitude, gravity, T)
        return Impact(t, -(q**self.root), -v, -q if self.release == "displacement" else None)

    def free(self, u):
        """T of a free impact."""
        return self._ends(0.0, u, 0.0, 0.0)[0]

    def first_release(self, tau, u, amplitude, gravity=1.0):
        """T of the first release, NaN for a ball that stays in contact."""
        return self._ends(tau, u, amplitude, gravity)[0]

    def signature(self, u):
        """r, D, t_c and σ of free impacts."""
        raise NotImplementedError


def tsuji(stiffness=None, damping=None):
    """f = K p^{3/2} + C √K p^{1/4} p′."""

    def force(p, v, stiffness, damping):
        root = np.sqrt(p)
        return stiffness * p * root + damping * np.sqrt(stiffness) * np.sqrt(root) * v

    return ForceLaw(force, {"stiffness": stiffness, "damping": damping}, root=4)
