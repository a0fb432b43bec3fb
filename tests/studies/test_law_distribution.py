"""The recorded distribution of the error law against a fresh sample of its own."""

import csv
from pathlib import Path

import numpy as np
import pytest

from bouncing_ball.accuracy.quantities import OF_IMPACTS
from bouncing_ball.contacts.release import Release
from bouncing_ball.parameters import Span
from bouncing_ball.studies import law_distribution as distribution

RECORD = Path(__file__).resolve().parents[2] / "config" / "error_law.csv"
ROWS = list(csv.DictReader(RECORD.read_text(encoding="utf-8").splitlines()))
SPAN = Span(min=distribution.DECADES[0], max=distribution.DECADES[-1], samples=2)
# Another seed than the record's.
SIZE, SEED = 1500, 20240
# Of some 700 comparisons none is this many standard deviations off by chance.
FAR = 5


@pytest.fixture(scope="module", params=list(Release))
def drawn(request):
    return request.param, distribution.sample(SIZE, SEED, SPAN, request.param)


def rows(release):
    """Row, index of its quantity, and which orbits of a sample it is about."""
    for row in ROWS:
        if row["release"] == release:
            yield row, OF_IMPACTS.index(row["quantity"]), float(row["from"]), float(row["to"])


def test_the_record_is_complete():
    assert list(ROWS[0]) == distribution.HEADER
    ranges = len(distribution.DECADES)
    assert len(ROWS) == 2 * len(OF_IMPACTS) * ranges
    assert all(int(row["exceed"]) == 0 for row in ROWS)
    assert min(int(row["orbits"]) for row in ROWS if row["to"] == "10000") > 0


def test_a_fresh_sample_has_the_recorded_quantiles(drawn):
    release, errors = drawn
    compared = 0
    for row, k, low, high in rows(release):
        inside = (errors.frequency_ratio >= low) & (errors.frequency_ratio <= high)
        inside &= np.isfinite(errors.restitution[k])
        ratio = errors.restitution[k, inside] / errors.law[k, inside]
        for key in (name for name in row if name.endswith(" %") and name[0].isdigit()):
            share = float(key.removesuffix(" %")) / 100
            # How many of the sample lie below the recorded quantile is binomial;
            # its four digits matter where the ratio hardly leaves 1.
            edge = float(row[key])
            step = 0.5 * 10.0 ** (np.floor(np.log10(abs(edge))) - 3)
            below, above = np.mean(ratio < edge + step), np.mean(ratio < edge - step)
            spread = FAR * np.sqrt(share * (1 - share) / ratio.size)
            assert above - spread <= share <= below + spread, (row["quantity"], low, high, key)
            compared += 1
    assert compared > 200
