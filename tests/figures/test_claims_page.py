"""The page of the claims can be read without the article."""

import numpy as np

from bouncing_ball.figures.tables.claims_page import page
from bouncing_ball.figures.tables.formats import to_markdown
from bouncing_ball.figures.tables.rows import claims


def test_the_columns_come_before_the_table_and_what_decides_a_claim_after_it(recorded):
    data = recorded["claims"]
    header, _ = claims(data)
    before, table, after = page(data).partition(to_markdown(*claims(data)))
    assert table
    assert [name for name in header if f"- **{name}**" not in before] == []
    verdicts = np.unique(data.verdict.values)
    assert [verdict for verdict in verdicts if f"*{verdict}*" not in before] == []
    assert all(name in after for name in data.claim.values)
    for text in (*data.condition.values, *data.remark.values, *data.explanation_text.values):
        assert text in after
    assert after.count("The verdict depends on the reading") == np.sum(
        data.verdict.values == "undecidable"
    )
    explained = set(data.explained_by.values) - {""}
    assert all(f"- **{name}**: " in after for name in explained)
