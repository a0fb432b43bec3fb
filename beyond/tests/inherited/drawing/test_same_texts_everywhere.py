"""Rounding moves no letter of the tables and of the article.

The accepted datasets are perturbed as another processor perturbs them, and
everything that is read from them is made again: evidence, verdicts, tables, text.
"""

from article_checks import moved


def test_rounding_changes_no_text(record, texts, accepted):
    assert moved(texts, record, accepted) == []
