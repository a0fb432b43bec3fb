"""The jobs that run again after a change, and those that do not.

Which stages depend on a parameter or a module is tested in tests/pipeline/test_reruns.py.
Here it is tested that Snakemake runs these, and all jobs that depend on them, and no others.
"""

import compileall
import os
import shutil

from bouncing_ball.datasets.files import read_dataset


def test_a_commit_runs_nothing_again_and_a_change_what_it_decides(complete):
    for file in ("README.md", "requirements.lock"):
        (complete.path / file).write_text("Another text.\n", encoding="utf-8")
    complete.commit("Other words")
    (complete.path / "README.md").write_text("Not committed.\n", encoding="utf-8")
    # Remarks are no code.
    for file in ("numerics/corrector.py", "drawing/style.py", "paper/exhibits/time_histories.py"):
        complete.edit(file, "# A comment.")
        complete.edit(file, '"""A docstring."""')
    assert complete.planned() == set()
    complete.configure("paper", "fig12", "amplitude", value=1.1)
    # What checks the configuration only, and what only shows, run no science again.
    complete.edit("pipeline/configuration_docs.py")
    complete.edit("paper/exhibits/restitution_model_figures.py")
    complete.edit("paper/claims/forensics.py")
    printed = "src/bouncing_ball/paper/exhibits/printed_table1.py"
    complete.rewrite(printed, '"1.032"', '"1.033"')
    (complete.path / "results/figures/formulas.nc").unlink()
    assert complete.planned() == {
        *("fig12", "Drawing fig12"),
        *("Drawing fig02", "Drawing fig03"),
        *("forensics", "Setting forensics"),
        *("table1", "Setting table1"),
        # These figures are of one stage with the table.
        *("fig08", "Drawing fig08"),
        *("fig09", "Drawing fig09"),
        *("fig15", "Drawing fig15"),
        # The printed ratio of Fig. 16 is in the module of the printed entries.
        *("Drawing fig11", "Drawing fig16"),
        *("formulas", "Setting formulas"),
        # Every orbit shown is followed by the comparison of the three routes.
        *("witness", "Setting witness"),
        *(
            "claims",
            "Setting claims",
            "Writing results/paper.md and results/supplement.md",
        ),
    }


def test_no_file_time_hides_a_change_of_the_code(complete):
    equation_7 = "src/bouncing_ball/periodic/explicit.py"
    formula = "np.asarray(n) * np.pi * (1 - r) / (1 + r)"
    complete.rewrite(equation_7, f"return {formula}", f"return 1.001 * {formula}")
    os.utime(complete.path / equation_7, (0, 0))
    again = {"fig02", "Drawing fig02", "fig02 is up to date"}
    complete.run("--cores", "1", "--touch", "fig02")
    # The other triggers would only add to this.
    assert complete.planned("fig02", "--rerun-triggers", "mtime") == again
    shutil.rmtree(complete.path / ".snakemake")
    assert complete.planned("fig02") == again
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
    assert complete.planned("fig02") == {"fig02", "Drawing fig02", "fig02 is up to date"}


def test_stale_bytecode_is_not_run(fresh):
    """An edit of the same size with the time of the file before it."""
    file = "src/bouncing_ball/paper/exhibits/restitution_model.py"
    path = fresh.path / file
    compileall.compile_file(path, quiet=2, force=True)
    before = path.stat()
    heading = '-> xr.Dataset:\n    """Ball and table'
    fresh.rewrite(file, heading, heading.replace("Dataset", "Dateset"))
    os.utime(path, ns=(before.st_atime_ns, before.st_mtime_ns))
    assert path.stat().st_size == before.st_size
    done = fresh.run("--cores", "1", "fig02", check=False)
    assert done.returncode != 0 and "Dateset" in done.stdout + done.stderr
