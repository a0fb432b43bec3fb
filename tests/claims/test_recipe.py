"""The recipe "Add a claim" of CONTRIBUTING, as it is written there."""

import re
import shutil
from pathlib import Path

import pytest
import yaml

from bouncing_ball.claims.assessment import assess
from bouncing_ball.claims.ledger_file import read_ledger
from bouncing_ball.errors import ModelError

ROOT = Path(__file__).resolve().parents[2]


def entry():
    """The text of the new claim."""
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    recipe = text[text.index("### Add a claim") :]
    return re.search(r"```yaml\n(.*?)```", recipe, re.DOTALL).group(1)


def write(folder, new):
    """The ledger with a claim more, the last of them."""
    shutil.copy(ROOT / "config" / "claims.schema.yaml", folder)
    text = (ROOT / "config" / "claims.yaml").read_text(encoding="utf-8")
    before, mark, after = text.partition("\n# Why claims are not reproduced.")
    (folder / "claims.yaml").write_text(before + new + mark + after, encoding="utf-8")


def test_the_new_claim_gets_a_verdict_and_the_others_keep_theirs(tmp_path, record_and_new):
    write(tmp_path, entry())
    before = assess(read_ledger(ROOT / "config"), record_and_new).verdict
    after = assess(read_ledger(tmp_path), record_and_new).verdict
    name = yaml.safe_load(entry())[0]["id"]
    assert after.claim.values.tolist() == [*before.claim.values.tolist(), name]
    assert after.sel(claim=name).item() == "reproduced"
    assert after.sel(claim=before.claim).identical(before)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("    item: Table 1\n", "", "missing key claims['fold at 10'].item"),
        ("    uses:", "    use:", "claims['fold at 10'].use"),
        ('below: "0"', "below: 0", "claims['fold at 10'].condition.below = 0 must be"),
    ],
)
def test_a_missing_piece_is_named(old, new, said, tmp_path, one_line):
    assert old in entry()
    write(tmp_path, entry().replace(old, new))
    with pytest.raises(ModelError) as error:
        read_ledger(tmp_path)
    one_line(error, said)
