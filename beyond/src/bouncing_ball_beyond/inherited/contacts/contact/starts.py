"""On which motions balls end that start from an even grid of impacts, and with which shares.

The grid is over the phase of the table and the speed of the first impact. It is followed on the
contact itself. A contact law has fewer starts
(:mod:`bouncing_ball_beyond.inherited.contacts.contact.effort`); its shares then have Wilson's
intervals (E. B. Wilson, Journal of the American Statistical Association 22, 1927).

They hold for random starts. Those of an even grid are nearer to the shares of all starts, unless
the basins are finer than the grid.
"""

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy

from bouncing_ball_beyond.inherited.contacts.contact import effort
from bouncing_ball_beyond.inherited.contacts.contact.resolved import ResolvedContact
from bouncing_ball_beyond.inherited.contacts.contact.texts import shown
from bouncing_ball_beyond.motions.basins import MotionName, basins
from bouncing_ball_beyond.motions.motions import Kind

# The impacts for which each ball is followed: after 250 some that approach an orbit are not known.
_IMPACTS = 300
FEW = 0.1
"""The share of starts below which few balls reach an orbit; its standard error is 2.5 %, and 5 %
with the starts of a contact law."""
_CONFIDENCE = 0.95
# Motions that are named one by one.
_NAMED = 3

_WORDS = {
    Kind.SUBHARMONIC: "on a subharmonic orbit",
    Kind.LOCKED: "on a motion that sticks to the table and repeats",
    Kind.PERMANENT_CONTACT: "at rest on the table",
    Kind.CHAOTIC: "in chaotic motion",
    Kind.UNDECIDED: "in no motion that is recognized",
}


@dataclass(frozen=True)
class SharesOfStarts:
    """The ``shares`` of starts that end on each motion, the greatest first. ``first`` is the phase
    and the velocity of a start that ends on the commonest motion of the commonest kind. ``balls``
    is the number of starts.
    """

    shares: dict[MotionName, float]
    first: tuple[float, float]
    balls: int

    def of_orbit(self, n: int) -> float:
        """The share of starts that end on the n-T orbit."""
        return self.shares.get(MotionName(Kind.ORBIT, n, 1), 0.0)

    @property
    def by_text(self) -> dict[str, float]:
        """The shares by the kind of motion, and periods/impacts after which it repeats, as text."""
        return {_text(motion): share for motion, share in self.shares.items()}

    @property
    def is_small(self) -> bool:
        """Whether the starts are so few that the shares have intervals."""
        return self.balls < effort.LINEAR.starts**2

    @property
    def sentence(self) -> str:
        """The shares in one sentence, those of few starts with their intervals."""
        by_words = _by_words(self.shares)
        order = sorted(by_words.items(), key=lambda item: -item[1])
        (most, share), *less = order[:_NAMED]
        parts = [f"{self._shown(share)} end {most}"]
        parts += [f"{self._shown(share)} {words}" for words, share in less]
        left = 1 - sum(share for _, share in order[:_NAMED])
        if len(order) > _NAMED:
            parts.append(f"{self._shown(left)} on others")
        about = "; the ranges are intervals of 95 % for so few balls" if self.is_small else ""
        return f"Of {self.balls} balls with other starts, {', '.join(parts)}{about}."

    def _shown(self, share: float) -> str:
        """A share, with the interval of few starts."""
        if not self.is_small:
            return shown(share, "%")
        low, high = interval(round(share * self.balls), self.balls)
        return f"{shown(share, '%')} ({100 * low:.0f} to {100 * high:.0f} %)"


def _by_words(shares: Mapping[MotionName, float]) -> dict[str, float]:
    """The shares of motions with the same words, added up."""
    found: dict[str, float] = defaultdict(float)
    for motion, share in shares.items():
        found[_in_words(motion)] += share
    return found


def interval(count: int, number: int) -> tuple[float, float]:
    """Wilson's interval of 95 % for a share, of which ``count`` of a ``number`` of starts are seen.

    Examples
    --------
    >>> [round(end, 3) for end in interval(18, 36)], [round(end, 3) for end in interval(36, 36)]
    ([0.345, 0.655], [0.904, 1.0])
    """
    tested = scipy.stats.binomtest(count, number)
    low, high = tested.proportion_ci(_CONFIDENCE, "wilson")
    return float(low), float(high)


def _text(motion: MotionName) -> str:
    kind = str(motion.kind)
    return f"{kind} {motion.periods}/{motion.impacts}" if motion.impacts else kind


def _in_words(motion: MotionName) -> str:
    kind, periods, impacts = motion
    if kind != Kind.ORBIT:
        return _WORDS[kind]
    if impacts == 1:
        return f"on the {periods}-T orbit"
    of = f"{periods} period" if periods == 1 else f"{periods} periods"
    return f"on an orbit of {of} and {impacts} impacts"


def ends_of_starts(case: ResolvedContact) -> SharesOfStarts:
    """The motions on which balls with a grid of starts end.

    Examples
    --------
    >>> from bouncing_ball_beyond.inherited.contacts.contact.contact import Contact
    >>> from bouncing_ball_beyond.inherited.contacts.contact.table import TableMotion
    >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
    >>> spring = SpringDamper(10.0, 0.2)
    >>> found = ends_of_starts(
    ...     ResolvedContact(Contact(mass=1.0), TableMotion(1.0, 0.2, 1.0), spring, spring))
    >>> found.by_text, found.sentence
    ({'permanent contact': 1.0}, 'Of 144 balls with other starts, 100 % end at rest on the table.')
    """
    lam = case.table.amplitude
    exact, *_ = case.models.values()
    found = basins(exact, lam, case.effort.starts, impacts=_IMPACTS)
    order = np.argsort(-found.share, kind="stable")
    shares = {found.motions[k]: float(found.share[k]) for k in order}
    by_words = _by_words(shares)
    commonest = max(order, key=lambda k: by_words[_in_words(found.motions[k])])
    row, column = np.argwhere(found.which == commonest)[0]
    phase = float(found.phase[column])
    velocity = lam * np.cos(phase) - float(found.speed[row])
    return SharesOfStarts(
        shares=shares,
        first=(phase, float(velocity)),
        balls=int(found.which.size),
    )
