"""Argument lists of the command line: an answer or one line, and never a traceback."""

import io
import json
import time
import warnings
from collections.abc import Iterator
from contextlib import redirect_stderr, redirect_stdout

import numpy as np

from bouncing_ball.cli.main import main

_NUMBERS = "1 0.5 0.85 0 -1 2 10 1e-300 1e300 1e8 1e-8 nan inf -inf 1e999 0x10 ½ 1,5 1_0".split()
_WORDS = ["", " ", "\n", "\x1b[31m", "Λ", "-", "--", "stable", "all", "force", "null", "\udcff"]
_OPTIONS = {
    "--restitution": None,
    "--measured-restitution": None,
    "--damping-ratio": None,
    "--frequency-ratio": None,
    "--amplitude": None,
    "--phase": None,
    "--velocity": None,
    "--n": ["1", "2", "7", "1000", "0", "-3", "1.5", "10000000000000000000000"],
    "--impacts": ["1", "3", "0", "17"],
    "--index": ["1", "2", "3", "0"],
    "--side": ["stable", "unstable", "all", "left"],
    "--release": ["displacement", "force", "tension"],
    "--model": ["restitution", "spring-damper", "corrected", "ball"],
}
_COMMANDS = ["orbit", "limits", "permanent-contact", "simulate", "error-law"]


def _arguments(rng: np.random.Generator) -> list[str]:
    """Mostly what could be meant: a command, its options with numbers, some nonsense."""
    chance = rng.random()
    if chance < 0.4:
        return _case(rng) if chance < 0.2 else _law(rng)
    command = str(rng.choice([*_COMMANDS, *_COMMANDS, *_COMMANDS, "explain", "diff", "orbits", ""]))
    damping = str(rng.choice(["--restitution", "--measured-restitution", "--damping-ratio"]))
    out = [command, damping, _value(rng, damping), "--amplitude", _value(rng, "--amplitude")]
    if command in ("limits", "permanent-contact"):
        out = out[:3]
    for option in rng.choice(list(_OPTIONS), size=rng.integers(0, 4), replace=False):
        out += [str(option), _value(rng, str(option))]
    if rng.random() < 0.3:
        out.insert(int(rng.integers(len(out) + 1)), str(rng.choice(_WORDS)))
    if rng.random() < 0.1:
        del out[int(rng.integers(len(out)))]
    if rng.random() < 0.5:
        out.append("--json")
    return out


_QUANTITIES = {
    "--frequency": "50 Hz|20 ms|3000 rpm|314 1/s|1e-9 Hz|0|9**9**9**9",
    "--period": "20 ms|50 Hz",
    "--amplitude": "0.1 mm|2 g|1e-300|1e300 m",
    "--acceleration": "0.8 g|3 g|100 g|0.05 g|1e-20 g|1 m/s²|-1 g",
    "--gravity": "1 g|1e-12|0.16 g",
    "--mass": "20 g|1|1e-30|1e30|0 kg|20 grams of steel",
    "--stiffness": "1e7 N/m|2e5|50|1e-20|1e30|-5 N/m|3 Pa",
    "--contact-time": "1 ms|1e-12|1e6 s",
    "--reduced-modulus": "115 GPa|1 Pa",
    "--radius": "5 mm|1 km",
    "--damping": "1|0|1e9",
    "--restitution": "0.85|1|0.1|1e-9|1.5",
    "--measured-restitution": "0.5|0.14",
    "--drop-height": "1 m",
    "--rebound-height": "50 cm|2 m",
    "--tolerance": "1 %|1e-12|5|0",
    "--quantity": "phase|saddle_node|permanent_contact|colour",
    "--n": "1|2|9|0",
    "--release": "force|displacement",
}
_CASE = ("--frequency", "--acceleration", "--mass", "--stiffness", "--restitution")


def _case(rng: np.random.Generator) -> list[str]:
    """A case for the calculator, mostly whole, with some of its values other ones."""
    chosen = [name for name in _CASE if rng.random() < 0.95]
    chosen += map(str, rng.choice(list(_QUANTITIES), size=rng.integers(0, 3), replace=False))
    out = ["design"]
    for name in dict.fromkeys(chosen):
        values = _QUANTITIES[name].split("|")
        out.append(f"{name}={values[0] if rng.random() < 0.7 else rng.choice(values)}")
    if rng.random() < 0.1:
        out.append(str(rng.choice(_WORDS)))
    return [*out, "--json"] if rng.random() < 0.5 else out


_LAWS = ("hunt-crossley", "tsuji", "kuwabara-kono", "linear", "hertz")
_SETTINGS = ("stiffness", "damping", "frequency-ratio", "damping-ratio", "n", "")


def _law(rng: np.random.Generator) -> list[str]:
    """A contact of another law, by its parameters or by restitution and duration."""
    out = [str(rng.choice(["orbit", "limits", "simulate"])), "--law", str(rng.choice(_LAWS))]
    if rng.random() < 0.5:
        named = _SETTINGS[2:4] if out[2] == "linear" else _SETTINGS[:2]
        values = (f"{10.0 ** rng.uniform(0, 7):g}", f"{rng.random():.3g}")
        pairs = [f"{name}={value}" for name, value in zip(named, values, strict=True)]
        if rng.random() < 0.2:
            pairs[0] = f"{rng.choice(_SETTINGS)}={rng.choice(_NUMBERS)}"
        out += [part for pair in pairs for part in ("--set", pair)]
    else:
        out += ["--restitution", _value(rng, "--restitution")]
        out += ["--duration", f"{10.0 ** rng.uniform(-4, 1):g}"]
        if rng.random() < 0.3:
            out += ["--speed", str(rng.choice(_NUMBERS))]
    if out[0] != "limits":
        out += ["--amplitude", _value(rng, "--amplitude")]
    for option in rng.choice(list(_OPTIONS), size=rng.integers(0, 2), replace=False):
        out += [str(option), _value(rng, str(option))]
    return [*out, "--json"] if rng.random() < 0.5 else out


def _value(rng: np.random.Generator, option: str) -> str:
    choices = _OPTIONS[option]
    if choices is not None:
        return str(rng.choice(choices))
    if rng.random() < 0.25:
        return str(rng.choice(_NUMBERS))
    if option in ("--restitution", "--measured-restitution", "--damping-ratio"):
        return repr(float(rng.random()))
    return repr(float(10.0 ** rng.uniform(-2, 3)))


def _wrong(arguments: list[str]) -> str:
    """Empty, or what is wrong with how a call ends."""
    out, err = io.StringIO(), io.StringIO()
    status = 0
    try:
        with warnings.catch_warnings(), redirect_stdout(out), redirect_stderr(err):
            warnings.simplefilter("error")
            main(list(arguments))
    except SystemExit as end:
        status = end.code or 0
    except BaseException as error:  # a traceback for the user
        return f"{type(error).__name__}: {error}"
    said, answered = err.getvalue(), out.getvalue()
    if status not in (0, 1, 2):
        return f"status {status}"
    if said.count("\n") != (status != 0):
        return f"status {status} with {said!r}"
    if "--json" in arguments and answered and "usage" not in answered:
        try:
            json.loads(answered)
        except ValueError as error:
            return f"no JSON: {error}"
    return ""


def attack(seed: int) -> Iterator[list[str]]:
    """Argument lists, one after the other."""
    rng = np.random.default_rng(seed)
    while True:
        arguments = _arguments(rng)
        start = time.process_time()
        wrong = _wrong(arguments)
        took = time.process_time() - start
        yield [f"{arguments}: {wrong or f'took {took:.0f} s'}" if wrong or took > 20 else ""]
