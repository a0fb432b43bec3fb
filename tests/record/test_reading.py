"""Files of a folder that nobody vouches for: what is read, and what is refused."""

import os
import signal
import socket
import struct

import pytest
from netCDF4 import Dataset

from bouncing_ball.record import reading
from bouncing_ball.record.reading import (
    MAX_BYTES,
    MAX_FILES,
    MAX_VALUES,
    UnreadableError,
    names_in,
    no_file_opened,
    opened_dataset,
    printable,
    read_file,
)


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "private").write_text("a secret")
    inside = tmp_path / "folder"
    (inside / "figures").mkdir(parents=True)
    (inside / "figures" / "a.csv").write_text("1,2\n")
    return inside


def test_a_file_is_read_whole_also_through_a_link_to_the_folder(folder, tmp_path):
    (tmp_path / "link").symlink_to(folder)
    for way in (folder, tmp_path / "link"):
        assert read_file(way, "figures/a.csv") == b"1,2\n"


def test_what_is_no_regular_file_is_refused(folder, tmp_path, one_line):
    figures = folder / "figures"
    (figures / "link.csv").symlink_to(tmp_path / "private")
    (figures / "inner.csv").symlink_to("a.csv")
    (folder / "other").symlink_to(tmp_path)
    os.mkfifo(figures / "pipe.csv")
    (figures / "folder.csv").mkdir()
    with open(figures / "large.csv", "wb") as large:
        large.truncate(50 * 10**9)
    for file, said in (
        ("figures/link.csv", "a link"),
        ("figures/inner.csv", "a link"),
        ("other/private", "a link"),
        ("../private", "outside the folder"),
        (str(tmp_path / "private"), "outside the folder"),
        ("figures/pipe.csv", "not a regular file"),
        ("figures/folder.csv", "Is a directory"),
        ("figures/large.csv", f"larger than {MAX_BYTES} bytes"),
        ("figures/none.csv", "No such file"),
    ):
        with pytest.raises(UnreadableError) as error:
            read_file(folder, file)
        one_line(error, said)


def test_a_socket_is_refused(folder, monkeypatch):
    # By a short name: a socket's may have a hundred characters.
    monkeypatch.chdir(folder)
    with socket.socket(socket.AF_UNIX) as server:
        server.bind("socket.csv")
        with pytest.raises(UnreadableError):
            read_file(folder, "socket.csv")


def test_names_of_a_folder(folder, one_line):
    for name in ("b", os.fsdecode(b"\xff"), "\x1b[2J"):
        (folder / "figures" / name).touch()
    assert names_in(folder / "figures") == ["\x1b[2J", "a.csv", "b", "\udcff"]
    (folder / "link").symlink_to("figures")
    many = folder / "many"
    many.mkdir()
    for number in range(MAX_FILES + 1):
        (many / str(number)).touch()
    for name, said in (("link", "a link"), ("many", "more than"), ("none", "No such file")):
        with pytest.raises(UnreadableError) as error:
            names_in(folder / name)
        one_line(error, said)


def test_nothing_raw_is_printed():
    text = "a\r\n\x1b]8;;x\x07\u202e\u2028\udc80\x9b"
    shown = printable(text)
    assert shown.isprintable() and shown.encode("utf-8")
    assert shown == "a\\r\\n\\x1b]8;;x\\x07\\u202e\\u2028\\udc80\\x9b"


def test_no_file_is_opened_and_afterwards_again(folder):
    with no_file_opened(), pytest.raises(OSError):
        open(folder / "figures" / "a.csv")
    with open(folder / "figures" / "a.csv") as file:
        assert file.read()


def netcdf(folder, size):
    with Dataset(folder / "a.nc", "w") as dataset:
        dataset.createDimension("t", size)
        dataset.createVariable("x", "f8", ("t",), chunksizes=(10,), compression="zlib")
    return read_file(folder, "a.nc")


def test_a_dataset_of_bounded_size(folder, one_line):
    with opened_dataset(netcdf(folder, 20)) as dataset:
        assert dataset["x"].shape == (20,)
    content = netcdf(folder, 10**12)
    assert MAX_VALUES > len(content)
    with pytest.raises(UnreadableError) as error, opened_dataset(content):
        pass
    one_line(error, "values")


def hang():
    while True:
        pass


def die():
    os.kill(os.getpid(), signal.SIGKILL)


def die_later():
    """As HDF5 does when it closes what it could not open."""

    class Left:
        def __del__(self):
            die()

    left = Left()
    left.cycle = left
    raise OSError


@pytest.mark.parametrize("end", [hang, die, die_later])
def test_a_dataset_at_which_its_library_hangs_or_dies(monkeypatch, end):
    def damaged(*arguments, **keywords):
        end()

    monkeypatch.setattr("netCDF4.Dataset", damaged)
    monkeypatch.setattr(reading, "MAX_SECONDS", 1)
    with pytest.raises(UnreadableError) as error, opened_dataset(b"\x89HDF"):
        pass
    assert str(error.value) == "damaged: reading it does not end, or ends the program"


def test_one_text_that_stands_for_many(folder, one_line):
    # 20 000 references to one text of 4 MB: 80 GB, from a file of 4.4 MB.
    count, length = 20_000, 4_000_000
    with Dataset(folder / "a.nc", "w") as dataset:
        dataset.createDimension("t", count)
        variable = dataset.createVariable("x", str, ("t",), contiguous=True)
        variable[0] = "y" * length
    content = bytearray(read_file(folder, "a.nc"))
    # A reference: length, and place in the heap.
    start = content.index(struct.pack("<I", length))
    content[start : start + 16 * count] = content[start : start + 16] * count
    with pytest.raises(UnreadableError) as error, opened_dataset(bytes(content)):
        pass
    one_line(error, "memory")
