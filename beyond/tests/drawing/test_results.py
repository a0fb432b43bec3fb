"""The figures of the results of calls: titles, and what is drawn where."""

import bouncing_ball_beyond as bb


def test_the_damping_ratio_of_a_ball_is_in_the_title_of_its_figure():
    ball = bb.spring_damper(damping_ratio=0.1, frequency_ratio=10.0)
    figure = bb.history(ball, amplitude=1.0, periods=1).plot()
    texts = [axes.get_title() for axes in figure.axes] + [text.get_text() for text in figure.texts]
    assert any(r"\zeta" in text for text in texts), texts
