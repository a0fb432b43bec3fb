"""Map of the contacts of one ball on one table. Polynomials replace the integration of contacts.

The end of a contact depends on the phase τ of the table and on the closing speed u. If the ball
turns back once and then leaves, the end is an analytic function of τ and u. A kink of the force
does not change this, as long as all contacts cross it. T, D, δ and δ′ at the release are then
Fourier series in τ, and their coefficients are Chebyshev polynomials in ln u. The map consists of
*pieces*. The largest speed u of a piece is twice its smallest speed.

The harmonic m is of the order of ε^m, where ε = (1 + Λ)D/u is the load divided by the contact
force. A piece therefore needs only 512 integrations, or a few times as many. It then replaces the
integrations of a million impacts. The coefficients of slow impacts do not decay to rounding errors,
so contacts of slow impacts are integrated one by one.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from bouncing_ball_beyond.contacts.balls import Ball
from bouncing_ball_beyond.motions.effort import Effort
from bouncing_ball_beyond.tables.table import Table

MAP_FACTOR, MAP_DEGREE = 2.0, 15
"""Ratio of the largest to the smallest speed of a piece of the map, and its degree in ln u.

For example, a restitution coefficient 1/(1 + Cu) has poles at ln u = x ± iπ. They cause an error of
18⁻¹⁶.

With half the degree there are no maps. With twice the degree they take 76 % longer to build.
"""

PHASES, MOST_PHASES = 32, 256
"""First and maximum number of phases of a piece. It is doubled until the coefficients decay.

At half: 6 % fewer harmonics. At twice: 40 % slower to build.
"""

ONE_SWING = 1.5
"""Maximum T of a contact of the map, divided by T of a free impact.

During shorter contacts the ball turns back only once, and no earlier release can appear between the
points of the map.

At half there are no maps. At twice: no effect.
"""

PIECES = 12
"""Maximum number of pieces. The first piece has the fastest impacts.

At half and at twice: no effect.
"""

LEFT_OUT = 1e-16
"""Size of coefficients, relative to the largest value, below which harmonics are left out.

At half: 11 % more harmonics. At twice: 12 % fewer. The errors are the same.
"""

LAST_COEFFICIENTS = 1e-13
"""Maximum last coefficients of a piece, relative to the largest value.

Coefficients of this size are rounding errors of the integrations.

At half: no effect. At twice: 1 of 4 maps has one more piece.
"""


@dataclass(frozen=True)
class ImpactMap:
    """Map of the contacts of a ball.

    Attributes
    ----------
    ball : Ball
        The ball.
    amplitude : float
        Λ.
    table : Table
        The waveform.
    top : float
        Maximum closing speed.
    pieces : tuple of complex arrays, shape (4, harmonics, MAP_DEGREE + 1)
        Coefficients of T, D, δ and δ′. The first piece covers speeds from ``top`` down to top/2,
        and each further piece the next factor of 2.
    """

    ball: Ball
    amplitude: float
    table: Table
    top: float
    pieces: tuple[NDArray, ...]

    def _places(self, u: NDArray) -> tuple[NDArray, NDArray]:
        """Return the numbers of pieces, and the positions in them, from -1 to 1.

        Numbers beyond the pieces mark speeds outside the map.
        """
        with np.errstate(divide="ignore", invalid="ignore"):
            octaves = np.log(self.top / u) / np.log(MAP_FACTOR)
        number = np.floor(octaves)
        return number, 1 - 2 * (octaves - number)

    def leaves(self, tau: NDArray, u: NDArray) -> tuple[NDArray, ...]:
        """T, D, δ and δ′ at the first release. D is infinite if the ball stays on the table."""
        releases = np.empty((4, u.size))
        number, x = self._places(u)
        known = np.zeros(u.shape, bool)
        for k, piece in enumerate(self.pieces):
            (at,) = (number == k).nonzero()
            known[at] = True
            waves = np.exp(1j * np.outer(tau[at], np.arange(piece.shape[1])))
            releases[:, at] = _sum(piece, chebyshev.chebvander(x[at], MAP_DEGREE), waves)
        (others,) = (~known).nonzero()
        if others.size:
            given = tau[others], u[others], self.amplitude, self.table
            releases[:, others] = self.ball.leaves(*given)
        return tuple(releases)

    def end_slopes(self, tau: NDArray, u: NDArray, T: NDArray) -> NDArray:
        """Derivatives as in :meth:`.Ball.end_slopes`; NaN if u is NaN."""
        slopes = np.full((3, 2, *u.shape), np.nan)
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
            slopes[:, 0, at] = _sum(1j * harmonics[:, np.newaxis] * piece[1:], powers, waves)
            slopes[:, 1, at] = _sum(by_x, powers[:, :-1], waves) * stretch
        others = ~known & np.isfinite(u)
        given = tau[others], u[others], T[others], self.amplitude, self.table
        slopes[..., others] = self.ball.end_slopes(*given)
        return slopes


def _sum(coefficients: NDArray, powers: NDArray, waves: NDArray) -> NDArray:
    """Real parts of the sums over harmonics and polynomials, shape (quantities, points)."""
    harmonics = np.tensordot(coefficients, powers, ([2], [1]))
    return np.einsum("qmn,nm->qn", harmonics, waves).real


def impact_map(
    ball: Ball, amplitude: float, table: Table, top: float, effort: Effort | None = None
) -> ImpactMap:
    """Build the map of contacts with closing speeds up to ``top``.

    Pieces for lower and lower speeds are added until a piece is not analytic, or until there are
    `PIECES`.
    """
    pieces: list[Any] = []
    while len(pieces) < PIECES:
        if effort:
            effort.spend(0)
        piece = _piece(ball, amplitude, table, top * MAP_FACTOR ** -len(pieces))
        if piece is None:
            break
        pieces.append(piece)
    return ImpactMap(ball, amplitude, table, top, tuple(pieces))


def _piece(ball: Ball, amplitude: float, table: Table, top: float) -> NDArray | None:
    """Coefficients of the piece below the speed ``top``; None if coefficients do not decay."""
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
        # δ may be zero within rounding, so it is compared with the distance D δ′.
        largest[2] = largest[1] * largest[3]
        sizes = np.abs(piece) / largest[:, np.newaxis, np.newaxis]
        if sizes[:, :, -2:].max() > LAST_COEFFICIENTS:
            return None
        if sizes[:, -2:].max() <= LAST_COEFFICIENTS:
            last = np.flatnonzero(sizes.max(axis=(0, 2)) > LEFT_OUT)[-1]
            return piece[:, : last + 1]
        phases *= 2
    return None
