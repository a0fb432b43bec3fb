"""The jobs that run again after a change, and those that do not.

Which stages depend on a parameter or a module is tested in tests/pipeline/test_reruns.py.
Here it is tested that Snakemake runs these, and all jobs that depend on them, and no others.
"""


def test_a_commit_runs_nothing_again_and_a_change_what_it_decides(complete):
    for file in ("README.md", "requirements.lock"):
        (complete.path / file).write_text("Another text.\n", encoding="utf-8")
    complete.commit("Other words")
    (complete.path / "README.md").write_text("Not committed.\n", encoding="utf-8")
    complete.configure("figures", "fig12", "amplitude", value=1.1)
    # What checks the configuration only, and what only shows, run no science again.
    complete.edit("pipeline/configuration_docs.py")
    complete.edit("beyond/exhibits/cascades_figures.py")
    complete.edit("paper/claims/forensics.py")
    printed = "src/bouncing_ball/paper/exhibits/printed_table1.py"
    complete.rewrite(printed, '"1.032"', '"1.033"')
    (complete.path / "results/figures/formulas.nc").unlink()
    assert complete.planned() == {
        *("fig12", "Drawing fig12"),
        "Drawing ext_flights",
        *("forensics", "Setting forensics"),
        # Figure 15 is of one module with the table.
        *("table1", "Setting table1"),
        *("fig15", "Drawing fig15"),
        *("formulas", "Setting formulas"),
        # Every orbit shown is followed by the comparison of the three routes.
        *("witness", "Setting witness"),
        *("claims", "Setting claims", "Writing results/paper.md and results/supplement.md"),
        "statements",
    }
