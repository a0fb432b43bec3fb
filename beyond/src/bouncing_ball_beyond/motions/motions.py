"""The motions on which balls end, as arrays with an entry per ball."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.drawing.kinds import Kind
from bouncing_ball_beyond.inherited.numerics.arrays import Batch


class Reason(StrEnum):
    """Why a motion is undecided, or why the period of a locked motion is not known."""

    NONE = ""
    # The reason that is given if nothing else is known.
    NO_RECURRENCE = "it has neither repeated nor shown an exponent beyond its error"
    MARGINAL = "it returns, and its neighbours come closer too slowly to tell that it repeats"
    ROUNDING = "rounding errors grow to the size of the motion before it repeats"
    TRANSIENT = (
        "it looks chaotic, but another ball on it comes to rest or repeats: it may be a transient"
    )
    NO_RELEASE = "no end of a contact was found"


@dataclass(frozen=True, repr=False)
class Motions(Batch):
    """The motions on which balls end, arrays of one shape.

    Parameters
    ----------
    kind : array of Kind
    periods : array of int
        Periods of the table after which the motion repeats; 0 if it does not repeat, or if it is
        locked and rounding errors decide after how many periods.
    impacts : array of int
        Impacts after which the motion repeats. In the restitution model the infinitely many impacts
        that are summed up before the ball sticks are not counted. 0 in permanent contact, and where
        the number of periods is 0.
    exponent : array
        Largest Lyapunov exponent per period of the table. For a motion that repeats it follows from
        the larger multiplier, and is -∞ if the multiplier is zero; NaN where it is not known.
    exponent_error : array
        Error of the exponent, twice which on both sides is an interval of about 95 %
        (:meth:`.Stretching.uncertainty`); 0 for a motion that repeats, and NaN where it is not
        known, as for a motion that was followed for less than 25 of its relaxation lengths.
    reason : array of Reason
        The reason for which a motion is undecided, or the period of a locked motion not known.
    followed : array of int
        Impacts after which the kind was known; those of a chaotic or undecided motion are all for
        which it was followed.
    followed_time : array
        Time from the first impact to the last of the impacts followed.
    end_phase, end_velocity : array
        Table phase φ and absolute velocity z′_i before the last of these impacts: a start from
        which the ball is on the motion at once. NaN in permanent contact.
    times_stuck : array of int
        Number of contacts at which the ball stuck to the table, among the impacts followed.
    first_lift_off : array
        Time from the first impact to the end of the first of these contacts, at which the ball
        leaves the table; NaN if it has not stuck.
    digits_lost : array
        Decimal digits of the start that the motion has lost: the logarithm of the largest factor by
        which a deviation has grown. A double has 16 digits. If more than about 14 digits are lost,
        the last digit decides on which of several motions the ball ends, although the same bits
        give the same answer on every computer. The number grows with the impacts of a chaotic
        motion.
    """

    kind: np.ndarray
    periods: np.ndarray
    impacts: np.ndarray
    exponent: np.ndarray
    exponent_error: np.ndarray
    reason: np.ndarray
    followed: np.ndarray
    followed_time: np.ndarray
    end_phase: np.ndarray
    end_velocity: np.ndarray
    times_stuck: np.ndarray
    first_lift_off: np.ndarray
    digits_lost: np.ndarray

    @classmethod
    def unknown(cls, balls: int) -> Self:
        """Arrays for a number of balls, whose entries are not known yet."""

        def empty_texts(names: type[StrEnum]) -> np.ndarray:
            return np.full(balls, "", dtype=np.array(list(names)).dtype)

        def zeros() -> np.ndarray:
            return np.zeros(balls, dtype=int)

        def unknowns() -> np.ndarray:
            return np.full(balls, np.nan)

        return cls(
            kind=empty_texts(Kind),
            periods=zeros(),
            impacts=zeros(),
            exponent=unknowns(),
            exponent_error=unknowns(),
            reason=empty_texts(Reason),
            followed=zeros(),
            followed_time=unknowns(),
            end_phase=unknowns(),
            end_velocity=unknowns(),
            times_stuck=zeros(),
            first_lift_off=unknowns(),
            digits_lost=unknowns(),
        )

    def in_words(self) -> str:
        """The kind of a single motion, and for how many impacts the ball was followed.

        Examples
        --------
        >>> from bouncing_ball_beyond.motions.destination import final_motions
        >>> from bouncing_ball_beyond.models.rigid import RestitutionModel
        >>> start = [0.8, 2.0], 1.0, -3.0
        >>> found = final_motions(RestitutionModel(0.9), *start, impacts=300)
        >>> print(found[0].in_words(), found[1].in_words(), sep="\\n")
        orbit, found within 183 impacts
        chaotic in all 300 impacts for which it was followed; more may show a long transient
        """
        kind = str(self.kind)
        many = int(self.followed)
        why = f": {self.reason}" if str(self.reason) else ""
        if kind == Kind.CHAOTIC:
            followed = f"in all {many} impacts for which it was followed"
            return f"{kind} {followed}; more may show a long transient"
        if kind == Kind.UNDECIDED:
            return f"{kind} after {many} impacts{why}"
        unknown = f"; its period is not known{why}" if self.is_unresolved() else ""
        return f"{kind}, found within {many} impacts{unknown}"

    def is_unresolved(self) -> np.ndarray:
        """Whether motions are locked, and rounding errors decide on the period."""
        return (self.kind == Kind.LOCKED) & (self.periods == 0)

    def fill(self, index: np.ndarray, **values: ArrayLike) -> None:
        """Store results of the balls with these indices."""
        for name, value in values.items():
            getattr(self, name)[index] = value
