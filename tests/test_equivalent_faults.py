"""The faults that change nothing, and why: each is one that ``make mutants`` can draw."""

import pytest
import yaml
from mutants import PACKAGE, ROOT, faults

LISTED = yaml.safe_load((ROOT / "tests" / "equivalent_faults.yaml").read_text(encoding="utf-8"))


@pytest.mark.parametrize("module", sorted({each["module"] for each in LISTED}))
def test_every_fault_with_a_reason_is_one_of_its_line(module):
    text = (ROOT / PACKAGE / module).read_text(encoding="utf-8")
    lines = [line.strip() for line in text.splitlines()]
    possible = {(lines[each.line - 1], f"{each.before} → {each.after}") for each in faults(text)}
    for each in LISTED:
        if each["module"] == module:
            assert (each["line"], each["fault"]) in possible
            assert each["because"]
