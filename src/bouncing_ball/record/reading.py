"""Files of a folder that somebody else made, read without trusting them.

A folder of artifacts may come from anywhere. Nothing in it is run, no link in
it is followed, and only regular files of a bounded size are read, each once and
whole: what is parsed afterwards are bytes, so that nothing can change, block or
lead elsewhere on the way. Names and texts from such a folder are printed with
:func:`printable` only.
"""

import gc
import hashlib
import os
import resource
import stat
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

from bouncing_ball.errors import ModelError, escaped

if TYPE_CHECKING:
    from netCDF4 import Dataset

MAX_BYTES = 16 * 2**20
"""Size of a file; the largest artifact of the record has a quarter of a megabyte."""
MAX_VALUES = 2**22
"""Numbers and texts in a dataset, 160 times those of the largest; 32 MB of doubles."""
MAX_SECONDS = 5
"""Processor time for the reading of a dataset; the largest takes some milliseconds."""
MAX_MEMORY = 2**29
"""Bytes, for the reading of a dataset."""
MAX_PIXELS = 2**23
"""Pixels of a picture, four times those of the largest; about half a gigabyte at work."""
MAX_FILES = 1000
"""Entries of a folder, ten times those of the record."""


class UnreadableError(ModelError):
    """Why a file is not read, in one line that does not name it."""


def printable(text: object, width: int | None = 300) -> str:
    """Text on one line in which nothing moves a cursor, hides or turns the reading.

    What Python does not call printable is escaped: controls, line ends, marks of
    direction, halves of surrogate pairs, and so bytes of a name that is not UTF-8.

    Examples
    --------
    >>> printable("fig\\x1b[2J\\n\\u202e08\\udcff")
    'fig\\\\x1b[2J\\\\n\\\\u202e08\\\\udcff'
    >>> printable("Λ = 1 → 2, 1e-13", width=7)
    'Λ = 1 …'
    """
    text = str(text)
    shown = text if width is None or len(text) <= width else text[: width - 1] + "…"
    return escaped(shown)


def reason(error: BaseException) -> str:
    """What an error says, on one short line; its type, where it says nothing.

    Examples
    --------
    >>> reason(ValueError("no\\nsuch thing")), reason(MemoryError())
    ('no such thing', 'MemoryError')
    """
    said = str(error.strerror) if isinstance(error, OSError) and error.strerror else str(error)
    return printable(" ".join(said.split()) or type(error).__name__, width=120)


def _opened(folder: Path, file: str) -> int:
    """A descriptor of a file below a folder, no part of whose name is a link."""
    *above, name = PurePosixPath(file).parts
    # Non-blocking: a pipe without a writer would wait for ever.
    flags = os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC
    at = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        for part in above:
            below = os.open(part, flags | os.O_DIRECTORY, dir_fd=at)
            os.close(at)
            at = below
        return os.open(name, flags, dir_fd=at)
    finally:
        os.close(at)


def is_link(folder: Path, file: str) -> bool:
    """Whether a part of a file's name below the folder is a symbolic link."""
    parts = PurePosixPath(file).parts
    return any(folder.joinpath(*parts[:k]).is_symlink() for k in range(1, len(parts) + 1))


def read_file(folder: Path, file: str, limit: int = MAX_BYTES) -> bytes:
    """The content of a regular file in a folder.

    Parameters
    ----------
    folder : Path
        As the user named it; it may itself be a link.
    file : str
        Relative to the folder, with ``/``.
    limit : int
        Bytes.

    Raises
    ------
    UnreadableError
        If it is a link or below one, no regular file, or larger than the limit,
        or if the system refuses.
    """
    if PurePosixPath(file).is_absolute() or ".." in PurePosixPath(file).parts:
        raise UnreadableError("outside the folder")
    try:
        with open(_opened(folder, file), "rb") as opened:
            state = os.fstat(opened.fileno())
            if not stat.S_ISREG(state.st_mode):
                raise UnreadableError("not a regular file")
            content = b"" if state.st_size > limit else opened.read(limit + 1)
    except OSError as error:
        if is_link(folder, file):
            raise UnreadableError("a link; links are not followed") from None
        raise UnreadableError(reason(error)) from None
    if state.st_size > limit or len(content) > limit:
        raise UnreadableError(f"larger than {limit} bytes")
    return content


def names_in(folder: Path) -> list[str]:
    """Names of what is in a folder, sorted.

    Raises
    ------
    UnreadableError
        If it is a link, cannot be read, or holds more than :data:`MAX_FILES`.
    """
    if folder.is_symlink():
        raise UnreadableError("a link; links are not followed")
    names = []
    try:
        with os.scandir(folder) as entries:
            for entry in entries:
                names.append(entry.name)
                if len(names) > MAX_FILES:
                    raise UnreadableError(f"holds more than {MAX_FILES} files")
    except OSError as error:
        raise UnreadableError(reason(error)) from None
    return sorted(names)


@contextmanager
def no_file_opened() -> Iterator[None]:
    """Within, this process opens no file: a dataset may name others to read from.

    HDF5 has links to other files, and values that lie in them.
    """
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (0, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))


def _read_all(content: bytes) -> None:
    """Read all values and attributes of a dataset, and close it."""
    from netCDF4 import Dataset

    with no_file_opened(), Dataset("memory", memory=content) as dataset:
        _check_size(dataset)
        for name in dataset.ncattrs():
            dataset.getncattr(name)
        for variable in dataset.variables.values():
            for name in variable.ncattrs():
                variable.getncattr(name)
            variable[...]


# Checksums of what has been read to its end: one dataset is asked for what it holds and,
# for each file that is made from it, for where it comes from.
_WHOLE: set[bytes] = set()


def _check_end(content: bytes) -> None:
    """Read all of a dataset in a process of its own, which may crash or hang.

    One flipped bit can keep HDF5 busy for ever, or make it end the program, also
    later, as it closes what it could not open; and many texts of a dataset may be
    one in its file. What is not read there is not opened here.
    """
    checksum = hashlib.sha256(content).digest()
    if checksum in _WHOLE:
        return
    reader, writer = os.pipe()
    with warnings.catch_warnings():
        # Newer Pythons warn of threads, of which the child uses none.
        warnings.simplefilter("ignore", DeprecationWarning)
        child = os.fork()
    if child == 0:
        said = ""
        with suppress(BaseException):
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            resource.setrlimit(resource.RLIMIT_CPU, (MAX_SECONDS, MAX_SECONDS))
            _limit_memory()
            # Only what this process makes is collected: the rest is shared with its parent.
            gc.freeze()
            try:
                _read_all(content)
            except UnreadableError as error:
                said = str(error)
            except BaseException:
                said = "damaged, not ours, or larger than memory"
            # Closes what an error has left open.
            gc.collect()
        os.write(writer, said.encode())
        os._exit(0)
    os.close(writer)
    with open(reader, encoding="utf-8") as pipe:
        said = pipe.read()
    if os.WIFSIGNALED(os.waitpid(child, 0)[1]):
        raise UnreadableError("damaged: reading it does not end, or ends the program")
    if said:
        raise UnreadableError(said)
    _WHOLE.add(checksum)


def _limit_memory() -> None:
    """Let this process take half a gigabyte more; where the system does not say, anything."""
    try:
        pages = int(Path("/proc/self/statm").read_text().split()[0])
    except OSError:
        return
    limit = pages * resource.getpagesize() + MAX_MEMORY
    resource.setrlimit(resource.RLIMIT_AS, (limit, limit))


def _check_size(dataset: "Dataset") -> None:
    if sum(variable.size for variable in dataset.variables.values()) > MAX_VALUES:
        raise UnreadableError(f"more than {MAX_VALUES} values")


@contextmanager
def opened_dataset(content: bytes) -> Iterator["Dataset"]:
    """A netCDF file from its bytes, of a bounded size when it is read.

    What is inside the ``with`` opens no other file. netCDF4 and HDF5 raise
    errors of many types on damaged files; they pass through.

    Raises
    ------
    UnreadableError
        If it holds more than :data:`MAX_VALUES`: compressed, nothing takes no room;
        or if reading it takes more than :data:`MAX_SECONDS`.
    """
    from netCDF4 import Dataset

    _check_end(content)
    with no_file_opened(), Dataset("memory", memory=content) as dataset:
        _check_size(dataset)
        yield dataset
