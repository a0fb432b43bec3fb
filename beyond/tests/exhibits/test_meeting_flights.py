"""The flights before and after a contact, continued to the instant at which they meet."""

import numpy as np
import pytest

from bouncing_ball_beyond.exhibits.corrected_model import meeting_flights
from bouncing_ball_beyond.inherited.pipeline.job import typed

PARAMETERS = {
    "n": 1,
    "restitution": 0.65,
    "amplitude": 1.0,
    "frequency_ratio": 4.0,
    "samples": 4001,
}


@pytest.mark.parametrize("release", ["displacement", "force"])
def test_the_flights_meet_at_the_centroid_of_the_force(described, release):
    data = described(typed(meeting_flights)(PARAMETERS, release))
    force = data.contact_force.values
    time = data.time.values
    centroid = np.sum(force * time) / np.sum(force)
    # The force starts with a jump, which a sum over samples sees to their distance.
    assert float(data.meeting_time) == pytest.approx(centroid, abs=2 * (time[1] - time[0]))
    height = np.interp(float(data.meeting_time), time, data.flight_after.values)
    assert float(data.meeting_height) == pytest.approx(height, abs=1e-5)
    # The ball is below the table while it touches, and above it before.
    gap = (data.ball - data.table).values
    inside = (time > 0) & (time < data.contact_duration.item())
    assert np.all(gap[inside] < 0) and np.all(gap[time < 0] > 0)
    assert float(data.delay) == pytest.approx(float(data.meeting_time), rel=0.05)


def test_the_fewest_samples_show_the_contact():
    release = "displacement"
    data = typed(meeting_flights)(PARAMETERS | {"samples": 11}, release)
    touching = (data.time >= 0) & (data.time <= data.contact_duration)
    assert int(touching.sum()) >= 4
    with pytest.raises(ValueError, match="greater than or equal to 11"):
        typed(meeting_flights)(PARAMETERS | {"samples": 10}, release)
