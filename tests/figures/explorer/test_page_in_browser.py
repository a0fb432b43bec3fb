"""The explorer in a real browser: its numbers against the command line, its badge, its manners.

Another page, made here, shows it in frames and writes down what the browser made of it. The
policy of the page keeps its own scripts only; what is asked is asked from outside.
"""

import html
import json
import math
import re
import shlex

import numpy as np
import pytest
from PIL import Image
from pypdf import PdfReader

from bouncing_ball.cli.main import main
from bouncing_ball.configuration.study import typed
from bouncing_ball.figures.explorer.document import BOUND, sources, to_html
from bouncing_ball.studies.reference_orbits import reference_orbits

pytestmark = pytest.mark.slow

REFERENCES = {"frequency_ratio": {"min": 1.0, "max": 1e4, "samples": 250}, "seed": 31}
STATES = 200

OBSERVER = """<!doctype html>
<meta charset="utf-8">
<iframe id="right" src="right.html#r=0.65&w=6&a=1&nonsense=1" width="1100" height="2000"></iframe>
<iframe id="small" src="right.html#tab=design" width="360" height="2000"></iframe>
<iframe id="small2" src="right.html" width="360" height="2000"></iframe>
<iframe id="wrong" src="wrong.html" width="600" height="600"></iframe>
<iframe id="tampered" src="tampered.html" width="600" height="600"></iframe>
<pre id="seen"></pre>
<script>
const frame = name => document.getElementById(name);
const badge = name => {
  const found = frame(name).contentDocument.getElementById("badge");
  return {kind: found.className, text: found.textContent, worst: found.dataset.worst,
    colour: frame(name).contentWindow.getComputedStyle(found).backgroundColor};
};
const text = (page, id) => page.getElementById(id).textContent;
function stateOf(page) {
  const cells = [...page.querySelectorAll("[data-key]")];
  return {
    command: text(page, "command"), verdict: text(page, "verdict"),
    values: Object.fromEntries(cells.map(cell => [cell.dataset.key, cell.dataset.value])),
  };
}
const wait = event => new Promise(done => event(done));
addEventListener("load", () => observe().catch(error => {
  document.getElementById("seen").textContent = error.stack;
}));
async function observe() {
  const view = frame("right").contentWindow, page = frame("right").contentDocument;
  const seen = {first: stateOf(page), refused: text(page, "refused"), states: []};
  for (const hash of STATES) {
    view.explorer.show(hash);
    seen.states.push(stateOf(page));
  }
  // As a reader would: by the address, a slider, a key.
  await wait(done => {
    view.addEventListener("hashchange", () => setTimeout(done), {once: true});
    view.location.hash = "#r=0.5&w=20&a=1.2&n=1&release=force";
  });
  seen.byAddress = stateOf(page);
  const slider = page.getElementById("slide-w");
  slider.value = 1.5;
  slider.dispatchEvent(new view.Event("input"));
  seen.bySlider = {hash: view.location.hash, typed: page.getElementById("w").value};
  const typed = page.getElementById("r");
  typed.value = "1.5";
  typed.dispatchEvent(new view.Event("input"));
  seen.invalid = {marked: typed.getAttribute("aria-invalid"), hash: view.location.hash};
  const tab = page.getElementById("tab-orbit");
  tab.dispatchEvent(new view.KeyboardEvent("keydown", {key: "ArrowRight", bubbles: true}));
  const address = view.location.hash;
  view.explorer.show("#tab=design&m=20&f=50&acc=0.8&k=1e7&r=0.85&release=force");
  seen.tab = {
    selected: [...page.querySelectorAll("[role=tab]")].map(
      each => each.getAttribute("aria-selected")),
    focused: page.activeElement.id, shown: !page.getElementById("panel-design").hidden,
    hidden: page.getElementById("panel-orbit").getBoundingClientRect().height,
    hash: address, command: text(page, "command"),
    rows: Object.fromEntries([...page.querySelectorAll("#design-rows td")].map(
      cell => [cell.dataset.key, cell.dataset.value])),
  };
  const dot = () => page.querySelector("#motion circle").getAttribute("cx");
  const before = dot();
  page.getElementById("play").click();
  await wait(done => setTimeout(done, 400));
  seen.moved = [before, dot(), page.getElementById("play").getAttribute("aria-pressed")];
  page.getElementById("play").click();
  seen.badges = Object.fromEntries(["right", "wrong", "tampered"].map(name => [name, badge(name)]));
  const references = JSON.parse(text(page, "references"));
  references.orbits = references.orbits.filter((_, k) => k % 20 === 0);
  // Outside the page, where its policy is not in force.
  seen.mutants = MUTANTS.map(model =>
    new Function("given", model + "; return compareReferences(given).worst")(references));
  seen.unlabelled = [...page.querySelectorAll("input, button, svg[role=img], [role=tab]")]
    .filter(each => !(each.labels?.length || each.getAttribute("aria-label")
      || each.querySelector?.("title")?.textContent || each.textContent.trim()))
    .map(each => each.outerHTML.slice(0, 80));
  seen.duplicates = [...page.querySelectorAll("[id]")].map(each => each.id)
    .filter((id, k, all) => all.indexOf(id) !== k);
  seen.pointing = [...page.querySelectorAll("[aria-controls], [aria-labelledby]")].map(
    each => each.getAttribute("aria-controls") ?? each.getAttribute("aria-labelledby"))
    .filter(id => !page.getElementById(id));
  seen.overflow = ["small", "small2"].map(name => {
    const root = frame(name).contentDocument.documentElement;
    return root.scrollWidth - root.clientWidth;
  });
  // What the policy lets out: nothing.
  const blocked = [];
  page.addEventListener("securitypolicyviolation", event => blocked.push(event.effectiveDirective));
  try { await view.fetch("https://example.org/"); } catch { /* refused */ }
  const image = page.createElement("img");
  image.src = "https://example.org/image.png";
  page.body.append(image);
  await wait(done => setTimeout(done, 100));
  seen.blocked = blocked;
  seen.requests = view.performance.getEntriesByType("resource").map(entry => entry.name)
    .filter(name => !name.startsWith("https://example.org/"));
  document.getElementById("seen").textContent = JSON.stringify(seen);
}
</script>
"""


def states():
    """Random hashes about the stable ranges, and beyond."""
    rng = np.random.default_rng(7)
    for k in range(STATES):
        r, w = rng.uniform(0.2, 0.99), 10 ** rng.uniform(0.2, 3.5)
        n, release = int(rng.integers(1, 5)), ("displacement", "force")[k % 2]
        low = n * math.pi * (1 - r) / (1 + r)
        high = math.hypot(low, 2 * (1 + r * r) / (1 + r) ** 2)
        a = low + rng.uniform(-0.25, 1.3) * (high - low)
        side = "stable" if k % 4 < 3 else "unstable"
        yield f"#r={r:.4f}&w={w:.6g}&a={max(a, 0.01):.5f}&n={n}&release={release}&side={side}"


# Coefficients of the model, with the text about them.
COEFFICIENTS = (
    "loss = {2} * zeta * omega, detuning",
    "-flight * flight / {2} - lag * g",
    "twice = {2} * sine, lag",
    "({1} - zeta) * (1 + zeta)), perAngle",
    "- {2} * (zeta - sine) * omega * bounce",
    "rising * rising / {2}",
    "n * Math.PI * ({1} - r) / (1 + r)",
    "Math.hypot({2} * (1 + r * r)",
    "const trace = {1} + r * r",
    "load: ({1} - r) * through",
    "rest = {2} * half - delay",
    "(bounce + after / {2}) * after",
    "force: -({2} * zeta * omega * speed",
)


def mutated():
    """The model with one coefficient wrong by a hundred millionth, one after the other."""
    model = sources()["model.js"]
    for text in COEFFICIENTS:
        right = re.sub(r"\{(\d)\}", r"\1", text)
        assert model.count(right) == 1, right
        yield model.replace(right, re.sub(r"\{(\d)\}", r"\1.00000001", text))


@pytest.fixture(scope="module")
def seen(browse, tmp_path_factory):
    """All that is asked of the browser, in one run."""
    folder = tmp_path_factory.mktemp("explorer")
    data = typed(reference_orbits)(REFERENCES).assign_attrs(provenance_commit="c0ffee" * 6 + "c0ff")
    right = to_html(data)
    mutants = list(mutated())
    wrong = to_html(data, sources() | {"model.js": mutants[0]})
    (folder / "right.html").write_text(right, encoding="utf-8")
    (folder / "wrong.html").write_text(wrong, encoding="utf-8")
    # A script that was changed in the file, without its checksum.
    tampered = right.replace("const GRAVITY = 9.80665", "const GRAVITY = 9.81")
    (folder / "tampered.html").write_text(tampered, encoding="utf-8")
    observer = folder / "observer.html"
    script = OBSERVER.replace("STATES", json.dumps(list(states())))
    script = script.replace("MUTANTS", json.dumps([sources()["model.js"], *mutants]))
    observer.write_text(script, encoding="utf-8")
    text = browse(folder, observer, "--virtual-time-budget=30000", "--dump-dom")
    found = re.search(r'<pre id="seen">(.*)</pre>', text, re.DOTALL)
    assert found and found[1].startswith("{"), found and found[1]
    return json.loads(html.unescape(found[1])) | {"folder": folder}


def answered(capsys, command):
    """The command's own JSON, None where it says that there is no orbit."""
    try:
        main([*shlex.split(command)[1:], "--json"])
    except SystemExit as exit_:
        assert exit_.code == 1
        capsys.readouterr()
        return None
    return json.loads(capsys.readouterr().out)


def close(shown, expected):
    return abs(float(shown) - expected) <= BOUND * max(1.0, abs(expected))


def test_two_hundred_states_say_what_their_commands_print(seen, capsys):
    absent = 0
    for state in [seen["first"], *seen["states"]]:
        said, values = answered(capsys, state["command"]), state["values"]
        exists = values["spring-damper exists"]
        if said is None:
            absent += 1
            assert exists == "false", state["command"]
            continue
        assert exists == "true", state["command"]
        for name in ("phase", "contact_duration", "impact_velocity", "bounce_velocity",
                     "apparent_restitution", "max_height"):  # fmt: skip
            assert close(values[f"spring-damper {name}"], said[name]), (name, state["command"])
        found = np.array(values["spring-damper multipliers"].split(), dtype=float).reshape(2, 2)
        # The larger one may be steep in Λ next to the saddle-node: its size counts.
        size = max(1.0, np.abs(said["multipliers"]).max())
        assert np.abs(found - said["multipliers"]).max() < 1e-9 * size, state["command"]
        assert values["spring-damper is_stable"] == str(said["is_stable"]).lower()
    assert 0 < absent < STATES / 3


def test_errors_and_verdicts_are_those_of_the_calculator(seen, capsys):
    judged = set()
    for state in seen["states"][:12]:
        given = dict(zip(*[iter(shlex.split(state["command"])[2:])] * 2, strict=True))
        if given["--side"] == "unstable":
            continue
        r, n, ratio, lam = (
            given[f"--{x}"] for x in ("restitution", "n", "frequency-ratio", "amplitude")
        )
        call = (
            f"bouncing-ball design --mass 1 --gravity 1 --angular-frequency 1 --acceleration {lam} "
            f"--stiffness {float(ratio) ** 2!r} --restitution {r} --n {n} "
            f"--release {given['--release']}"
        )
        said = answered(capsys, call)
        if said is None:
            continue
        one = said["orbits"][0]
        for kind in ("errors", "corrected_errors"):
            for name, expected in one[kind].items():
                shown = float(state["values"][f"{kind} {name}"])
                # A difference of numbers of order 1 that agree to the bound.
                assert math.isfinite(shown) == (expected is not None)
                assert expected is None or abs(shown - expected) < 10 * BOUND
        if one["exists"] and one["is_admissible"]:
            judged.add(said["is_good_enough"])
            assert state["verdict"].startswith(said["verdict"])
    assert judged == {True, False}


def test_the_badge(seen):
    right, wrong, tampered = (seen["badges"][name] for name in ("right", "wrong", "tampered"))
    assert right["kind"] == "good" and float(right["worst"]) < BOUND / 20
    assert "500 orbits of the Python package, commit c0ffeec0ff" in right["text"]
    assert wrong["kind"] == "bad" and float(wrong["worst"]) > BOUND
    assert wrong["text"].startswith("WRONG") and wrong["colour"] == "rgb(176, 0, 32)"
    # The policy does not let a changed script run, and what was not checked says so.
    assert tampered["kind"] == "" and tampered["text"].startswith("Not checked")


def test_no_coefficient_may_be_wrong(seen):
    right, *wrong = seen["mutants"]
    assert right < BOUND / 20
    assert len(wrong) == len(COEFFICIENTS)
    assert {text: worst for text, worst in zip(COEFFICIENTS, wrong, strict=True)
            if not worst > BOUND} == {}  # fmt: skip


def test_no_request_leaves_the_page(seen):
    assert seen["requests"] == []
    assert {"connect-src", "img-src"} <= set(seen["blocked"])
    text = (seen["folder"] / "right.html").read_text(encoding="utf-8")
    assert "content=\"default-src 'none'; script-src 'sha256-" in text
    assert not re.search(r"https?://(?!www\.w3\.org/2000/svg)", text)


def test_address_slider_and_typed_values(seen):
    assert seen["refused"] == "Not a value here, and left out: nonsense = 1."
    assert "--restitution 0.65 --frequency-ratio 6 --amplitude 1 " in seen["first"]["command"]
    assert "--restitution 0.5 --frequency-ratio 20 --amplitude 1.2" in seen["byAddress"]["command"]
    assert "--release force" in seen["byAddress"]["command"]
    assert "w=31.62" in seen["bySlider"]["hash"] and seen["bySlider"]["typed"] == "31.62"
    # What is out of range is marked, and changes nothing.
    assert seen["invalid"] == {"marked": "true", "hash": seen["bySlider"]["hash"]}


def test_the_physical_tab_by_key(seen, capsys):
    tab = seen["tab"]
    assert tab["selected"] == ["false", "true"] and tab["focused"] == "tab-design"
    assert tab["shown"] and tab["hidden"] == 0 and "tab=design" in tab["hash"]
    said, rows = answered(capsys, tab["command"]), tab["rows"]
    for name, expected in {
        "frequency ratio ϖ": said["frequency_ratio"],
        "contact time, free": said["contact_time"],
        "damping c": said["damping"],
        "static deflection": said["static_deflection"],
        "greatest height": said["orbits"][0]["max_height"],
        "impact speed": said["orbits"][0]["impact_speed"],
        "corrected model: delay t_c": said["corrected"]["delay"],
        "corrected model: load σ": said["corrected"]["load"],
    }.items():
        assert float(rows[name]) == pytest.approx(expected, rel=BOUND), name
    # Sampled, at 2000 points of a contact.
    force = said["orbits"][0]["peak_force"]
    assert float(rows["peak force (sampled)"]) == pytest.approx(force, rel=1e-6)


def test_names_for_readers_of_the_screen(seen):
    assert seen["unlabelled"] == seen["duplicates"] == seen["pointing"] == []


def test_it_moves_when_asked(seen):
    before, after, pressed = seen["moved"]
    assert before != after and pressed == "true"


def test_it_fits_a_telephone(seen):
    assert seen["overflow"] == [0, 0]


def test_it_is_painted_dark_for_who_wants_it(seen, browse):
    light, dark = (seen["folder"] / f"{name}.png" for name in ("light", "dark"))
    page = seen["folder"] / "right.html"
    size = "--window-size=900,1000"
    browse(seen["folder"], page, f"--screenshot={light}", size)
    scheme = "--blink-settings=preferredColorScheme=0"
    browse(seen["folder"], page, f"--screenshot={dark}", size, scheme)
    means = []
    for path in (light, dark):
        with Image.open(path) as picture:
            grey = np.asarray(picture.convert("L"))
        means.append(grey.mean())
        # Contrast: paper and ink far apart, both there.
        assert np.percentile(grey, 99.5) - np.percentile(grey, 0.5) > 180
    assert means[0] > 200 and means[1] < 60


def test_it_prints_what_is_read_and_not_what_is_pressed(seen, browse):
    path = seen["folder"] / "print.pdf"
    page = seen["folder"] / "right.html"
    options = "--no-pdf-header-footer", "--virtual-time-budget=5000"
    browse(seen["folder"], page, f"--print-to-pdf={path}", *options)
    sheets = PdfReader(path).pages
    assert 1 <= len(sheets) <= 4
    text = " ".join(" ".join(sheet.extract_text() for sheet in sheets).split())
    for printed in ("Checked: ", "bouncing-ball orbit --restitution", "Relative errors"):
        assert printed in text
    assert "The restitution model is" in text
    for pressed in ("Play the motion", "what ends a contact", "Physical units"):
        assert pressed not in text
