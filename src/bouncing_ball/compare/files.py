"""Files of a folder that somebody else made: regular ones of a bounded size, and no links.

A folder of artifacts may come from anywhere. Nothing in it is run, and what is
printed of it passes through :func:`bouncing_ball.errors.printable`.
"""

import stat
from pathlib import Path, PurePosixPath

from bouncing_ball.errors import ModelError

MAX_BYTES = 16 * 2**20
"""Size of a file; the largest artifact of the record has half a megabyte."""


class UnreadableError(ModelError):
    """Why a file is not read, in one line that does not name it."""


def read_file(folder: Path, file: str) -> bytes:
    """The content of a regular file in a folder.

    Parameters
    ----------
    folder : Path
        It may itself be a link.
    file : str
        Relative to the folder, with ``/``.

    Raises
    ------
    UnreadableError
        If it is a link or below one, no regular file, or larger than
        :data:`MAX_BYTES`, or if the system refuses.
    """
    parts = PurePosixPath(file).parts
    path = folder.joinpath(*parts)
    try:
        if any(folder.joinpath(*parts[: k + 1]).is_symlink() for k in range(len(parts))):
            raise UnreadableError("a link; links are not followed")
        state = path.stat()
        if not stat.S_ISREG(state.st_mode):
            raise UnreadableError("not a regular file")
        if state.st_size > MAX_BYTES:
            raise UnreadableError(f"larger than {MAX_BYTES} bytes")
        return path.read_bytes()
    except OSError as error:
        raise UnreadableError(error.strerror or type(error).__name__) from None
