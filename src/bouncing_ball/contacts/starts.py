"""On which motions balls end that start from an even grid of impacts, and with which shares.

The grid is over the phase of the table and the speed of the first impact. It is followed on the
exact linear contact. For another law it is the linear contact with the same r and duration, because
the law itself would take a hundred times as long.
"""

from dataclasses import dataclass

import numpy as np

from bouncing_ball.contacts.resolved import ResolvedContact
from bouncing_ball.contacts.texts import shown
from bouncing_ball.long_run.basins import MotionName, basins
from bouncing_ball.long_run.motions import Kind
from bouncing_ball.models.spring_damper_model import SpringDamperModel

# Starts along each axis, and the impacts for which each ball is followed.
_STARTS = 12
_IMPACTS = 300
FEW = 0.1
"""The share of starts below which few balls reach an orbit; its standard error is 2.5 %."""
# Motions that are named one by one.
_NAMED = 3

_WORDS = {
    Kind.SUBHARMONIC: "on a doubled orbit",
    Kind.LOCKED: "on a locked motion",
    Kind.PERMANENT_CONTACT: "at rest on the table",
    Kind.CHAOTIC: "in chaotic motion",
    Kind.ALOFT: "in a motion without impacts",
    Kind.UNDECIDED: "in no motion that is recognized",
}


@dataclass(frozen=True)
class Ends:
    """The ``shares`` of starts that end on each motion, the greatest first, by its name: kind, and
    periods/impacts after which it repeats. ``first`` is the phase and the velocity of a start that
    ends on the first one. ``balls`` is the number of starts, and ``is_linear`` tells whether they
    are those of the contact itself.
    """

    shares: dict[str, float]
    first: tuple[float, float]
    balls: int
    is_linear: bool

    def of_orbit(self, n: int) -> float:
        """The share of starts that end on the n-T orbit."""
        return self.shares.get(_name(MotionName(Kind.ORBIT, n, 1)), 0.0)

    @property
    def sentence(self) -> str:
        """The shares in one sentence."""
        by_words: dict[str, float] = {}
        for name, share in self.shares.items():
            words = _in_words(name)
            by_words[words] = by_words.get(words, 0.0) + share
        order = sorted(by_words.items(), key=lambda item: -item[1])
        (most, share), *less = order[:_NAMED]
        parts = [f"{shown(share, '%')} end {most}"]
        parts += [f"{shown(share, '%')} {words}" for words, share in less]
        left = 1 - sum(share for _, share in order[:_NAMED])
        if len(order) > _NAMED:
            parts.append(f"{shown(left, '%')} on others")
        contact = "" if self.is_linear else " of the linear contact with this r and duration"
        return f"Of {self.balls} balls{contact} with other starts, {', '.join(parts)}."


def _name(motion: MotionName) -> str:
    kind = str(motion.kind)
    return f"{kind} {motion.periods}/{motion.impacts}" if motion.impacts else kind


def _in_words(name: str) -> str:
    kind, _, repeats = name.partition(" ") if name.startswith(Kind.ORBIT) else (name, "", "")
    if kind != Kind.ORBIT:
        return next(words for known, words in _WORDS.items() if name.startswith(known))
    periods, impacts = repeats.split("/")
    if impacts == "1":
        return f"on the {periods}-T orbit"
    return f"on an orbit of {periods} periods and {impacts} impacts"


def ends_of_starts(case: ResolvedContact) -> Ends:
    """The motions on which balls with a grid of starts end.

    Examples
    --------
    >>> from bouncing_ball.contacts.table import TableMotion
    >>> from bouncing_ball.models.spring_damper import SpringDamper
    >>> found = ends_of_starts(
    ...     ResolvedContact(1.0, TableMotion(1.0, 0.2, 1.0), SpringDamper(10.0, 0.2)))
    >>> found.shares, found.sentence
    ({'permanent contact': 1.0}, 'Of 144 balls with other starts, 100 % end at rest on the table.')
    """
    lam = case.table.amplitude
    found = basins(SpringDamperModel(case.linear), lam, _STARTS, impacts=_IMPACTS)
    order = np.argsort(-found.share, kind="stable")
    row, column = np.argwhere(found.which == order[0])[0]
    phase = float(found.phase[column])
    velocity = lam * np.cos(phase) - float(found.speed[row])
    return Ends(
        shares={_name(found.motions[k]): float(found.share[k]) for k in order},
        first=(phase, float(velocity)),
        balls=int(found.which.size),
        is_linear=case.law is None,
    )
