"""Control of the step length along the branch."""

from dataclasses import dataclass


@dataclass(frozen=True)
class StepControl:
    """Adaptive step in arclength.

    The step grows when the corrector needed fewer iterations than
    ``target_iterations`` and shrinks when it needed more; it shrinks as well
    when the tangent turns by more than ``max_angle``, so that folds are
    resolved and the branch is not left for another.

    Parameters
    ----------
    initial, smallest, largest : float
        Steps in arclength.
    target_iterations : int
        Newton iterations at which the step stays as it is.
    max_angle : float
        Largest angle in radians between the tangents of neighbouring points.
    """

    initial: float = 0.02
    smallest: float = 1e-8
    largest: float = 0.2
    target_iterations: int = 4
    max_angle: float = 0.2

    def after(self, step: float, iterations: int, angle: float) -> float:
        """The next step in arclength after an accepted one.

        Examples
        --------
        >>> StepControl(largest=1.0).after(0.1, iterations=4, angle=0.0)
        0.1
        """
        factor = 2.0 ** ((self.target_iterations - iterations) / 2)
        if angle > 0:
            factor = min(factor, 0.9 * self.max_angle / angle)
        factor = min(max(factor, 0.25), 2.0)
        return min(max(step * factor, self.smallest), self.largest)
