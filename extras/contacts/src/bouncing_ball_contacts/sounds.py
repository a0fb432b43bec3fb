"""Times of the impacts of a ball in a sound, as a telephone records it.

1. A high-pass filter removes voices and hum. Its output has an energy in blocks of 0.5 ms.
2. Sounds begin where the energy rises: its mean over 2 ms after an instant is compared with the
   mean over 5 ms before it. An echo of a louder sound has a smaller weight.
3. Impacts are a series of these sounds. The intervals between impacts shrink by a ratio that
   changes slowly. The series with the largest score is found by dynamic programming.
4. An impact is where the sound first reaches 20 % of its peak.

What makes another source likely, such as claps, is a doubt. A series with two doubts is
refused.
"""

import math
import warnings
from dataclasses import dataclass
from html import escape
from io import BytesIO
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.io import wavfile
from scipy.ndimage import maximum_filter1d
from scipy.signal import butter, sosfilt

from bouncing_ball_contacts.units import Array, Refused, holding, refuse, show, span

CUTOFFS = (1000.0, 200.0)
"""Frequencies in Hz of the high-pass filter. A soft ball is heard only above the second one."""
LONGEST_SOUND = 240.0
"""Length of a sound in s, above which a part has to be chosen."""
MOST_SOUNDS = 300
"""Number of sounds of which a series is chosen; the clearest ones are kept."""
_BLOCK = 5e-4
# Blocks after and before a rise, after a louder sound (its echo), and before a louder sound (a
# codec smears it backwards).
_AFTER, _BEFORE, _ECHO, _SMEARED = 4, 10, 120, 24
# In dB: the smallest rise of a sound, and the rise above which its weight is 1.
_SMALLEST_RISE, _CLEAR_RISE = 5.0, 15.0
# In s: the smallest distance of two sounds, and distances within which loudness is compared.
_NEAREST, _NEIGHBOURS = 0.012, 0.5
# In s: the shortest and the longest flight.
_SHORTEST, _LONGEST = 0.025, 2.0
# Ratios of two flights: the smallest and the largest one, and the median of evenly spaced sounds.
_SMALLEST_RATIO, _LARGEST_RATIO, _EVEN = 0.35, 1.03, 0.993
# Standard deviations of the change of ln r from impact to impact, and of an onset in s.
_CHANGE, _JITTER = 0.07, 0.0006
# Loudness goes as a power of the speed. Balls have 0.65 to 1.6, also if a telephone levels it. A
# smaller one is doubtful, and below the smallest one no ball is heard.
_USUAL_EXPONENT, _SMALLEST_EXPONENT = 0.6, 0.3
_FEWEST, _SMALLEST_SCORE = 5, 3.5
# Columns of a picture in a second, which keep the numbers of impacts apart, and its height.
_COLUMNS, _HEIGHT = 500, 240


@dataclass(frozen=True, eq=False)
class Sound:
    """A recorded sound, or a part of it.

    Attributes
    ----------
    name : str
        Name of the file.
    rate : int
        Samples per second.
    begin : float
        Time of the first sample in s.
    samples : array
        Shape (number of samples, number of channels). The largest one is 1 in size.
    """

    name: str
    rate: int
    begin: float
    samples: Array


class Rises(NamedTuple):
    """Sounds that begin suddenly, in order of their times; arrays of one length.

    Attributes
    ----------
    times, delays : array
        When a sound reaches 20 % of its peak, in s, and the time from there to 40 %.
    loudness : array
        Root of the mean energy.
    weights, costs : array
        From 0 to 1: what a series gains if the sound is an impact, and loses if it is another one.
    """

    times: Array
    delays: Array
    loudness: Array
    weights: Array
    costs: Array


@dataclass(frozen=True, eq=False)
class Heard:
    """Impacts of a ball in a sound.

    Attributes
    ----------
    times : array
        Times of the impacts in s.
    resolution : float
        Standard deviation of a time in s.
    notes : tuple of str
        Doubts, and what to look at.
    """

    times: Array
    resolution: float
    notes: tuple[str, ...]

    def __str__(self) -> str:
        ends = span(self.times[0], self.times[-1])
        return f"{len(self.times)} impacts from {ends} s, each to {show(self.resolution, 's', 2)}"

    @property
    def labels(self) -> str:
        """Labels as Audacity imports and exports them, one for each impact."""
        return "".join(f"{t:.6f}\t{t:.6f}\t{i}\n" for i, t in enumerate(self.times, 1))


def sound_of(path: Path | BytesIO, begin: float = 0.0, end: float = math.inf) -> Sound:
    """Return the sound of a WAV file, or of its bytes, between two times in s.

    Raises
    ------
    Refused
        If the file cannot be read, or the part has no sound, less than 0.2 s or more than
        :data:`LONGEST_SOUND`.
    """
    name = path.name if isinstance(path, Path) else "the sound"
    with path.open("rb") if isinstance(path, Path) else path as file, warnings.catch_warnings():
        # Chunks that are not known are those of editors.
        warnings.simplefilter("ignore", wavfile.WavFileWarning)
        try:
            rate, data = wavfile.read(file)
        except Exception:
            # SciPy has no error of its own for a damaged file.
            raise Refused(
                f"{name} is no WAV that can be read: convert it by ffmpeg -i {name} converted.wav"
            ) from None
    refuse([(rate < 8000, f"{name} has {rate} samples a second: 8000 are needed")])
    part = slice(*(round(min(t, len(data) / rate) * rate) for t in (begin, end)))
    samples = np.atleast_2d(data[part].T).T.astype(float)
    lasts = len(samples) / rate
    refuse(
        [
            (
                begin < 0,
                f"a part of {name} that begins at {begin:g} s begins before the sound",
            ),
            (
                lasts < 0.2,
                f"{name} has {lasts:.3g} s of sound in this part of {len(data) / rate:.4g} s: "
                "0.2 s are needed",
            ),
            (
                lasts > LONGEST_SOUND,
                f"{name} has {lasts:.4g} s of sound, more than {LONGEST_SOUND:g} s: choose a "
                "fall by --from and --to",
            ),
            (not np.isfinite(samples).all(), f"{name} has samples that are no numbers"),
        ]
    )
    # Eight bits are around 128, and a microphone may have an offset.
    samples -= np.median(samples, axis=0)
    loudest = np.abs(samples).max()
    refuse([(loudest == 0, f"{name} is silent")])
    return Sound(name, rate, begin, samples / loudest)


def _onset(high: Array, rate: int, start: int) -> tuple[float, float]:
    """Return when a sound next to a sample first reaches 20 and 40 % of its peak, in s."""
    first = max(start - round(0.003 * rate), 0)
    size = np.sqrt(np.sum(high[first : start + round(0.003 * rate)] ** 2, axis=1))
    silence = high[max(first - round(0.005 * rate), 0) : first + 1]
    noise = 4 * math.sqrt(np.mean(np.sum(silence**2, axis=1)))
    peak = size.max()
    reached = [np.argmax(size >= max(part * peak, min(noise, 0.8 * peak))) for part in (0.2, 0.4)]
    return (first + int(reached[0])) / rate, (first + int(reached[1])) / rate


def rises_of(sound: Sound, cutoff: float) -> Rises:
    """Return the sounds that begin suddenly above a frequency in Hz."""
    # A filter that looks ahead would move the onsets.
    sections = butter(4, min(cutoff, sound.rate / 10), "highpass", fs=sound.rate, output="sos")
    high = sosfilt(sections, sound.samples, axis=0)
    size = round(_BLOCK * sound.rate)
    blocks = len(high) // size
    squares = np.sum(high[: blocks * size] ** 2, axis=1)
    energy = squares.reshape(blocks, size).mean(axis=1)
    after = np.convolve(energy, np.full(_AFTER, 1 / _AFTER))[_AFTER - 1 :]
    before = np.pad(np.convolve(energy, np.full(_BEFORE, 1 / _BEFORE)), (1, 0))[:blocks]
    floor = max(np.quantile(before, 0.2), 1e-9)
    rise = 10 * np.log10((after + floor) / (before + floor))
    # What was before the first sample is not known.
    rise[:_BEFORE] = 0.0
    loudness = np.sqrt(maximum_filter1d(after, 2 * _AFTER + 1) + 1e-15)
    beside = (_ECHO - _SMEARED) // 2
    louder = maximum_filter1d(loudness, _ECHO + _SMEARED, origin=beside, mode="constant")
    near = maximum_filter1d(loudness, 2 * round(_NEIGHBOURS / _BLOCK))
    weight = np.clip(rise / _CLEAR_RISE, 0, 1) * loudness / louder
    cost = (weight * np.minimum(1, 3 * loudness / near)) ** 2
    width = 2 * round(_NEAREST / _BLOCK / 2) - 1
    peaks = np.flatnonzero((rise >= _SMALLEST_RISE) & (rise == maximum_filter1d(rise, width)))
    kept = np.sort(peaks[np.argsort(-weight[peaks])[:MOST_SOUNDS]])
    onsets = np.array([_onset(high, sound.rate, i * size) for i in kept]).reshape(-1, 2)
    return Rises(
        sound.begin + onsets[:, 0],
        np.diff(onsets)[:, 0],
        loudness[kept],
        weight[kept],
        cost[kept],
    )


def series_of(rises: Rises) -> tuple[NDArray[np.intp], float]:
    """Return the indices of the sounds of the series with the largest score, and the score.

    The score is the sum of the weights w of the impacts, less the costs of the sounds between them,
    and less 0.1 d² for each ratio of two flights. Here d is the change of ln r in standard
    deviations. The search begins with the last impacts: where the ball is released, among other
    loud sounds, the ratio is known. The best series that begins with the sounds k and j, b(k, j),
    follows from::

        b(k, j) = max over i of  b(j, i) + w(k) - costs between k and j - 0.1 d²

    A series of fewer than five impacts, or with a small score, is empty.
    """
    nothing = np.zeros(0, int), 0.0
    times = -rises.times[::-1]
    weights = rises.weights[::-1]
    passed = np.concatenate([[0.0], np.cumsum(rises.costs[::-1])])
    gains = weights - (passed[None, :-1] - passed[1:, None])
    flights = times[None, :] - times[:, None]
    is_flight = (flights > _SHORTEST) & (flights < _LONGEST)
    if not is_flight.any():
        return nothing
    scores = np.where(is_flight, weights[:, None] + gains, -np.inf)
    ratios = np.full(flights.shape, math.nan)
    previous = np.full(flights.shape, -1)
    for middle in np.flatnonzero(is_flight.any(axis=0) & is_flight.any(axis=1)):
        before = np.flatnonzero(is_flight[:, middle])
        after = np.flatnonzero(is_flight[middle])
        last = flights[before, middle][:, None]
        step = flights[middle, after]
        error = 2.5 * _JITTER / np.minimum(step, last)
        ratio = np.log(last / step)
        # The first ratio of a series changes nothing.
        change = np.nan_to_num(ratio - ratios[before, middle][:, None]) / np.hypot(_CHANGE, error)
        reached = scores[before, middle][:, None] + gains[middle, after] - 0.1 * change**2
        is_ratio = (ratio > math.log(_SMALLEST_RATIO)) & (ratio < math.log(_LARGEST_RATIO) + error)
        reached[~is_ratio | (np.abs(change) > 3)] = -np.inf
        best = (np.argmax(reached, axis=0), np.arange(len(after)))
        is_better = reached[best] > scores[middle, after]
        previous[middle, after] = np.where(is_better, before[best[0]], -1)
        ratios[middle, after] = np.where(is_better, ratio[best], math.nan)
        scores[middle, after] = np.maximum(reached[best], scores[middle, after])
    first, last = np.unravel_index(np.argmax(scores), scores.shape)
    series = [last, first]
    while previous[first, last] >= 0:
        first, last = previous[first, last], first
        series.append(first)
    score = float(scores.max())
    is_series = len(series) >= _FEWEST and score >= _SMALLEST_SCORE
    return (len(times) - 1 - np.array(series), score) if is_series else nothing


def _doubts(rises: Rises, series: NDArray[np.intp], exponent: float) -> list[str]:
    """Return what makes it doubtful that sounds are those of a ball.

    Loudness goes as the speed to the power of the exponent.
    """
    flights = np.diff(rises.times[series])
    ratios = np.log(flights[1:] / flights[:-1])
    among = rises.costs[series[0] : series[-1] + 1]
    share = rises.costs[series].sum() / among.sum()
    usual = math.exp(np.median(ratios))
    return holding(
        [
            (len(series) < 7, f"only {len(series)} impacts"),
            (ratios.std() > 0.035, f"the ratios deviate by {100 * ratios.std():.0f} %"),
            (share < 0.8, f"{len(among) - len(series)} other sounds are among them"),
            (usual > 0.97, f"the ratio of intervals is {usual:.3f}"),
            (exponent < _USUAL_EXPONENT, f"loudness goes as the speed to the {exponent:.2f}"),
        ]
    )


def _other_falls(rises: Rises, series: NDArray[np.intp]) -> list[str]:
    """Return where other falls are heard, before and after a series."""
    notes = []
    for rest in (slice(series[0]), slice(series[-1] + 1, None)):
        left = Rises(*(array[rest] for array in rises))
        times = left.times[series_of(left)[0]]
        if len(times):
            begin = max(times[0] - 0.1, 0.0)
            notes.append(f"another fall: --from {begin:.2f} --to {times[-1] + 0.1:.2f}")
    return notes


def listen(sound: Sound) -> Heard:
    """Return the impacts of a ball in a sound.

    Raises
    ------
    Refused
        If no series of impacts is heard, or more than one doubt makes another source likely.
    """
    filtered = [rises_of(sound, cutoff) for cutoff in CUTOFFS]
    candidates = [(*series_of(rises), rises) for rises in filtered]
    series, _, rises = max(candidates, key=lambda candidate: candidate[1])
    if not len(series):
        raise Refused(
            f"{sound.name}: no series of {_FEWEST} impacts is heard whose intervals shrink by one "
            "ratio; labels by hand are read, too"
        )
    times = rises.times[series]
    flights = np.diff(times)
    if np.median(flights[1:] / flights[:-1]) > _EVEN:
        raise Refused(
            f"{sound.name}: the sounds from {times[0]:.2f} s come every {np.median(flights):.3g} "
            "s, but the intervals of a bouncing ball shrink: choose another part with --from and "
            "--to"
        )
    # The speed of an impact goes as the flight before it.
    both = np.cov(np.log(flights), np.log(rises.loudness[series[1:]]))
    exponent = float(both[0, 1] / both[0, 0])
    doubts = _doubts(rises, series, exponent)
    refuse(
        [
            (
                exponent < _SMALLEST_EXPONENT,
                f"{sound.name}: the sounds from {times[0]:.2f} s get closer, but not softer as "
                f"those of a ball do: their loudness goes as the speed to the {exponent:.2f}",
            ),
            (
                len(doubts) > 1,
                f"{sound.name}: the {len(series)} sounds from {times[0]:.2f} s are doubtful: "
                f"{'; '.join(doubts)}",
            ),
        ]
    )
    delays = rises.delays[series]
    # 1.5 times the median deviation is the standard deviation of a normal distribution.
    spread = 1.5 * float(np.median(np.abs(delays - np.median(delays))))
    return Heard(
        times,
        math.hypot(spread, 5e-5),
        (*(f"doubtful: {doubt}" for doubt in doubts), *_other_falls(rises, series)),
    )


def picture_of(sound: Sound, heard: Heard) -> str:
    """Return a picture in SVG: the sound over time, and its impacts in red with their numbers."""
    begin = max(heard.times[0] - 0.3, sound.begin)
    first = round((begin - sound.begin) * sound.rate)
    end = round((heard.times[-1] + 0.3 - sound.begin) * sound.rate)
    size = round(sound.rate / _COLUMNS)
    count = (min(end, len(sound.samples)) - first) // size
    columns = sound.samples[first : first + count * size].reshape(count, -1)
    heights = _HEIGHT / 2 * (1 - np.column_stack([columns.max(axis=1), columns.min(axis=1)]))
    wave = "".join(f"M{x} {top:.1f}V{low + 0.5:.1f}" for x, (top, low) in enumerate(heights))

    def mark(t: float, colour: str, top: float, y: float, text: str) -> str:
        x = f"{(t - begin) * sound.rate / size:.1f}"
        line = f'<path d="M{x} {top}V{_HEIGHT}" stroke="{colour}"/>'
        return f'{line}<text x="{x}" y="{y}" fill="{colour}" text-anchor="middle">{text}</text>'

    tenths = range(math.ceil(10 * begin), math.floor(10 * (begin + count * size / sound.rate)) + 1)
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{count}" height="{_HEIGHT + 40}" '
            f'viewBox="0 -20 {count} {_HEIGHT + 40}" font-family="sans-serif" font-size="9">',
            f"<title>{escape(sound.name)}</title>",
            '<rect y="-20" width="100%" height="100%" fill="white"/>',
            *(mark(i / 10, "grey", _HEIGHT - 6, _HEIGHT + 12, f"{i / 10:.1f} s") for i in tenths),
            f'<path d="{wave}" stroke="steelblue"/>',
            *(mark(t, "red", 0, -5, str(i)) for i, t in enumerate(heard.times, 1)),
            "</svg>\n",
        ]
    )
