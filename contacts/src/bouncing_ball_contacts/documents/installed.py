"""What to install for proofs, if the library of balls is missing."""

from collections.abc import Iterator
from contextlib import contextmanager

from bouncing_ball_beyond.inherited.errors import ModelError


@contextmanager
def proofs_extra() -> Iterator[None]:
    """A context for imports that need the extra ``proofs`` of this package.

    Raises
    ------
    ModelError
        If a package of this extra is not installed, with one line that tells how to install it.

    Examples
    --------
    >>> with proofs_extra():
    ...     import no_such_package
    Traceback (most recent call last):
    ...
    bouncing_ball_beyond.inherited.errors.ModelError: no_such_package is not installed: \
install the extra 'proofs', for example pip install ./beyond "./contacts[proofs]"
    """
    try:
        yield
    except ModuleNotFoundError as error:
        package = str(error.name).partition(".")[0]
        raise ModelError(
            f"{package} is not installed: "
            "install the extra 'proofs', for example pip install ./beyond \"./contacts[proofs]\""
        ) from None
