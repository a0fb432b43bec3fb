"""Contacts of any force law: the ball whose contact has the force f(p, p′) per mass.

During a contact the penetration p = -δ obeys p″ = 1 - Λ sin τ - f. The contact ends where p = 0, or
where the force vanishes, so that it never pulls at the ball. The laws that have names are in
:mod:`.named_laws`; how the motion is found is in :mod:`.root_time`.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import ClassVar

import numpy as np
from numpy.polynomial import chebyshev, legendre

from bouncing_ball_beyond.balls import Ball, H, Impact, Signature
from bouncing_ball_beyond.root_time import Motion, follow, load, rows_of

SLOWEST = 1e-12
"""A ball that is laid on the table, without a speed, is given this one, because p would stay zero."""

TAKEN = ("tau", "u", "T", "amplitude", "gravity", "turn", "load", "start_speed")
"""Names that parameters must not have."""

LIMITS = (-46.0, 23.0)
"""The range of ln p in which the depth of an impact is looked for: p from 1e-20 to 1e10."""

FIRST_PANEL = 0.4
"""The length of the first panel of a contact in units of P^{1/m}/u."""

FACTOR, DEGREE = 8.0, 23
"""The range of speeds of an interpolation of signatures, and its degree: with a pole of r at ln u = x ± iπ,
like that of 1/(1 + Cu), the error is of the order of 6⁻²⁴."""

SHIFTS = np.array([-3.0, -2.0, -1.0, 1.0, 2.0, 3.0])
WEIGHTS = np.array([-1.0, 9.0, -45.0, 45.0, -9.0, 1.0]) / 60
SHIFT = 0.02
"""Central differences of the sixth order with relative steps h of 2 %. They are wrong by h⁶/140 of
the seventh derivative, 5e-13, and by rounding over h, 1e-14."""


@dataclass(frozen=True, repr=False)
class ForceLaw(Ball):
    """A contact with a force of any law.

    Parameters
    ----------
    force : callable
        The force per mass ``force(p, v, **values)`` at the penetration p and its rate v = p′: numpy
        arrays, also complex ones, because all derivatives are complex steps. It is therefore
        written with analytic functions, without ``abs`` and ``real``, but may be made of several
        by ``np.where``, if its kinks are declared.
    values : mapping
        The parameters of the force by their names: numbers, or arrays for a row of balls.
    root : int
        m: the force is an analytic function of p^{1/m}. 1 if it is smooth at p = 0, 2 if it has powers of
        √p, such as that of Hertz, 4 if it has powers of p^{1/4}.
    release : {"displacement", "force"}
        Contacts end where p = 0, or where the force vanishes.
    lag : callable, optional
        If the force vanishes where p + κp′ = 0, the function ``lag(**values)`` with κ.
    kinks : tuple of callables
        Functions ``kink(p, v, **values)`` that change their sign where the force has a kink.
    needs : tuple of str
        "start_speed" if the force also gets, by this name, the speed at the start of its contact; "load" if
        it gets the load a = 1 - Λ sin τ.
    units : mapping
        The powers of mass, length and time in the unit of each parameter.

    Raises
    ------
    ValueError
        If the force is not a function as described; one line says where.

    Examples
    --------
    A rubber bumper, a hardening spring with the damping of Hunt and Crossley:

    >>> def force(p, v, stiffness, hardening, damping):
    ...     return stiffness * p * (1 + hardening * p**2) * (1 + damping * v)
    >>> bumper = ForceLaw(force, {"stiffness": 400.0, "hardening": 10.0, "damping": 0.05})
    >>> round(float(bumper.signature(3.0).restitution), 4)
    0.9066
    """

    force: Callable
    values: Mapping
    root: int = 1
    release: str = "displacement"
    lag: Callable | None = None
    kinks: tuple = ()
    needs: tuple = ()
    units: Mapping = field(default_factory=dict)

    lasts: ClassVar[bool] = True

    def __post_init__(self):
        if self.release not in ("displacement", "force"):
            raise ValueError(f"release = {self.release!r}: must be 'displacement' or 'force'")
        if self.root != 1 and (self.root < 1 or self.root % 2):
            raise ValueError(f"root = {self.root!r}: must be 1 or an even number")
        for name in self.values.keys() & set(TAKEN):
            raise ValueError(f"{name}: is no name for a parameter of a law; choose another")
        check_force(self)

    def __repr__(self):
        values = ", ".join(f"{name}={value}" for name, value in self.values.items())
        return f"{self.force.__name__.lstrip('_')}({values})"

    @property
    def parameters(self):
        """Names and values of the parameters of the force."""
        return dict(self.values)

    def at(self, **values):
        """The same law with other values of parameters, which are not checked."""
        unknown = values.keys() - self.values.keys()
        if unknown:
            raise ValueError(
                f"{', '.join(sorted(unknown))}: no parameter of the law, which has"
                f" {', '.join(self.values)}"
            )
        if not values:
            return self
        new = object.__new__(type(self))
        own = {each.name: getattr(self, each.name) for each in fields(self)}
        vars(new).update(own, values={**self.values, **values})
        return new

    @property
    def kappa(self):
        """κ of a release where p + κp′ = 0; 0 for other releases."""
        return self.lag(**self.values) if self.lag else 0.0

    @property
    def frequency_powers(self):
        """Powers of Ω to which parameters are proportional for one contact, by their units.

        Lengths are measured in g/Ω² and times in 1/Ω.
        """
        powers = {name: 2 * length + time for name, (_, length, time) in self.units.items()}
        return {name: power for name, power in powers.items() if power}

    def in_si(self, mass, length, time):
        """The parameters in SI units, for a mass in kg and the units of length in m and of time in s."""
        return {
            name: self.values[name] * mass**of_mass * length**of_length * time**of_time
            for name, (of_mass, of_length, of_time) in self.units.items()
        }

    def start(self, u):
        """The gap at the start: 0 after a flight (u > 0), κu where a contact resumes (u < 0)."""
        return np.where(np.real(u) < 0, self.kappa * u, 0.0)

    def contact(self, tau, u, T, amplitude, gravity=1.0):
        """The state of the contact at the root time T, with its release function."""
        return self._followed(tau, u, amplitude, gravity, T)[1]

    def first_release(self, tau, u, amplitude, gravity=1.0):
        """T of the first releases; NaN for balls that stay in contact."""
        return self._followed(tau, u, amplitude, gravity)[0]

    def first_impact(self, tau, u, amplitude, gravity=1.0):
        """T of the first releases, and the impacts."""
        return self._followed(tau, u, amplitude, gravity)

    def free(self, u):
        """T of free impacts, without a table and gravity."""
        return self._followed(0.0, u, 0.0, 0.0)[0]

    def signature(self, u):
        """r, D, t_c and σ of free impacts.

        A law without kinks interpolates them and their derivatives in ln u by polynomials, on ranges
        of a factor of :data:`FACTOR` in u that are computed when they are first needed.
        """
        u = np.asarray(u)
        fixed = all(np.ndim(x) == 0 and np.isrealobj(x) for x in self.values.values())
        if self.kinks or not fixed or not np.all(u.real > 0):
            return self.computed_signature(u)
        number = np.floor(np.log(u.real) / np.log(FACTOR))
        found = np.full((4, *u.shape), np.nan, u.dtype)
        for k in np.unique(number[np.isfinite(number)]):
            at = number == k
            found[:, at] = self._interpolated(k, u[at])
        return Signature(*found)

    def _interpolated(self, number, u):
        """The signature at speeds in one of the ranges of the interpolation."""
        if number not in self._ranges:
            points = chebyshev.chebpts1(DEGREE + 1)
            speeds = FACTOR ** (number + (points + 1) / 2)
            values = np.array(self.computed_signature(speeds * (1 + 1j * H)))
            both = np.concatenate([values.real, values.imag / H]).T
            self._ranges[number] = np.linalg.solve(chebyshev.chebvander(points, DEGREE), both)
        if np.isnan(self._ranges[number]).any():
            return np.array(self.computed_signature(u))
        x = 2 * (np.log(u.real) / np.log(FACTOR) - number) - 1
        both = chebyshev.chebval(x, self._ranges[number])
        return both[:4] + 1j * both[4:] * (u.imag / u.real) if np.iscomplexobj(u) else both[:4]

    @cached_property
    def _ranges(self):
        """Coefficients of the interpolation by the numbers of the ranges."""
        return {}

    @np.errstate(invalid="ignore")
    def computed_signature(self, u):
        """As :meth:`signature`, by free impacts at each speed and parameter.

        The impulse J = u + w + aD of an impact of the speed u under a constant load a gives
        σ = ∂J/∂a - t_c ∂J/∂u, both at a = 0. The derivatives are differences, so that complex steps
        of u and of the parameters pass through.
        """
        u = np.asarray(u)[..., np.newaxis]
        law = self.at(**{name: np.asarray(x)[..., np.newaxis] for name, x in self.values.items()})
        speeds = u * np.append(1 + SHIFT * SHIFTS, 1.0)
        impact = law.first_impact(0.0, speeds, 0.0, 0.0)[1]
        by_speed = (speeds + impact.speed)[..., :6] @ WEIGHTS / (SHIFT * u[..., 0])
        gap, speed, duration = (x[..., 6] for x in (impact.gap, impact.speed, impact.duration))
        # A load that would stop the ball, within a duration of the contact, after it has left.
        load = SHIFT * np.real(speed / duration)[..., np.newaxis]
        loaded = law.first_impact(0.0, u, 0.0, load * SHIFTS)[1]
        by_load = (loaded.speed + load * SHIFTS * loaded.duration) @ WEIGHTS / load[..., 0]
        r = speed / u[..., 0]
        centroid = r * (duration - gap / speed) / (1 + r)
        return Signature(r, duration, centroid, by_load - centroid * by_speed)

    def depth(self, u):
        """About the depth P at which the force would stop a ball of the speed u: P f(P, 0) = u²."""
        given = {name: np.real(x) for name, x in self.values.items()} | {"u": u}
        shape = np.broadcast_shapes(*(np.shape(x) for x in given.values()))
        low, high = (np.full(shape, end) for end in LIMITS)
        for _ in range(9):
            middle = (low + high) / 2
            depth = np.exp(middle)
            soft = depth * self.force_at(depth, 0 * depth, 0.0, given) < u * u
            low, high = np.where(soft, middle, low), np.where(soft, high, middle)
        return np.exp(low)

    def force_at(self, p, v, a, given):
        """f under the load a; the parameters and the speed u at the start are among what is given."""
        more = {"load": a, "start_speed": given["u"]}
        return self.force(p, v, **self._own(given), **{name: more[name] for name in self.needs})

    def _own(self, given):
        """The parameters of the law among what is given."""
        return {name: given[name] for name in self.values}

    def _release(self, q, v, t, given):
        """The release function: -q, or (-κp′)^{1/m} - q, or -f."""
        if self.release == "displacement":
            return -q
        if self.lag:
            # q at which p + κp′ = 0, so that the zero is a simple one for κ = 0 as well.
            return (self.lag(**self._own(given)) * np.maximum(-v, 0.0)) ** (1 / self.root) - q
        return -self.force_at(q**self.root, v, load(t, given), given)

    def _followed(self, tau, u, amplitude, gravity, T=None):
        """The root time and the state at the root time T or at the first release."""
        values = {**self.values, "tau": tau, "u": u, "amplitude": amplitude, "gravity": gravity}
        rows = rows_of(values if T is None else values | {"T": T})
        given, none = rows.given, np.zeros((rows.size, rows.directions))
        kinks = (
            lambda q, v, t, given, kink=kink: kink(q**self.root, v, **self._own(given))
            for kink in self.kinks
        )
        motion = Motion(self.root, self.force_at, self._release, tuple(kinks), given, rows.steps)
        # Where a contact resumes, the ball moves away, u < 0, from the line p + κp′ = 0.
        stepped = motion.stepped()
        kappa = self.at(**self._own(stepped)).kappa
        start = (-kappa * np.minimum(stepped["u"], 0.0)) ** (1 / self.root)
        by = np.array([np.imag(start) + none, rows.steps.get("u", none)])
        u = given["u"] = np.where(np.abs(given["u"]) < SLOWEST, SLOWEST, given["u"])
        if T is None:
            depth = self.at(**self._own(given)).depth(u)
            first = FIRST_PANEL * depth ** (1 / self.root) / np.abs(u)
        else:
            first = given["T"] / (self.root + 2)
        limits = given.get("T"), rows.steps.get("T", none)
        s, q, v, t = rows.joined(*follow(motion, np.real(start)[:, 0], u, by, first, *limits))
        return s, Impact(t, -(q**self.root), -v, self._release(q, v, t, values))


def check_force(law):
    """Raise ValueError, in one line, unless the force of a law is as :class:`ForceLaw` describes it.

    Along lines of constant rates and of constant depths the change of the force between neighbours must
    be the integral of its derivative by complex steps. It is not where the force is not analytic, and
    over a kink.
    """
    given = {name: np.ravel(np.real(x))[0] for name, x in law.values.items()} | {"u": 1.0}
    try:
        probe = law.force_at(np.array([1.0 + 1j * H]), np.array([1.0 + 0j]), 0.0, given)
    except Exception as error:
        reason = f"{type(error).__name__}: {error}"
        raise ValueError(f"force: fails for arrays of complex numbers ({reason})") from None
    if np.shape(probe) != (1,):
        raise ValueError(f"force: must have the shape of p and v, not {np.shape(probe)} for (1,)")
    with np.errstate(all="ignore"):
        depth = float(law.at(**{name: given[name] for name in law.values}).depth(1.0))
        if not LIMITS[0] + 1 < np.log(depth) < LIMITS[1] - 1:
            raise ValueError("force: stops no ball of the speed 1 at any depth")
        depths, rates = depth * np.geomspace(1e-3, 30.0, 321), np.linspace(-3.003, 3.0, 241)
        some_rates = np.array([-1.9, -0.4, 0.3, 1.7])[:, np.newaxis]
        some_depths = depth * np.array([0.02, 0.3, 1.1, 8.0])[:, np.newaxis]
        _check_line(law, given, "p", depths, lambda p: (p + 0 * some_rates, some_rates + 0 * p))
        _check_line(law, given, "v", rates, lambda v: (some_depths + 0 * v, v + 0 * some_depths))
        _check_root(law, given, depth)


def _check_line(law, given, name, x, place):
    """Compare the changes of the force along lines with the integrals of its complex steps."""

    def force(x):
        return law.force_at(*place(x), 1.0, given)

    def side(x):
        return np.array([np.sign(kink(*place(x), **law._own(given))) for kink in law.kinks])

    nodes, weights = legendre.leggauss(4)
    width = np.diff(x)
    inner = x[:-1, np.newaxis] + width[:, np.newaxis] * (nodes + 1) / 2
    slopes = force(inner.ravel() + 1j * H).imag / H
    expected = slopes.reshape(-1, *inner.shape) @ weights / 2 * width
    values = force(x)
    change = np.diff(values)
    scale = np.abs(change) + 1e-6 * np.abs(values[:, 1:])
    wrong = np.abs(change - expected) > 1e-5 * scale
    if law.kinks:
        wrong &= (side(x)[..., 1:] * side(x)[..., :-1] > 0).all(0)
    if not wrong.any():
        return
    line, at = np.argwhere(wrong)[0]
    where = ", ".join(
        f"{n} = {each.flat[0]:.3g}"
        for n, each in zip("pv", (y[line, at] for y in place(x)), strict=True)
    )
    if np.count_nonzero(wrong) > 8:
        raise ValueError(
            f"force: is not analytic in {name} at {where}, where its derivative is"
            f" {change[line, at] / width[at]:.4g} by a difference and"
            f" {expected[line, at] / width[at]:.4g} by a complex step; write it without abs, real and sign"
        )
    raise ValueError(
        f"force: has a kink or a jump near {where}; declare kinks=(function, …) with a zero there"
    )


def _check_root(law, given, depth):
    """Whether the force is an analytic function of q = p^{1/m} at q = 0."""

    def falls(root):
        """Whether the Legendre coefficients of f on a short range of q fall as those of an analytic function."""
        q = ((legendre.leggauss(24)[0] + 1) / 2) * (0.01 * depth) ** (1 / root)
        values = law.force_at(q**root, 0.5 + 0 * q, 1.0, given)
        sizes = np.abs(np.linalg.solve(legendre.legvander(legendre.leggauss(24)[0], 23), values))
        return sizes[-4:].max() <= max(1e-12 * sizes.max(), 1e-3 * sizes[8:12].max())

    if not falls(law.root):
        others = [m for m in (1, 2, 4, 6, 8) if falls(m)]
        hint = f"; root={others[0]} would do" if others else ""
        raise ValueError(f"force: is not an analytic function of p^(1/{law.root}) at p = 0{hint}")
