"""Control of the step length along the branch."""

from dataclasses import dataclass


@dataclass(frozen=True)
class StepControl:
    """Adaptive step in arclength.

    The step grows if the corrector needed fewer iterations than
    ``target_iterations``, and shrinks if it needed more. It is also limited such that the
    tangent turns by less than ``max_angle``, so that folds are
    resolved and the continuation does not jump to another branch.

    Parameters
    ----------
    initial, smallest, largest : float
        The initial, smallest and largest step in arclength.
    target_iterations : int
        Number of Newton iterations at which the step is unchanged.
    max_angle : float
        Largest angle in radians between the tangents of neighbouring points.
    """

    initial: float = 0.02
    smallest: float = 1e-8
    largest: float = 0.2
    target_iterations: int = 4
    max_angle: float = 0.2

    def after(self, step: float, iterations: int, angle: float) -> float:
        """The length of the next step after an accepted step.

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
