"""The contacts of one ball on one table as a map, by polynomials in place of integrations.

How a contact ends depends on the phase τ of the table and on the closing speed u, and does so
analytically if the ball turns back once and leaves. T, D, δ and δ′ at the release are then Fourier
series in τ whose coefficients are Chebyshev polynomials in ln u, on pieces of a factor 2 in u. With
the load over the force, ε = (1 + Λ)D/u, the harmonic m is of the order of ε^m, so that a piece
takes some hundred integrations, and a ball may have a million impacts. Contacts at slower impacts,
whose coefficients do not fall to rounding, are integrated one by one.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from bouncing_ball_beyond.balls import Ball
from bouncing_ball_beyond.tables import Table

MAP_FACTOR, MAP_DEGREE = 2.0, 15
"""The range of speeds of a piece of the map, and its degree in ln u. A pole at ln u = x ± iπ, like
that of a restitution 1/(1 + Cu), leaves an error of 18⁻¹⁶."""

PHASES, MOST_PHASES = 32, 256
"""The number of phases at first, which is doubled up to the largest one."""

ONE_SWING = 1.5
"""A contact of the map ends within so many times the T of a free impact. Then the ball has turned
back once, and no earlier release can appear between the points of the map."""

PIECES = 12
"""The largest number of pieces, which reach down from the fastest impact."""

LEFT_OUT = 1e-16
"""Harmonics whose coefficients are smaller, over the largest value, are left out."""

LAST_COEFFICIENTS = 1e-13
"""The largest last coefficients of a piece, over the largest value: rounding of integrations."""


@dataclass(frozen=True)
class ImpactMap:
    """The contacts of a ball with one or more speeds of at most ``top``.

    ``pieces`` has the coefficients on the range of speeds from ``top`` down to a half of it, and so
    on, each complex of the shape (4, harmonics, DEGREE + 1), of T, D, δ and δ′.
    """

    ball: Ball
    amplitude: float
    table: Table
    top: float
    pieces: tuple[NDArray, ...]

    def _places(self, u: NDArray) -> tuple[NDArray, NDArray]:
        """The numbers of the pieces and the places in them, from -1 to 1; others are no pieces."""
        with np.errstate(divide="ignore", invalid="ignore"):
            octaves = np.log(self.top / u) / np.log(MAP_FACTOR)
        number = np.floor(octaves)
        return number, 1 - 2 * (octaves - number)

    def knows(self, u: NDArray) -> NDArray:
        """Whether contacts of these speeds need no integration."""
        number, _ = self._places(u)
        return (number >= 0) & (number < len(self.pieces))

    def leaves(self, tau: NDArray, u: NDArray) -> tuple[NDArray, ...]:
        """T, D, δ and δ′ of the first release; D is infinite for a ball that stays."""
        found = np.empty((4, u.size))
        number, x = self._places(u)
        known = np.zeros(u.shape, bool)
        for k, piece in enumerate(self.pieces):
            (at,) = (number == k).nonzero()
            known[at] = True
            waves = np.exp(1j * np.outer(tau[at], np.arange(piece.shape[1])))
            found[:, at] = _sum(piece, chebyshev.chebvander(x[at], MAP_DEGREE), waves)
        (others,) = (~known).nonzero()
        if others.size:
            given = tau[others], u[others], self.amplitude, self.table
            found[:, others] = self.ball.leaves(*given)
        return tuple(found)

    def end_slopes(self, tau: NDArray, u: NDArray, T: NDArray, w: NDArray) -> NDArray:
        """Derivatives as of :meth:`.Ball.end_slopes`; NaN where u is NaN."""
        found = np.full((3, 2, *u.shape), np.nan)
        number, x = self._places(u)
        known = np.zeros(u.shape, bool)
        for k, piece in enumerate(self.pieces):
            at = number == k
            known |= at
            harmonics = np.arange(piece.shape[1])
            waves = np.exp(1j * np.outer(tau[at], harmonics))
            powers = chebyshev.chebvander(x[at], MAP_DEGREE)
            by_x = chebyshev.chebder(piece[1:], axis=2)
            stretch = 2 / (np.log(MAP_FACTOR) * u[at])
            found[:, 0, at] = _sum(1j * harmonics[:, np.newaxis] * piece[1:], powers, waves)
            found[:, 1, at] = _sum(by_x, powers[:, :-1], waves) * stretch
        others = ~known & np.isfinite(u)
        given = tau[others], u[others], T[others], w[others], self.amplitude, self.table
        found[..., others] = self.ball.end_slopes(*given)
        return found


def _sum(coefficients: NDArray, powers: NDArray, waves: NDArray) -> NDArray:
    """Real parts of sums over harmonics and powers, shape (quantities, points)."""
    each = np.tensordot(coefficients, powers, ([2], [1]))
    return np.einsum("qmn,nm->qn", each, waves).real


def impact_map(ball: Ball, amplitude: float, table: Table, top: float) -> ImpactMap:
    """The map of contacts up to a speed, with as many pieces downwards as are analytic.

    ``top`` is the greatest closing speed u.
    """
    pieces: list[Any] = []
    while len(pieces) < PIECES:
        piece = _piece(ball, amplitude, table, top * MAP_FACTOR ** -len(pieces))
        if piece is None:
            break
        pieces.append(piece)
    return ImpactMap(ball, amplitude, table, top, tuple(pieces))


def _piece(ball: Ball, amplitude: float, table: Table, top: float) -> NDArray | None:
    """The coefficients on the range of speeds below ``top``; None if they do not fall."""
    x = chebyshev.chebpts1(MAP_DEGREE + 1)
    u = top * MAP_FACTOR ** ((x - 1) / 2)
    longest = ONE_SWING * ball.free(u)
    to_coefficients = np.linalg.inv(chebyshev.chebvander(x, MAP_DEGREE))
    phases = PHASES
    while phases <= MOST_PHASES:
        tau = np.arange(phases) * 2 * np.pi / phases
        start, speed = np.meshgrid(tau, u, indexing="ij")
        values = np.array(ball.leaves(start.ravel(), speed.ravel(), amplitude, table))
        values = values.reshape(4, phases, u.size)
        if not np.all(values[0] < longest):
            return None
        waves = np.fft.rfft(values, axis=1) / phases
        waves[:, 1:] *= 2
        piece = waves @ to_coefficients.T
        largest = np.abs(values).max(axis=(1, 2))
        # δ at the release is zero but for rounding, or a part of the way in a contact.
        largest[2] = largest[1] * largest[3]
        sizes = np.abs(piece) / largest[:, np.newaxis, np.newaxis]
        if sizes[:, :, -2:].max() > LAST_COEFFICIENTS:
            return None
        if sizes[:, -2:].max() <= LAST_COEFFICIENTS:
            last = np.flatnonzero(sizes.max(axis=(0, 2)) > LEFT_OUT)[-1]
            return piece[:, : last + 1]
        phases *= 2
    return None
