"""Laws whose force depends on the load of the ball, as that of MuJoCo's impedance does.

No law of this house is one; the contacts of engines have one.

The load is the acceleration a that the ball has towards the table without a contact. The force of
most laws is the same under any load. The numerical methods call :func:`under`, which accepts any
law, and what is done for a :class:`LoadedLaw` only depends on its class.
"""

from copy import copy
from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from bouncing_ball_beyond.inherited.numerics.arrays import pick
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_beyond.models.laws.force_law import ForceLaw


@dataclass(frozen=True, repr=False)
class LoadedLaw(ForceLaw):
    """A law whose force depends on the load of the ball, with m = 1.

    Its contact ends at the surface or where the grip vanishes, whichever comes first. A ball at the
    surface that the load would pull meets no force there. A subclass of this class and of
    :class:`.ContactLaw`, in this order, defines ``force``, which uses the load a as ``self.load``,
    and, if its force has kinks, :meth:`continued`. The load is no parameter: laws under several
    loads are equal.
    """

    root: ClassVar[int] = 1
    release = Release.FORCE
    lag: ClassVar[None] = None

    load: ClassVar[Any] = 0.0
    """The load a, which broadcasts with p and p′ and may be complex; 0 for the law itself."""

    def under(self, load: Any) -> Self:
        """The law whose force and grip are those under a load a."""
        law = copy(self)
        object.__setattr__(law, "load", load)
        return law

    def take(self, which: Any) -> Self:
        """The laws of a row with these indices, under their loads."""
        part = super().take(which)
        if part is self and not np.ndim(self.load):
            return self
        return part.under(pick(self.load, which))

    def continued(self, penetration: np.ndarray, side: np.ndarray) -> Self:
        """The law in a row of states, continued smoothly beyond the next kink of each; by default
        the law itself.

        ``side`` is the sign of :meth:`~.ForceLaw.kink`, which rounding makes uncertain at a kink.
        """
        return self


def under(law: ForceLaw, load: Any) -> ForceLaw:
    """The law whose force and grip are those under a load a: the law itself if it is no
    :class:`LoadedLaw`.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.laws.hertzian import Tsuji
    >>> law = Tsuji(100.0, 0.1)
    >>> under(law, 4.0) is law
    True
    """
    return law.under(load) if isinstance(law, LoadedLaw) else law
