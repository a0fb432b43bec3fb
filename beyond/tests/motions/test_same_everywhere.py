"""An answer has the same bits on a processor without fast paths."""

import os
import subprocess
import sys

CODE = """
import numpy as np, hashlib
from bouncing_ball_beyond.motions.destination import final_motions
from bouncing_ball_beyond.models.corrected.model import CorrectedModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.contact_model import ContactModel
rng = np.random.default_rng(5)
r, lam, phase = rng.uniform([[0.1], [0.9], [-3]], [[0.95], [5], [3]], (3, 60))
contact = SpringDamper.from_restitution(r, 100.0)
for model in (RestitutionModel(r), ContactModel(contact), CorrectedModel.of_contact(contact)):
    found = final_motions(model, lam, phase, -lam - rng.uniform(0, 12, 60), impacts=160)
    # A chaotic ball of 160 impacts has made a last digit into another motion long ago.
    assert (found.kind == "chaotic").sum() > 5
    for values in (found.end_phase, found.end_velocity, found.periods, found.impacts):
        print(hashlib.sha256(values.tobytes()).hexdigest())
"""


def test_a_processor_without_fast_paths_follows_the_same_balls(capsys):
    plain = {"NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4 AVX512_ICL AVX512_SPR"}
    plain |= {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-AVX512F"}
    exec(CODE, {})
    here = capsys.readouterr().out
    command = [sys.executable, "-W", "ignore", "-c", CODE]
    assert subprocess.check_output(command, env=os.environ | plain, text=True) == here
    assert here.count("\n") == 12
