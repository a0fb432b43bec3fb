"""Contacts with any force law f(p, p′), the force per mass of the ball.

During a contact the penetration p = -δ obeys p″ = 1 + w″ - f, where w″ is the acceleration of the
table. The contact ends where p = 0, or where the force vanishes. If the contact ends where the
force vanishes, the force never pulls at the ball. :mod:`.named_laws` has laws with names.

:mod:`.root_time` computes the motion in the root time. T is the root time from the start of a
contact to its end, the release. A free impact takes place without gravity on a table at rest. Its
signature is r, D, t_c and σ (:class:`.Signature`).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
from numpy.polynomial import chebyshev, legendre
from numpy.typing import NDArray

from bouncing_ball_beyond.contacts.balls import (
    H,
    Impact,
    Signature,
    broadcast_named,
)
from bouncing_ball_beyond.contacts.forces import SURFACE, Force
from bouncing_ball_beyond.contacts.judge import FIRST_LOAD, FIRST_SPEED, check_force, judge
from bouncing_ball_beyond.contacts.one_ball import SLOWEST
from bouncing_ball_beyond.contacts.root_time import (
    FEW_CONTACTS,
    PERIODS,
    WHOLE,
    ContactMotion,
    Guess,
    Rows,
    event_rate,
    integrate_contacts,
    integrate_to,
    linearize,
    load_of,
    rates,
    sampled,
    values_by_row,
    whole_panel,
)
from bouncing_ball_beyond.tables.table import SINE, Table, Values

FIRST_PANEL = 0.4
"""Length of the first panel of a contact, in units of P^{1/m}/u, where P is the `depth`.

At half and at twice this length, the number of evaluations of the force changes by 3 %.
"""

SIGNATURE_FACTOR, SIGNATURE_DEGREE = 8.0, 23
"""Factor in speed that one polynomial for signatures covers, and degree of this polynomial.

For example, r = 1/(1 + Cu) has poles at ln u = x ± iπ. The error is then of the order of 6⁻²⁴.

At half of the degree: errors of 6e-9. At twice: 15 % slower.
"""

GUESS_FACTOR = 2.0
"""Ratio of the largest to the smallest speed of contacts that one free impact approximates.

At half and at twice: no effect.
"""

SPARE = 1e-9
"""Limit of the last Legendre coefficients of v of a free impact, divided by its closing speed. If
they are smaller, fewer Gauss nodes are enough. At half and at twice: no effect."""

ALIKE = 1e-11
"""Largest relative difference of two forces that are equal within rounding.

At half and at twice: no effect.
"""

SHIFTS = np.array([-3.0, -2.0, -1.0, 1.0, 2.0, 3.0])
WEIGHTS = np.array([-1.0, 9.0, -45.0, 45.0, -9.0, 1.0]) / 60
SHIFT = 0.02
"""Central differences of the sixth order with the relative step h = 2 %.

They have an error of h⁶/140 times the seventh derivative, about 5e-13. They also have rounding
errors divided by h, about 1e-14.

At half: signatures change by 6e-13. At twice: by 4e-11.
"""


@dataclass(frozen=True, repr=False)
class ForceLaw(Force):
    """Ball whose contacts have any force law.

    Parameters
    ----------
    force : callable
        Force per mass ``force(p, v, **values)`` at the penetration p and its rate v = p′. p and v
        are real or complex numpy arrays, because derivatives are computed by complex steps. The
        function must be analytic, so write it without ``abs`` and ``real``. ``np.where`` may join
        analytic pieces if the force is continuous there, and ``kinks`` declares the kinks between
        them. A force that jumps must be replaced by a smooth force (docs/laws.md).
    values : mapping
        Parameters of the force by name. They are numbers, or arrays for a row of balls.
    root : int
        Number m for which the force is an analytic function of p^{1/m}: 1 or an even number. It is
        1 if the force is smooth at p = 0. It is 2 for powers of √p, as in Hertz' law, and 4 for
        powers of p^{1/4}. For powers of p^{1/3} it is 6.
    release : {"displacement", "force"}
        If "displacement", contacts end where p = 0. If "force", they end where the force changes
        its sign, and at p = 0 at the latest.
    lag : callable, optional
        Function ``lag(**values)`` that returns κ. Give it if the force vanishes where p + κp′ = 0,
        and ends contacts there (release "force").
    kinks : tuple of callables
        Functions ``kink(p, v, **values)`` that change their sign where the force has a kink: it is
        continuous, but its derivatives jump.
    needs : tuple of str
        Additional keyword arguments of the force: "start_speed" is the closing speed at the
        start of the contact, and "load" is the load a = 1 + w″.
    units : mapping
        Powers of mass, length and time in the unit of each parameter. They are needed if the
        frequency of the table or the stiffness of the contact changes.

    Raises
    ------
    ValueError
        If the force does not meet these requirements. The message says which one, and where.

    Examples
    --------
    A rubber bumper, a hardening spring with the damping of Hunt and Crossley:

    >>> def force(p, v, stiffness, hardening, damping):
    ...     return stiffness * p * (1 + hardening * p**2) * (1 + damping * v)
    >>> bumper = ForceLaw(force, {"stiffness": 400.0, "hardening": 10.0, "damping": 0.05})
    >>> round(float(bumper.signature(3.0).restitution), 4)
    0.909
    """

    has_duration: ClassVar[bool] = True

    def __post_init__(self) -> None:
        super().__post_init__()
        check_force(self)

    @cached_property
    @np.errstate(all="ignore")
    def _scales(self) -> NDArray | None:
        """Units of length and time in which the force equals the force of `_origin`.

        If possible, both units change by the same factor, and speeds then keep their values. The
        result is None if there are no such units. They follow from the units of the parameters; the
        force is compared because these may be wrong.
        """
        origin = self._origin
        if self is origin:
            return np.ones(2)
        values = np.array(broadcast_named(self.values.items()))
        if np.iscomplexobj(values):
            return None
        known = np.reshape([*origin.values.values()], (-1, *(1 for _ in values.shape[1:])))
        logarithms = np.log(np.where(values == known, 1.0, values / known))
        # A parameter that is zero has the same value in all units.
        powers = np.array([self.units.get(name, (0, 0, 0))[1:] for name in self.values])
        powers[[value == 0 for value in origin.values.values()]] = 0
        p = origin.depth(1.0) * np.array([0.03, 0.7, 2.0])
        v = np.array([0.8, -0.3, -1.1])
        force = origin.force_at(p, v, 1.3, {**origin.values, "u": 1.0})
        given = dict(zip(self.values, values[..., np.newaxis], strict=True))
        for change in (np.ones((2, 1)), np.eye(2)):
            inverse = change @ np.linalg.pinv(powers @ change)
            explained = np.tensordot(powers @ inverse, logarithms, 1)
            if not np.allclose(explained, logarithms, ALIKE, ALIKE):
                continue
            scales = np.exp(np.tensordot(inverse, logarithms, 1))
            length, time = scales[..., np.newaxis]
            speed = length / time
            scaled = self.force_at(p * length, v * speed, 1.3 * speed / time, given | {"u": speed})
            if np.allclose(scaled * time / speed, force, rtol=ALIKE, atol=0.0):
                return scales
        return None

    def contact(
        self,
        tau: Values,
        u: Values,
        T: Values,
        amplitude: Values,
        gravity: Values = 1.0,
        table: Table = SINE,
    ) -> Impact:
        """State of the contact at the root time T, with the release function."""
        self._judge(u, amplitude, table)
        return self._followed(tau, u, amplitude, gravity, T, table=table)[1]

    def first_release(
        self,
        tau: Values,
        u: Values,
        amplitude: Values,
        gravity: Values = 1.0,
        periods: Values = PERIODS,
        table: Table = SINE,
    ) -> Values:
        """T of the first release; NaN if a contact lasts longer than ``periods`` periods."""
        return self.first_impact(tau, u, amplitude, gravity, periods, table)[0]

    def first_impact(
        self,
        tau: Values,
        u: Values,
        amplitude: Values,
        gravity: Values = 1.0,
        periods: Values = PERIODS,
        table: Table = SINE,
    ) -> tuple[Values, Impact]:
        self._judge(u, amplitude, table)
        return self._followed(tau, u, amplitude, gravity, longest=periods, table=table)

    def leaves(self, tau: Values, u: Values, amplitude: Values, table: Table = SINE) -> tuple:
        """T, D, δ and δ′ as in :meth:`.Ball.leaves`. Raises ValueError if a ball is not stopped."""
        self.check_stops(u)
        return super().leaves(tau, u, amplitude, table)

    def contact_after(
        self, tau: Values, u: Values, time: Values, amplitude: Values, table: Table = SINE
    ) -> tuple[Values, Values]:
        """δ and δ′ at the given time after the start of a contact."""
        given = {"tau": tau, "u": u, "after": time, "amplitude": amplitude, "gravity": 1.0}
        rows, motion, start, by = self._started(given, table)
        after = rows.given.pop("after")
        moves = np.flatnonzero(after > 0)
        depth = self.at(**self.own(rows.given)).depth(rows.given["u"])
        first = (FIRST_PANEL * depth ** (1 / self.root) / np.abs(rows.given["u"]))[moves]
        some = motion.of(moves), start[:, moves], by[..., moves], first, after[moves]
        state = np.array([*start])
        state[:, moves] = integrate_contacts(*some, after=after[moves])[0][1:3]
        q, v = state.reshape(2, *rows.shape)
        return -(q**self.root), -v

    def after_free_impacts(self, u: NDArray) -> NDArray:
        return self._followed(0.0, u, 0.0, 0.0)[1].speed

    def free(self, u: Values) -> Values:
        """T of free impacts, which take place without gravity on a table at rest."""
        u = np.asarray(u)
        if self._scales is None or self.kinks or np.iscomplexobj(u) or not np.all(u > 0):
            return self._followed(0.0, u, 0.0, 0.0)[0]
        length, time = self._scales
        scaled_duration = self._origin.known_signature(u * (time / length))[8]
        return time * length ** (1 / self.root - 1) * scaled_duration

    def signature(self, u: Values) -> Signature:
        """r, D, t_c and σ of free impacts with the closing speeds u > 0; NaN for other u.

        The computation is shared by laws that differ only in the units of length and time.
        """
        u = np.where(np.real(u) > 0, u, np.nan)
        self.check_stops(u)
        if self._scales is None or not np.all(u.real > 0):
            return self.computed_signature(u)
        length, time = self._scales
        speed = u * (time / length)
        known = self._origin.known_signature(speed.real)
        quantities = known[:4]
        if np.iscomplexobj(u):
            quantities = quantities + 1j * known[4:8] * (u.imag / u.real)
        return Signature(quantities[0], *(time * quantity for quantity in quantities[1:]))

    def known_signature(self, u: Values) -> NDArray:
        """Signature of one ball, its derivatives, and T at real speeds, shape (9, ...).

        The rows are the four quantities q of the signature, their derivatives u dq/du, and T. For a
        law without kinks each row is a polynomial in ln u. Each polynomial covers a range of a
        factor `SIGNATURE_FACTOR` in u. Other signatures are computed once for each speed.
        """
        if self.kinks:
            return self._remembered(u)
        number = np.floor(np.log(u) / np.log(SIGNATURE_FACTOR))
        rows = np.full((9, *u.shape), np.nan)
        for k in np.unique(number[np.isfinite(number)]):
            at = number == k
            if k not in self._ranges:
                self._ranges[k] = self._range(k)
            coefficients = self._ranges[k]
            if coefficients is None:
                rows[:, at] = self._remembered(u[at])
            else:
                x = 2 * (np.log(u[at]) / np.log(SIGNATURE_FACTOR) - k) - 1
                rows[:, at] = chebyshev.chebval(x, coefficients)
        return rows

    def _remembered(self, u: NDArray) -> NDArray:
        """Compute :meth:`known_signature` at the speeds that were not asked for before."""
        logarithms, place = np.unique(np.log(u).round(13), return_inverse=True)
        new = [x for x in logarithms.tolist() if x not in self._signatures]
        if new:
            self._signatures.update(zip(new, self._computed(np.exp(new)).T, strict=True))
        columns = np.array([self._signatures[x] for x in logarithms.tolist()])
        return columns.T[:, place.reshape(u.shape)]

    def _computed(self, u: Values) -> NDArray:
        """Compute :meth:`known_signature` from a free impact at each speed."""
        values = np.array(self.computed_signature(u * (1 + 1j * H)))
        scaled_duration = self._followed(0.0, u, 0.0, 0.0)[0]
        return np.concatenate([values.real, values.imag / H, scaled_duration[np.newaxis]])

    def _range(self, number: float) -> NDArray | None:
        """Find the polynomials of :meth:`known_signature` for one range of speeds.

        The result is None if a free impact at an end of the range has no release, if the force is
        refused at one of its speeds, or if the
        polynomials of r, D and t_c do not converge, for example because the force has a steep step.
        """
        points = chebyshev.chebpts1(SIGNATURE_DEGREE + 1)
        speeds = SIGNATURE_FACTOR ** (number + (points + 1) / 2)
        if np.isnan(self._followed(0.0, speeds[[0, -1]], 0.0, 0.0)[0]).any():
            return None
        try:
            computed = self._computed(speeds)
        except ValueError:
            # The force is not right at all speeds of the range.
            return None
        polynomials = np.linalg.solve(chebyshev.chebvander(points, SIGNATURE_DEGREE), computed.T)
        sizes = np.abs(polynomials[:, :3])
        return polynomials if np.all(sizes[-2:] < ALIKE * sizes.max(axis=0)) else None

    @np.errstate(all="ignore")
    def guess(self, u: NDArray, T: NDArray) -> Guess | None:
        """Return free impacts as a first guess for contacts with the speeds u and root times T.

        The speeds of the free impacts differ from u by a factor of at most √2. The result is None
        if a free impact has no release.
        """
        numbers, which = np.unique(np.floor(np.log(u) / np.log(GUESS_FACTOR)), return_inverse=True)
        for k in set(numbers) - self._free_impacts.keys():
            self._free_impacts[k] = self._free_impact(GUESS_FACTOR ** (k + 0.5))
        most = min(len(self._free_impacts[k]) for k in numbers)
        if not most:
            return None
        known = [self._free_impacts[k][-most] for k in numbers]
        push = np.stack([push for push, _ in known], axis=-1)[:, which]
        return Guess(WHOLE[-most], push * (u / T), which, [inverse for _, inverse in known])

    def _free_impact(self, u: float) -> list[tuple[NDArray, NDArray]]:
        """F of a free impact, in units of u/T, and the inverse matrix of its linear equations.

        The list has one such pair for each set of nodes in :data:`WHOLE` that is fine enough, and
        always a pair for the finest set. It is empty if the free impact has no release.
        """
        *_, finest = WHOLE
        T = np.ravel(self.free(np.array([u])))
        if np.isnan(T).any():
            return []
        _, impact = self._followed(0.0, u, 0.0, 0.0, T * finest.nodes, guessed=False)
        duration, gap, speed, _ = impact
        states = np.stack([(-gap) ** (1 / self.root), -speed, duration], axis=1)
        coefficients = finest.coefficients @ states
        at_rest = {**self.values, "tau": 0.0, "u": u, "amplitude": 0.0, "gravity": 0.0}
        at_rest["table"] = SINE
        motion = ContactMotion(self.root, self.force_at, self._release, (), at_rest, {})
        pairs = []
        for gauss in WHOLE:
            order = gauss.nodes.size
            if gauss is finest or np.abs(coefficients[order - 2 :, 1]).max() < SPARE * u:
                nodes = legendre.legval(2 * gauss.nodes - 1, coefficients)[..., np.newaxis]
                push = rates(motion, nodes)[1][:, 0] * T / u
                matrix = linearize(motion._replace(gauss=gauss), nodes, T).matrix()[0]
                pairs.append((push, np.linalg.inv(matrix)))
        return pairs

    # Multiples of the first speed and load for which the force was judged.
    _judged = cached_property(lambda self: [1.0])
    _free_impacts = cached_property(lambda self: dict[float, list]())
    _ranges = cached_property(lambda self: dict[float, NDArray | None]())
    _signatures = cached_property(lambda self: dict[float, NDArray]())

    @np.errstate(invalid="ignore")
    def computed_signature(self, u: Values) -> Signature:
        """Compute :meth:`signature` from free impacts at each speed and parameter.

        Under a constant load a, the impulse is J = u + w + aD. Then σ = ∂J/∂a - t_c ∂J/∂u, where
        both derivatives are taken at a = 0. They are differences, so u and the parameters may have
        complex steps.
        """
        u = np.asarray(u)[..., np.newaxis]
        law = self.rows(np.s_[..., np.newaxis])
        speeds = u * np.append(1 + SHIFT * SHIFTS, 1.0)
        impact = law.first_impact(0.0, speeds, 0.0, 0.0)[1]
        by_speed = (speeds + impact.speed)[..., :6] @ WEIGHTS / (SHIFT * u[..., 0])
        gap, speed, duration = (x[..., 6] for x in (impact.gap, impact.speed, impact.duration))
        # A load of this size would stop a released ball within the duration of the contact.
        load = SHIFT * np.real(speed / duration)[..., np.newaxis]
        loaded = law.first_impact(0.0, u, 0.0, load * SHIFTS)[1]
        by_load = (loaded.speed + load * SHIFTS * loaded.duration) @ WEIGHTS / load[..., 0]
        r = speed / u[..., 0]
        centroid = r * (duration - gap / speed) / (1 + r)
        return Signature(r, duration, centroid, by_load - centroid * by_speed)

    @np.errstate(divide="ignore", invalid="ignore")
    def _release(self, q: Values, v: Values, t: Values, given: Mapping) -> Values:
        """Release function: -q, or (-κp′)^{1/m} - q, or -f, or -q f(p, p′)/f(p, 0).

        It has a simple zero where a contact ends, and is positive beyond the surface, q < 0.
        """
        if self.release == "displacement":
            return -q
        if self.lag:
            # This is -q plus the q at which p + κp′ = 0. The zero is simple even for κ = 0.
            return (self.lag(**self.own(given)) * np.maximum(-v, 0.0)) ** (1 / self.root) - q
        inside = np.real(q) > 0
        p = np.where(inside, q, -q) ** self.root
        load = load_of(t, given)
        force = self.force_at(np.where(inside, p, SURFACE), v, load, given)
        static = self.force_at(p, 0 * v, load, given)
        if self.pulls:
            return np.where(inside, 0.0, static) - force
        # A power p^a has no simple zero at the surface, but its quotient with the static force has.
        return -q * np.where(inside, force / static, 1.0)

    @np.errstate(all="ignore")
    def release_slopes(
        self,
        tau: Values,
        u: Values,
        T: Values,
        places: NDArray,
        amplitude: Values,
        table: Table = SINE,
    ) -> NDArray | None:
        """Compute :meth:`.Ball.release_slopes`.

        The slopes come from the polynomials through the nodes of the panels.
        """
        given = {"tau": tau, "u": u, "amplitude": amplitude, "gravity": 1.0, "T": T}
        rows, motion, start, _ = self._started(given, table)
        until = rows.given["T"]
        guess = self._guessed(rows)
        states = np.empty((3, places.size, rows.size))
        left = np.arange(rows.size)
        if guess:
            whole = motion._replace(gauss=guess.gauss)
            panel, good = whole_panel(whole, start, until, guess)
            states = panel.states(places, guess.gauss)
            left = np.flatnonzero(~good)
        if left.size:
            some = motion.of(left), start[:, left], until[left]
            states[..., left] = sampled(*some, places)
        slopes = event_rate(motion, motion.release, states)[1]
        return slopes.T.reshape(*rows.shape, places.size)

    def _started(
        self, values: Mapping, table: Table
    ) -> tuple[Rows, ContactMotion, NDArray, NDArray]:
        """Start contacts.

        Returns their rows, their motion, q and v at the start, and the derivatives of q and v,
        shape (2, directions, rows).
        """
        rows = values_by_row({**self.values, **values, **table.parameters})
        given = rows.given
        given["table"] = table
        none = np.zeros((rows.directions, rows.size))
        kinks = (
            lambda q, v, t, given, kink=kink: kink(q**self.root, v, **self.own(given))
            for kink in self.kinks
        )
        motion = ContactMotion(
            self.root, self.force_at, self._release, tuple(kinks), given, rows.steps
        )
        # If a contact resumes, the ball starts at p + κp′ = 0 and moves away from the table: u < 0.
        q = np.zeros(rows.size)
        by = np.array([none, rows.steps.get("u", none)])
        if self.lag and np.any(given["u"] < 0):
            stepped = motion.stepped()
            kappa = self.at(**self.own(stepped)).kappa
            start = (-kappa * np.minimum(stepped["u"], 0.0)) ** (1 / self.root)
            by[0] = np.imag(start)
            q = np.atleast_2d(np.real(start))[0]
        if "start_speed" not in self.needs:
            rows.steps.pop("u", None)
        given["u"] = np.where(np.abs(given["u"]) < SLOWEST, SLOWEST, given["u"])
        return rows, motion, np.array([q, given["u"]]), by

    def _judge(self, u: Values, amplitude: Values, table: Table) -> None:
        """Judge the force at the speeds and loads of a question.

        The speeds grow in steps of a factor of two. If a larger speed than that of the question is
        refused, the question is judged alone.
        """
        loads = 1 + np.abs(amplitude) * np.max(table.bounds[2])
        shares = np.append(np.abs(u) / FIRST_SPEED, loads / FIRST_LOAD)
        most = np.max(shares, initial=1.0, where=np.isfinite(shares))
        judged = self._origin._judged
        if most <= max(judged):
            return
        factor = float(2 ** np.ceil(np.log2(most)))
        try:
            judge(self._origin, factor * FIRST_SPEED, factor * FIRST_LOAD)
        except ValueError:
            factor = float(most)
            judge(self._origin, factor * FIRST_SPEED, factor * FIRST_LOAD)
        judged.append(factor)

    def _guessed(self, rows: Rows) -> Guess | None:
        """Return free impacts as a guess of contacts with a known end; None if the guess is bad."""
        u = rows.given["u"]
        if self.root == 1 or self.kinks or not rows.size or not np.all(u > 0):
            return None
        return self._origin.guess(u, rows.given["T"])

    def _followed(
        self,
        tau: Values,
        u: Values,
        amplitude: Values,
        gravity: Values,
        T: Values = None,
        longest: Values = PERIODS,
        table: Table = SINE,
        *,
        guessed: bool = True,
    ) -> tuple[Values, Impact]:
        """Return T and the state of contacts at T. By default T is the T of the first release."""
        values = {"tau": tau, "u": u, "amplitude": amplitude, "gravity": gravity}
        rows, motion, start, by = self._started(values if T is None else values | {"T": T}, table)
        given = rows.given
        u = given["u"]
        period = np.full(rows.size, 2 * np.pi)
        if T is None:
            law = (
                self if not any(map(np.ndim, self.values.values())) else self.at(**self.own(given))
            )
            depth = law.depth(np.abs(u))
            first = FIRST_PANEL * depth ** (1 / self.root) / np.abs(u)
            # A ball that the force does not stop has no release.
            start = np.where(np.isnan(depth), np.nan, start)
            # A table at rest has no period. Most impacts last about 3 P/u, and end before 8 P/u.
            period = np.where(given["amplitude"] == 0, 8 * depth / np.abs(u), period)
            ends, slopes = integrate_contacts(motion, start, by, first, period, longest)
        else:
            # Impacts need at least about this number of panels.
            one = self.root == 1 and rows.size <= FEW_CONTACTS
            first = given["T"] / (1.0 if one else 1.5 * self.root)
            by_until = rows.steps.get("T", np.zeros((rows.directions, rows.size)))
            guess = self._guessed(rows) if guessed else None
            ends, slopes = integrate_to(
                motion, start, by, first, period, given["T"], by_until, guess
            )
        s, q, v, t = rows.joined(ends, slopes)
        given = {**self.values, **values, **table.parameters, "table": table}
        return s, Impact(t, -(q**self.root), -v, self._release(q, v, t, given))
