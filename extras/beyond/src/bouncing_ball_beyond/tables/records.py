"""Fit the harmonics of a vibration to a record of it, and see whether harmonics suit it.

The model of the record is an offset, a linear drift, and harmonics of one frequency. It is fitted
by least squares (Gauss and Newton). The noise is judged frequency by frequency from what the model
leaves; it need not be white, but its spectrum must be smooth.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.fft import next_fast_len
from scipy.ndimage import median_filter

PERIOD = 2 * np.pi

CLOCK = 0.01
"""Standard deviation of the given frequency, relative. Clocks of recorders and dials of shakers
are off by less. A record that is too short to tell the frequency keeps the given one."""

SCANNED = 3.0
"""Largest difference from the given frequency at which the fit starts, in units of `CLOCK`."""

ROUNDS = 8
"""Number of steps of Gauss and Newton. From the scan, four steps reach rounding errors."""

WINDOW = 257
"""Number of neighbouring frequencies whose median power is the noise. The median of fewer scatters:
with 65, a hundred times as many good records are refused."""

DRIFTS = 10
"""Largest number of cycles of a drift in the record."""

CHANCE = 1e-3
"""Probability with which noise alone has a tone as large as the smallest that is refused."""


class HarmonicFit(NamedTuple):
    """Harmonics Re Σ a e^{ikΩ(t - t₀)} that were fitted to a record.

    Attributes
    ----------
    frequency, frequency_error : float
        Ω/2π in Hz, and its standard error.
    origin : float
        t₀, the middle of the record.
    waves : array, shape (harmonics,)
        Complex amplitudes a.
    covariance : array, shape (2 harmonics, 2 harmonics)
        Covariance of the real parts and the negative imaginary parts of the amplitudes.
    residual : float
        Root mean square of what is left.
    """

    frequency: float
    frequency_error: float
    origin: float
    waves: NDArray
    covariance: NDArray
    residual: float


def fit_harmonics(time: NDArray, signal: NDArray, frequency: float, orders: NDArray) -> HarmonicFit:
    """Fit harmonics of the given orders, and their frequency near the given one.

    Raises ValueError if the samples do not distinguish the harmonics, or if the fit leaves a tone
    that noise does not explain.
    """
    origin = time.mean()
    t = time - origin
    span = np.ptp(t)
    smooth = np.stack([np.ones(t.size), t / span], axis=1)
    flat = signal - smooth @ np.linalg.lstsq(smooth, signal)[0]
    given = PERIOD * frequency
    turned = np.exp(1j * given * np.multiply.outer(t, orders))
    linear = np.hstack([smooth, turned.real, turned.imag])
    if np.linalg.lstsq(linear, signal, rcond=1e-6)[2] < linear.shape[1]:
        raise ValueError(
            "time: the samples cannot distinguish all harmonics: give fewer harmonics or more"
            " samples"
        )
    rate = _scanned(t, flat, given, orders)
    left = flat
    waves = np.zeros(orders.size, complex)
    for _ in range(ROUNDS):
        turned = np.exp(1j * rate * np.multiply.outer(t, orders))
        linear = np.hstack([smooth, turned.real, turned.imag])
        if not waves.any():
            fitted = np.linalg.lstsq(linear, signal)[0]
            waves = fitted[2:].reshape(2, -1).T @ np.array([1, -1j])
            left = signal - linear @ fitted
        by_rate = t * (turned @ (1j * orders * waves)).real
        # The given frequency counts as one more measurement.
        weight = np.sqrt(np.mean(left**2)) / (CLOCK * given)
        matrix = np.vstack([np.column_stack([linear, by_rate]), np.zeros(linear.shape[1] + 1)])
        matrix[-1, -1] = weight
        fitted = np.linalg.lstsq(matrix, np.append(signal, weight * (given - rate)))[0]
        waves = fitted[2:-1].reshape(2, -1).T @ np.array([1, -1j])
        left = signal - linear @ fitted[:-1] - by_rate * fitted[-1]
        rate += fitted[-1]
    digit = max(np.diff(np.unique(signal)).min(), 1e-13 * np.abs(signal).max())
    # Changes that are larger than the vibration are no drift.
    drifts = DRIFTS if np.var(left) < np.var(flat) / 2 else 0
    noise = _noise_at(t, left, orders * rate / PERIOD, digit, drifts)
    largest = noise[np.abs(waves).argmax()]
    scatter = np.sqrt(np.concatenate([largest + 0 * smooth[0], noise, noise, [largest]]))
    covariance = np.linalg.inv(matrix.T @ matrix) * np.multiply.outer(scatter, scatter)
    error = np.sqrt(covariance[-1, -1]) / PERIOD
    residual = float(np.sqrt(np.mean(left**2)))
    return HarmonicFit(
        float(rate / PERIOD), float(error), origin, waves, covariance[2:-1, 2:-1], residual
    )


def _scanned(t: NDArray, signal: NDArray, rate: float, orders: NDArray) -> float:
    """Ω near the given one at which the harmonics have the largest power.

    In a block of the record the phase of the highest harmonic is off by at most half a radian. The
    changes of the phases from block to block are found by Fourier transforms.
    """
    reach = SCANNED * CLOCK * rate
    length = 1 / (orders[-1] * reach)
    block = ((t - t[0]) / length).astype(int)
    blocks = block[-1] + 1
    size = next_fast_len(32 * int(blocks))
    # The highest harmonic moves by one entry of its transform from shift to shift.
    steps = int(np.ceil(orders[-1] * reach * length * size / PERIOD))
    shifts = np.arange(-steps, steps + 1)
    power = np.zeros(shifts.size)
    for k in orders:
        turned = signal * np.exp(-1j * k * rate * t)
        parts = np.bincount(block, turned.real) + 1j * np.bincount(block, turned.imag)
        spectrum = np.abs(np.fft.fft(parts, size)) ** 2
        power += spectrum[np.round(shifts * k / orders[-1]).astype(int) % size]
    # Of equal powers, as of a short record, the one nearest to the given frequency.
    best = shifts[np.lexsort((np.abs(shifts), -power.round(12)))[0]]
    return rate + best * PERIOD / (orders[-1] * length * size)


def _noise_at(t: NDArray, left: NDArray, tones: NDArray, digit: float, drifts: int) -> NDArray:
    """Variance of the noise per sample at the frequencies of the tones, in Hz.

    Raises ValueError if another tone is larger than noise explains, and larger than half of the
    last digit of the record, which rounding explains. Changes that are slower than half of the
    lowest tone, with at most ``drifts`` cycles in the record, are drifts of the sensor.
    """
    step = np.median(np.diff(np.unique(t)))
    place = np.round((t - t[0]) / step).astype(int)
    size = next_fast_len(int(place[-1]) + 1)
    # Hann's window: a drift that does not end as it begins stays among the slowest frequencies.
    window = np.sin(np.pi * (place + 0.5) / (place[-1] + 1)) ** 2
    window /= np.sqrt(np.mean(window**2))
    power = np.abs(np.fft.rfft(np.bincount(place, left * window, size))) ** 2 / t.size
    frequencies = np.fft.rfftfreq(size, step)
    noise = median_filter(power, min(WINDOW, power.size), mode="reflect") / np.log(2)
    sizes = 2 * np.sqrt(power / t.size) / window.mean()
    judged = frequencies > min(tones[0] / 2, drifts / np.ptp(t))
    with np.errstate(divide="ignore", invalid="ignore"):
        excess = np.where(judged & (sizes > digit / 2), power / noise, 0.0)
    largest = int(excess.argmax())
    if excess[largest] > np.log(max(judged.sum(), 1) / CHANCE):
        raise ValueError(
            f"acceleration: noise does not explain a tone of {sizes[largest]:.3g} m/s² at"
            f" {frequencies[largest]:.5g} Hz that is left next to harmonics of"
            f" {tones[0]:.6g} Hz: give its harmonic, the right frequency, or a part of the record"
            " in which the table moves steadily"
        )
    return np.interp(tones, frequencies, noise)


def overshoot(waves: NDArray) -> float:
    """By which factor the sum Re Σ a e^{ikτ}, k = 1, 2, …, exceeds the function that it stands for.

    It is 1 unless the function jumps. The harmonics then decay as 1/k, so that both halves of them
    have equal sums of |ka|², and the sum exceeds its Fejér mean, which does not overshoot.
    """
    k = np.arange(1, waves.size + 1)
    lower, upper = (part.sum() for part in np.split(np.abs(k * waves) ** 2, [k.size // 2]))
    if k.size < 8 or not lower / 2 < upper < 2 * lower:
        return 1.0
    tau = np.linspace(0, PERIOD, 16 * k.size, endpoint=False)
    turned = np.exp(1j * np.multiply.outer(tau, k))
    sums = turned @ np.stack([waves, waves * (1 - k / (k.size + 1))], axis=1)
    whole, mean = np.abs(sums.real).max(axis=0)
    return float(whole / mean)
