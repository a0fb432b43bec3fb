"""What runs again after a change, and what does not.

Which stages a parameter or a module decides is tested in tests/pipeline/test_reruns.py;
here, that Snakemake runs these, and what is made from them.
"""

CLAIMS = {"claims", "Setting claims", "Writing results/paper.md"}
# Every orbit shown is followed by the comparison of the three routes.
WITNESS = {"witness", "Setting witness"}


def test_a_parameter_and_what_is_made_with_it(complete):
    complete.configure("figures", "fig12", "amplitude", value=1.1)
    assert complete.planned() == {"fig12", "Drawing fig12", *WITNESS, *CLAIMS}


def test_what_only_shows_runs_no_science_again(complete):
    complete.edit("figures/long_contacts.py")
    complete.edit("configuration/check.py")
    assert complete.planned() == {"Drawing ext_rattling", "Drawing ext_basins"}


def test_a_module_runs_the_stages_that_import_it(complete):
    complete.edit("claims/verdict.py")
    complete.edit("claims/forensics.py")
    assert complete.planned() == {"forensics", "Setting forensics", *CLAIMS}


def test_a_printed_number_of_table_1_runs_the_table_too(complete):
    complete.rewrite("src/bouncing_ball/studies/printed_table1.py", '"1.032"', '"1.033"')
    remade = {"table1", "forensics", "Setting table1", "Setting forensics"}
    assert complete.planned() == {*remade, *WITNESS, *CLAIMS}


def test_a_dataset_that_is_missing_is_made_again(complete):
    (complete.path / "results/figures/fig08.nc").unlink()
    assert "fig08" in complete.planned("fig08")
