"""The jobs that run again after a change, and those that do not.

Which stages depend on a parameter or a module is tested in tests/pipeline/test_reruns.py.
Here it is tested that Snakemake runs these, and all jobs that depend on them, and no others.
"""

import os
import shutil

from bouncing_ball.datasets.files import read_dataset


def test_a_commit_and_remarks_run_nothing_again(complete):
    for file in ("README.md", "requirements.lock"):
        (complete.path / file).write_text("Another text.\n", encoding="utf-8")
    complete.commit("Other words")
    (complete.path / "README.md").write_text("Not committed.\n", encoding="utf-8")
    for file in ("numerics/corrector.py", "drawing/style.py", "paper/exhibits/time_histories.py"):
        complete.edit(file, "# A comment.")
        complete.edit(file, '"""A docstring."""')
    # It only checks the configuration.
    complete.edit("pipeline/configuration_docs.py")
    assert complete.planned() == set()


# What is made from all that is shown.
ALWAYS = {
    *("compute_witness", "set_witness"),
    *("compute_claims", "set_claims", "paper"),
}


def test_a_parameter_a_formula_a_drawing_and_a_lost_file_run_again_what_they_decide(complete):
    complete.configure("paper", "fig12", "amplitude", value=1.1)
    expected = {"compute_fig12", "draw_fig12"}
    complete.edit("paper/exhibits/restitution_model_figures.py")
    expected |= {"draw_fig02", "draw_fig03"}
    complete.edit("paper/claims/forensics.py")
    expected |= {"compute_forensics", "set_forensics"}
    # Which study has which parameters and modules is tested without a run.
    assert complete.planned() == expected | ALWAYS
    printed = "src/bouncing_ball/paper/exhibits/printed_table1.py"
    complete.rewrite(printed, '"1.032"', '"1.033"')
    # The script of each imports the module of Table 1.
    expected |= {"compute_fig08", "draw_fig08", "compute_fig09", "draw_fig09"}
    expected |= {"compute_fig15", "draw_fig15", "compute_table1", "set_table1"}
    # The printed ratio of Fig. 16 is in the module of the printed entries.
    expected |= {"draw_fig11", "draw_fig16"}
    (complete.path / "results/figures/formulas.nc").unlink()
    expected |= {"compute_formulas", "set_formulas"}
    # A picture alone is drawn alone.
    (complete.path / "results/figures/fig13.png").unlink()
    expected |= {"draw_fig13"}
    assert complete.planned() == expected | ALWAYS


def test_no_file_time_hides_a_change_of_the_code(complete):
    equation_7 = "src/bouncing_ball/periodic/restitution_branch.py"
    formula = "np.asarray(n) * np.pi * (1 - r) / (1 + r)"
    complete.rewrite(equation_7, f"return {formula}", f"return 1.001 * {formula}")
    os.utime(complete.path / equation_7, (0, 0))
    again = {"compute_fig02", "draw_fig02", "fig02"}
    complete.run("--cores", "1", "--touch", "fig02")
    # Nor does Snakemake need what it has noted; the other triggers would only add to this.
    shutil.rmtree(complete.path / ".snakemake")
    assert complete.planned("fig02", "--rerun-triggers", "mtime") == again
    dataset = complete.path / "results/figures/fig02.nc"
    before = read_dataset(dataset)
    complete.run("--cores", "1", "results/figures/fig02.nc")
    after = read_dataset(dataset)
    assert float(after.phase) != float(before.phase)
    assert after.attrs["provenance_code"] != before.attrs["provenance_code"]
    assert complete.planned("results/figures/fig02.nc") == set()


def test_another_version_of_a_library_makes_everything_again(complete):
    # What Python finds first is the version that is installed.
    about = complete.path / "src" / "numpy-1.0.dist-info" / "METADATA"
    about.parent.mkdir()
    about.write_text("Metadata-Version: 2.1\nName: numpy\nVersion: 1.0\n", encoding="utf-8")
    assert complete.planned("fig02") == {"compute_fig02", "draw_fig02", "fig02"}
