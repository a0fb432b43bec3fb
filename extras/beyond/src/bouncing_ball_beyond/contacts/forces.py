"""Force laws f(p, p′) of contacts: their parameters and units, and the depths that balls reach.

The force is per mass of the ball. p is the penetration, and p′ its rate. :mod:`.judge` judges a
force, and :mod:`.laws` computes contacts with it.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bouncing_ball_beyond.contacts.balls import Ball, H, brief, checked
from bouncing_ball_beyond.tables.table import Values

TAKEN = ("tau", "u", "T", "amplitude", "gravity", "turn", "after", "load", "start_speed")
"""Names that parameters of a law must not have."""

DEPTHS = np.exp(np.linspace(-46.0, 23.0, 257))
"""Depths p, from 1e-20 to 1e10, at which the energy of a force is computed.

With half as many: depths of balls change by 5 %. With twice as many: by 1 %.
"""

STEEP, LOWEST, HIGHEST, CLIMBS = 2.0, 1e-26, 1e12, 400
"""Change of ln f between neighbouring `DEPTHS` above which smaller steps are taken, energies at
which they begin and end, and their maximum number.

The energies belong to speeds of 1e-13 and 1e6.

`STEEP` at half: depths of balls change by 1 %. `STEEP` at twice, `CLIMBS` at half and at twice: no
effect.
"""

SURFACE, SLOW = 1e-60, 1e-9
"""Depth and rate at which a force tells whether it pulls at the surface when a ball leaves slowly.

The depth is so small that powers up to the fifth are above the smallest floating-point number."""

NEAREST = 1e-9
"""Smallest relative distance from a pole of the force. Half of the digits of the force are lost
there: a ball that comes nearer is not computed. At half and at twice: no effect."""


@dataclass(frozen=True, repr=False)
class Force(Ball):
    """Force of a contact, with the arguments of :class:`.ForceLaw`, which checks and follows it."""

    force: Callable
    values: Mapping
    root: int = 1
    release: str = "displacement"
    lag: Callable | None = None
    kinks: tuple = ()
    needs: tuple = ()
    units: Mapping = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.release not in ("displacement", "force"):
            raise ValueError(f"release = {self.release!r}: must be 'displacement' or 'force'")
        if not isinstance(self.root, int | np.integer) or (
            self.root != 1 and (self.root < 1 or self.root % 2)
        ):
            raise ValueError(f"root = {self.root!r}: must be 1 or an even number, 2, 4, 6, ...")
        if self.lag is not None and not (callable(self.lag) and self.release == "force"):
            raise ValueError(f"lag = {brief(self.lag)}: must be a function, with release='force'")
        for name, mapping in (("values", self.values), ("units", self.units)):
            if not isinstance(mapping, Mapping):
                raise ValueError(f"{name} = {brief(mapping)}: must be a dict by name of parameter")
        numbers = {
            name: checked(name, value, -np.inf, np.inf, low_allowed=False)
            for name, value in self.values.items()
        }
        object.__setattr__(self, "values", numbers)
        if not (isinstance(self.needs, tuple) and {*self.needs} <= {"load", "start_speed"}):
            raise ValueError(
                f"needs = {self.needs!r}: must be ('load',), ('start_speed',) or both in one tuple"
            )
        for name in self.units.keys() - self.values.keys():
            known = ", ".join(self.values)
            raise ValueError(f"units: {name} is not a parameter of the law: use {known}")
        for name, powers in self.units.items():
            if np.shape(powers) != (3,) or np.asarray(powers).dtype.kind not in "iuf":
                raise ValueError(
                    f"units: {name} = {brief(powers)}: must be the powers of mass, length and time,"
                    " such as (1, 0, -2) for N/m"
                )
        for name in self.values.keys() & set(TAKEN):
            raise ValueError(f"{name}: is a reserved name; choose another name for the parameter")
        if not (isinstance(self.kinks, tuple) and all(map(callable, self.kinks))):
            raise ValueError(
                f"kinks: must be a tuple of functions, such as kinks=(kink,), not"
                f" {type(self.kinks).__name__}"
            )

    def __repr__(self) -> str:
        values = ", ".join(f"{name}={value}" for name, value in self.values.items())
        return f"{self.force.__name__.lstrip('_')}({values})"

    @property
    def known_units(self) -> Mapping:
        """Units of all parameters. Raises ValueError if a parameter has no unit."""
        for name in self.values:
            if name not in self.units:
                raise ValueError(
                    f"units: needed here; give the powers of mass, length and time in the unit of"
                    f" {name}, such as units={{{name!r}: (1, 0, -2)}} for N/m"
                )
        return self.units

    @property
    def parameters(self) -> dict[str, Values]:
        return dict(self.values)

    def at(self, **values: Any) -> Any:
        """Return the law with other values of parameters, without checking them."""
        unknown = values.keys() - self.values.keys()
        if unknown:
            raise ValueError(
                f"{', '.join(sorted(unknown))}: no parameter of the law; its parameters:"
                f" {', '.join(self.values)}"
            )
        if not values:
            return self
        return self._with(values={**self.values, **values}, _origin=self._origin)

    def at_surface(self) -> Any:
        """Return the law with contacts that end at p = 0, without checking it."""
        return self._with(release="displacement")

    def _with(self, **new: Any) -> Any:
        law = object.__new__(type(self))
        vars(law).update(
            {attribute.name: getattr(self, attribute.name) for attribute in fields(self)}, **new
        )
        return law

    @cached_property
    def _origin(self) -> Any:
        arrays = {name: np.ravel(x)[0] for name, x in self.values.items() if np.ndim(x)}
        return replace(self, values={**self.values, **arrays}) if arrays else self

    @property
    def kappa(self) -> Values:
        """κ if the contact ends where p + κp′ = 0; otherwise 0."""
        return self.lag(**self.values) if self.lag else 0.0

    @property
    def frequency_powers(self) -> dict[str, Any]:
        """Exponents by name: a parameter of a given contact is proportional to Ω^exponent.

        Lengths are in units of g/Ω², and times in units of 1/Ω.
        """
        powers = {name: 2 * length + time for name, (_, length, time) in self.known_units.items()}
        return {name: power for name, power in powers.items() if power}

    def at_ratio(self, restitution: Values, centroid: Values) -> Callable:
        """Return a function that maps a number to the law. The number replaces ϖ."""
        share = np.pi * restitution / ((1 + restitution) * centroid)
        # If all lengths and times are γ times as large, f(p, p′) becomes f(p/γ, p′)/γ.
        powers = {name: length + time for name, (_, length, time) in self.known_units.items()}
        return lambda ratio: self.at(
            **{name: self.values[name] * (share / ratio) ** powers[name] for name in powers}
        )

    def in_si(self, mass: Values, length: Values, time: Values) -> dict[str, Values]:
        """Return the parameters in SI units.

        ``mass`` is in kg. ``length`` and ``time`` are the units of length and time in m and s.
        """
        return {
            name: self.values[name] * mass**of_mass * length**of_length * time**of_time
            for name, (of_mass, of_length, of_time) in self.known_units.items()
        }

    @np.errstate(divide="ignore")
    def depth(self, u: Values, load: Values = 0.0) -> Values:
        """Depth P at which the force f(p, 0) stops a ball with the speed u under a constant load.

        The energy ∫ f dp - aP equals u²/2. Damping makes the depth smaller. The result is NaN if
        there is no such depth.
        """
        p, energy = self.energies
        energy = np.maximum.accumulate(energy - load * p)
        x, y = (
            np.log(np.maximum(quantity, np.finfo(float).tiny)).reshape(len(p), -1)
            for quantity in (energy, p)
        )
        u = np.broadcast_to(u, np.broadcast_shapes(np.shape(u), p.shape[1:]))
        wanted = np.log(u * u / 2).reshape(-1, x.shape[1])
        logarithms = (
            np.interp(*columns, right=np.nan) for columns in zip(wanted.T, x.T, y.T, strict=True)
        )
        return np.exp(np.stack([*logarithms], axis=-1)).reshape(u.shape)[()]

    def check_stops(self, u: Values) -> None:
        """Raise ValueError if the force f(p, 0) stops no balls with the closing speeds u."""
        u = np.real(u)
        missed = np.isnan(self.depth(u)) & (u < np.inf)
        if np.any(missed):
            p, energy = self.energies
            raise ValueError(
                "force: without damping, f(p, 0) stops balls with closing speeds up to"
                f" {np.sqrt(2 * energy.max()):.3g} (followed to the depth {p.max():.3g}), but this"
                f" ball has {np.max(u, where=missed, initial=0.0):.4g}"
            )

    @cached_property
    @np.errstate(all="ignore")
    def energies(self) -> tuple[NDArray, NDArray]:
        """Depths p, and the energies ∫ f(p, 0) dp at them, shape (depths, ...) each.

        The depths are those of `DEPTHS` as long as the force changes slowly. Then steps follow that
        are shorter than f/f′, and cannot pass a pole of the force: the energy tends to infinity
        there, and the depths end.
        """
        values = {name: np.real(x) for name, x in self.values.items()}
        shape = np.broadcast_shapes(*map(np.shape, values.values()))
        given = values | {"u": 1.0}

        def force(p: NDArray) -> tuple[NDArray, NDArray]:
            along = self.force_at(p + 1j * H, 0 * p, 0.0, given)
            return along.real, along.imag / H

        p = np.tile(DEPTHS.reshape(-1, *(1 for _ in shape)), (1, *shape))
        f, slope = force(p)
        width = np.log(DEPTHS[1] / DEPTHS[0])
        # The integral of pf over ln p, by the trapezoidal rule with its first correction.
        push, bend = p * f, p * (f + p * slope)
        work = width * (push[1:] + push[:-1]) / 2 - width**2 * (bend[1:] - bend[:-1]) / 12
        energy = np.concatenate([push[:1], push[:1] + np.cumsum(work, axis=0)])
        power = p * slope / f
        change = np.log(f[1:] / f[:-1])
        bent = ~(np.abs(change - (power[1:] + power[:-1]) * width / 2) < 1 / STEEP)
        rough = (bent | (power[:-1] * width > STEEP)) & (f[:-1] > 0) & (energy[:-1] > LOWEST)
        places = np.flatnonzero(rough.reshape(len(rough), -1).any(axis=1))
        if not places.size:
            return p, energy
        first = places[0] + 1
        depths, energies = list(p[:first]), list(energy[:first])
        here, most = depths[-1], np.abs(f[:first]).max(axis=0)
        f, slope = f[first - 1], slope[first - 1]
        step = 0.3 * here
        for _ in range(CLIMBS):
            step = np.minimum(np.minimum(0.3 * here, 1.5 * step), most / (2 * np.abs(slope)))
            there = here + step
            after, bend = force(there)
            total = energies[-1] + step * (f + after) / 2 + step * step * (slope - bend) / 12
            # The force has no value beyond a wall, and few digits next to it.
            inside = np.isfinite(total) & (step > NEAREST * here) & (energies[-1] < HIGHEST)
            here, f, slope = (
                np.where(inside, *pair) for pair in ((there, here), (after, f), (bend, slope))
            )
            most = np.maximum(most, np.abs(f))
            depths.append(here)
            energies.append(np.where(inside, total, energies[-1]))
            if not np.any(inside & (here < DEPTHS[-1])):
                break
        return np.array(depths), np.array(energies)

    def force_at(self, p: Values, v: Values, a: Values, given: Mapping) -> Values:
        """Force f under the load a. ``given`` has the parameters and the closing speed u."""
        more = {"load": a, "start_speed": given["u"]}
        return self.force(p, v, **self.own(given), **{name: more[name] for name in self.needs})

    @cached_property
    def pulls(self) -> bool:
        """Whether the force pulls at the surface, however slowly a ball leaves.

        It then vanishes below the surface, as kp + cp′ does. Other forces, as kp or kp(1 + cp′),
        vanish at the surface, where contacts end at the latest.
        """
        given = {**self.values, "u": 1.0}
        force = self.force_at(np.array(SURFACE), np.array(-SLOW), 1.0, given)
        return bool(np.all(np.real(force) < 0))

    def grip(self, p: Values, v: Values, a: Values, given: Mapping) -> Values:
        """Grip of a contact that ends where its force ends.

        It is positive in the contact and has a simple zero at its end: f, or p f(p, p′)/f(p, 0).
        """
        if self.pulls or self.lag:
            return self.force_at(np.where(np.real(p) > SURFACE, p, SURFACE), v, a, given)
        return p * self.share(p, v, a, given)

    def share(self, p: Values, v: Values, a: Values, given: Mapping) -> Values:
        """f(p, p′)/f(p, 0), also at the surface."""
        near = np.where(np.real(p) > SURFACE, p, SURFACE)
        return self.force_at(near, v, a, given) / self.force_at(near, 0 * v, a, given)

    @property
    def has_two_ends(self) -> bool:
        """Whether contacts end at p = 0, or before where the force changes its sign."""
        return self.release == "force" and not (self.lag or self.pulls)

    def own(self, given: Mapping) -> dict[str, Values]:
        return {name: given[name] for name in self.values}

    def after_free_impacts(self, u: NDArray) -> NDArray:
        """Speeds after free impacts with the closing speeds u. :class:`.ForceLaw` computes them."""
        raise NotImplementedError
