"""The commands, fed with what users get wrong: exit 1, a message that names file, key or variable and the expectation, nothing left behind."""

import csv
import re
import zipfile

import fmpy
import motion
import numpy as np
import pytest
import scenes

FLUME = (scenes.SCENES / "flume.toml").read_text(encoding="utf-8")


def refused(done, *words):
    """A proper refusal: status 1, every word in a message for humans on stderr, none of Rust's own words."""
    assert done.returncode == 1, (done.returncode, done.stdout, done.stderr)
    assert all(line.startswith(("error: ", "  ")) for line in done.stderr.splitlines()), done.stderr
    for word in words:
        assert word in done.stderr, f"{word!r} is not in:\n{done.stderr}"
    no_rust(done.stderr)
    assert len(done.stderr) < 4000


def no_rust(text):
    assert not re.search(r"panicked|backtrace|thread '|\.rs:\d|unwrap|Some\(|Err\(|Os \{", text), text


def changed(old, new):
    assert FLUME.count(old) >= 1, f"the flume scene has no {old!r}"
    return FLUME.replace(old, new, 1)


def line_of(text, below=0):
    """`line N` of the scene's first line that is this, or of one so many below."""
    return f"line {FLUME.splitlines().index(text) + 1 + below}"


def number(key, text):
    """The flume scene with another value for a key that is written once."""
    found = re.findall(rf"(?m)^{key} = \S+", FLUME)
    assert len(found) >= 1, key
    return FLUME.replace(found[0], f"{key} = {text}", 1)


BAD_SCENES = {
    "unknown key": (changed("diameter = ", "diametre = "), ["cable.diametre", "unknown key", "did you mean cable.diameter?"]),
    "unknown table": (FLUME + "\n[winsh]\nradius = 1.0\n", ["winsh", "did you mean winch?"]),
    "unknown key at the top": (changed("gravity = ", "gravitation = "), ["gravitation", "did you mean gravity?"]),
    "text for a number": (number("mass_per_length", '"0.2 g"'), ["cable.mass_per_length", '"0.2 g"', "expected a number", "kg/m"]),
    "number for text": (number("strain", "1"), ["cable.strain", "expected", "engineering", "green"]),
    "a choice misspelt": (number("strain", '"engeneering"'), ["cable.strain", "engeneering", 'did you mean "engineering"?']),
    "two components": (changed("position = [0.0, 0.0, -0.01735]", "position = [0.0, 0.0]"), ["winch.position", "expected", "[x, y, z]"]),
    "a number as a table": (changed("gravity = ", "outputs = 25\ngravity = ").replace("[outputs]\npoints = 25", ""), ["outputs", "[outputs]"]),
    "half an element": (re.sub(r"(?s)regions = \[.*?\n\]", "elements = 2.5", FLUME), ["mesh.elements", "2.5", "whole number"]),
    "missing table": (re.sub(r"(?ms)^\[mesh\].*?(?=^\[)", "", FLUME), ["mesh", "missing", "[mesh]"]),
    "missing key": (changed("diameter = 0.45e-3\n", ""), ["cable.diameter", "missing", "expected a number > 0 in m"]),
    "no first end": (re.sub(r"(?ms)^\[winch\].*?(?=^\[)", "", FLUME), ["winch", "missing", "[anchor]"]),
    "two first ends": (FLUME + "\n[anchor]\nposition = [0.0, 0.0, 0.0]\n", ["anchor", "exactly one"]),
    "negative stiffness": (number("EA", "-222.0"), ["cable.EA", "-222", "expected a number > 0 in N"]),
    "zero radius": (number("radius", "0.0"), ["winch.radius", "0.0", "expected a number > 0 in m"]),
    "NaN": (number("EI", "nan"), ["cable.EI", "nan", "expected a number"]),
    "infinity": (number("density", "inf"), ["fluid.density", "inf", "expected a number"]),
    "lengths that do not sum up": (changed("length = 0.0818", "length = 0.5"), ["mesh.regions", "sum", "cable.length"]),
    "a name that C refuses": (changed('name = "flume"', 'name = "my flume"'), ["name", "my flume", "identifier"]),
    "no TOML": ("this is not\na scene", ["line 1", "TOML"]),
    "a TOML that breaks off": (FLUME + "\n[solver\n", ["line", "TOML"]),
    "a key twice": (changed("gravity = 9.81", "gravity = 9.81\ngravity = 9.82"), [line_of("gravity = 9.81", 1), "duplicate key"]),
    "empty": ("", ["name", "cable", "mesh", "missing"]),
    "no text": (b"\x80\x81\x00\xff", ["UTF-8"]),
    "several faults at once": (number("EA", "-1.0").replace("density", "densite"), ["cable.EA", "fluid.densite", "fluid.density"]),
}


@pytest.mark.parametrize("case", BAD_SCENES)
def test_exact_a_bad_scene_is_refused(xtask, tmp_path, case):
    text, words = BAD_SCENES[case]
    scene = tmp_path / "bad scene.toml"
    scene.write_bytes(text if isinstance(text, bytes) else text.encode())
    out = tmp_path / "out" / "bad.fmu"
    done = xtask("package", scene, "--out", out)
    refused(done, "bad scene.toml", *words)
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["bad scene.toml"]
    assert done.stdout == ""


def test_exact_a_scene_that_is_not_there(xtask, tmp_path):
    out = tmp_path / "x.fmu"
    refused(xtask("package", "flumme", "--out", out), "flumme", "did you mean flume?")
    refused(xtask("package", tmp_path / "none.toml", "--out", out), "none.toml")
    refused(xtask("package", tmp_path, "--out", out), tmp_path.name)
    assert list(tmp_path.iterdir()) == []
    refused(xtask("package", "flume", "--out", tmp_path), tmp_path.name, "folder")


def test_exact_a_bad_scene_leaves_the_old_fmu_alone(xtask, tmp_path):
    scene, out = tmp_path / "s.toml", tmp_path / "s.fmu"
    scene.write_text("nonsense")
    out.write_bytes(b"precious")
    refused(xtask("package", scene, "--out", out), "s.toml")
    assert out.read_bytes() == b"precious"


def test_exact_folders_are_made_and_names_may_be_awkward(xtask, awkward):
    scene = awkward / "eine Szene ß.toml"
    scene.write_text(FLUME, encoding="utf-8")
    out = awkward / "ein neuer Ordner" / "ü.fmu"
    done = xtask("package", scene, "--out", out)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-1] == str(out)
    result = awkward / "Läufe" / "erster Lauf.csv"
    done = xtask("run", out, "--stop", "0.05", "--output", result)
    assert done.returncode == 0, done.stderr
    assert result.is_file()


def test_exact_relative_paths_are_relative_to_where_the_user_is(xtask, tmp_path):
    (tmp_path / "mine.toml").write_text(FLUME, encoding="utf-8")
    done = xtask("package", "mine.toml", "--out", "mine.fmu", cwd=tmp_path)
    if "could not find `Cargo.toml`" in done.stderr or "no such command" in done.stderr:
        pytest.skip("cargo finds its alias only inside the repository")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "mine.fmu").is_file()


# FMUs that are none


def rezipped(source, target, changes):
    """A copy of an archive with entries replaced, or left out for None."""
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as new:
        for entry in old.infolist():
            data = changes.get(entry.filename, old.read(entry.filename))
            if data is not None:
                new.writestr(entry.filename, data)
    return target


def description(fmu):
    with zipfile.ZipFile(fmu.path) as archive:
        return archive.read("modelDescription.xml").decode()


def bad_fmus(flume):
    xml = description(flume)
    guid = flume.guid
    return {
        "no zip": (b"this is no zip archive", ["zip"]),
        "half a zip": (flume.path.read_bytes()[:5000], ["zip"]),
        "empty": (b"", ["zip"]),
        "no description": ({"modelDescription.xml": None}, ["modelDescription.xml"]),
        "XML that breaks off": ({"modelDescription.xml": xml[: len(xml) // 2]}, ["modelDescription.xml"]),
        "no XML": ({"modelDescription.xml": "text"}, ["modelDescription.xml"]),
        "no UTF-8": ({"modelDescription.xml": b"\xff\xfe\x00"}, ["modelDescription.xml"]),
        "another version": ({"modelDescription.xml": xml.replace('fmiVersion="2.0"', 'fmiVersion="3.0"')}, ["fmiVersion", "3.0", "2.0"]),
        "no reference": (
            {"modelDescription.xml": re.sub(r'valueReference="\d+"', 'valueReference="x"', xml, count=1)}, ["valueReference", "x"]),
        "no library": ({"binaries/linux64/flume.so": None}, ["binaries/linux64/flume.so"]),
        "another GUID": ({"modelDescription.xml": xml.replace(guid, "{1-2-3}")}, ["GUID", "{1-2-3}"]),
        "a scene that was changed": ({"resources/scene.toml": FLUME.replace("gravity = 9.81", "gravity = 1.62")}, ["GUID"]),
        "no scene": ({"resources/scene.toml": None}, ["scene.toml"]),
        "a broken scene": ({"resources/scene.toml": "gravity = "}, ["scene.toml"]),
    }


BAD_FMUS = [
    "no zip", "half a zip", "empty", "no description", "XML that breaks off", "no XML", "no UTF-8", "another version", "no reference",
    "no library", "another GUID", "a scene that was changed", "no scene", "a broken scene",
]
WELL_FORMED = ["another GUID", "a scene that was changed", "no scene", "a broken scene"]


@pytest.mark.parametrize("case", BAD_FMUS)
def test_exact_a_bad_fmu_is_refused(flume, xtask, tmp_path, case):
    content, words = bad_fmus(flume)[case]
    path = tmp_path / "bad one.fmu"
    if isinstance(content, bytes):
        path.write_bytes(content)
    else:
        rezipped(flume.path, path, content)
    out = tmp_path / "result.csv"
    refused(xtask("run", path, "--stop", "0.1", "--output", out), *words)
    assert [p.name for p in tmp_path.iterdir()] == ["bad one.fmu"]
    done = xtask("validate", path)
    # The validator looks at form and runs no code, so it cannot know what only the FMU itself would refuse.
    assert done.returncode == (0 if case in WELL_FORMED else 1), done.stdout
    no_rust(done.stdout + done.stderr)
    assert "bad one.fmu" in done.stdout + done.stderr


def test_exact_an_fmu_that_is_not_there(xtask, tmp_path):
    refused(xtask("run", tmp_path / "none.fmu"), "none.fmu")
    refused(xtask("validate", tmp_path / "none.fmu"), "none.fmu")
    refused(xtask("run", tmp_path), tmp_path.name)


def test_exact_the_validator_finds_planted_faults(flume, xtask, tmp_path):
    xml = description(flume)
    for old, new in [
        ('variableNamingConvention="structured"', 'variableNamingConvention="odd"'),
        ('name="ship.y"', 'name="ship.x"'),
        (' causality="input"', ' causality="inputs"'),
        ('declaredType="Position"', 'declaredType="Nothing"'),
    ]:
        assert old in xml, old
        path = rezipped(flume.path, tmp_path / "x.fmu", {"modelDescription.xml": xml.replace(old, new, 1)})
        done = xtask("validate", path)
        assert done.returncode == 1, f"{new} passes"
        no_rust(done.stdout + done.stderr)


# Inputs


def write_csv(path, names, rows):
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(names)
        writer.writerows(rows)
    return path


def swell(fmu, path, h=0.01, stop=1.0, leave_out=()):
    """A file of ship motion."""
    at = motion.inputs(motion.wave, fmu)
    names = [n for n in at(0.0) if n not in leave_out]
    rows = [[t] + [at(t)[n] for n in names] for t in (round(k * h, 9) for k in range(round(stop / h) + 1))]
    return write_csv(path, ["time"] + names, rows)


BAD_CSV = {
    "no time": ("t,ship.x\n0,1\n", [":1", "'t'", "'time'"]),
    "an unknown variable": ("time,winch.setpont\n0,1\n1,1\n", ["winch.setpont", "did you mean 'winch.setpoint'?"]),
    "an output": ("time,winch.tension\n0,1\n1,1\n", ["winch.tension", "input"]),
    "a parameter": ("time,cable.EA\n0,1\n1,1\n", ["cable.EA", "input"]),
    "a missing column": ("time,ship.x,ship.y\n0,0,0\n1,0,0\n", ["ship.z", "missing"]),
    "a ragged row": ("time,current.x,current.y\n0,0,0\n0.5,0\n1,0,0\n", [":3", "2 fields", "expected 3"]),
    "a long row": ("time,current.x\n0,0\n1,0,0\n", [":3", "3 fields", "expected 2"]),
    "a word": ("time,current.x\n0,0\n1,fast\n", [":3", "current.x", "fast", "number"]),
    "nothing": ("time,current.x\n0,0\n1,\n", [":3", "current.x", "number"]),
    "NaN": ("time,current.x\n0,0\n1,nan\n", [":3", "current.x", "nan", "finite"]),
    "infinity": ("time,current.x\n0,0\n1,inf\n", [":3", "current.x", "inf", "finite"]),
    "time that stands": ("time,current.x\n0,0\n0,0\n1,0\n", [":3", "time", "ascend"]),
    "a column twice": ("time,current.x,current.x\n0,0,0\n1,0,0\n", [":1", "current.x", "twice"]),
    "a header only": ("time,current.x\n", ["no rows"]),
    "empty": ("", ["empty", "time"]),
    "no text": (b"\xff\xfe\x00\x01", ["CSV"]),
    "too short": ("time,current.x\n0,0\n0.1,0\n", ["--stop", "0.1"]),
}


@pytest.mark.parametrize("case", BAD_CSV)
def test_exact_a_bad_input_file_is_refused(flume, xtask, tmp_path, case):
    text, words = BAD_CSV[case]
    path = tmp_path / "bad input.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    done = xtask("run", flume.path, "--input", path, "--stop", "0.5", "--output", tmp_path / "result.csv")
    refused(done, "bad input.csv", *words)
    assert [p.name for p in tmp_path.iterdir()] == ["bad input.csv"]


BAD_OPTIONS = {
    "an unknown name": (["--set", "cable.AE=1"], ["cable.AE", "did you mean 'cable.EA'?"]),
    "a word": (["--set", "cable.EA=stiff"], ["cable.EA", "stiff", "number"]),
    "no value": (["--set", "cable.EA"], ["cable.EA", "NAME=VALUE"]),
    "an empty value": (["--set", "cable.EA="], ["cable.EA", "number"]),
    "NaN": (["--set", "cable.EA=nan"], ["cable.EA", "finite"]),
    "out of range": (["--set", "cable.EA=-1"], ["cable.EA", "> 0"]),
    "half a count": (["--set", "solver.steps_max=1.5"], ["solver.steps_max", "1.5", "whole number"]),
    "an output": (["--set", "winch.tension=1"], ["winch.tension", "output"]),
    "no time": (["--stop", "0"], ["--stop"]),
    "time backwards": (["--stop", "-1"], ["stop"]),
    "no step": (["--step", "0"], ["--step"]),
    "a step that is none": (["--step", "nan"], ["--step"]),
    "a step in words": (["--step", "small"], ["--step", "small"]),
    "an unknown option": (["--speed", "1"], ["--speed"]),
    "no input file": (["--input", "none.csv"], ["none.csv"]),
}


@pytest.mark.parametrize("case", BAD_OPTIONS)
def test_exact_bad_options_are_refused(flume, xtask, tmp_path, case):
    options, words = BAD_OPTIONS[case]
    stop = [] if "--stop" in options else ["--stop", "0.1"]
    done = xtask("run", flume.path, "--output", tmp_path / "result.csv", *stop, *options)
    assert done.returncode == 1
    for word in words:
        assert word in done.stderr, done.stderr
    no_rust(done.stderr)
    assert list(tmp_path.iterdir()) == []


def test_exact_a_run_that_fails_keeps_the_old_results_and_says_where_the_new_ones_are(flume, xtask, tmp_path):
    """One sub-step a second is never enough once the current sets in."""
    out = tmp_path / "result.csv"
    out.write_text("precious")
    inputs = tmp_path / "in.csv"
    inputs.write_text("time,current.x\n0,0\n1,0\n2,1\n6,1\n")
    done = xtask("run", flume.path, "--input", inputs, "--step", "1", "--set", "solver.steps_max=1", "--output", out)
    refused(done, "t = ", "partial")
    assert out.read_text() == "precious"
    partial = tmp_path / "result.partial.csv"
    rows = list(csv.reader(partial.open()))
    assert rows[0][0] == "time" and len(rows) >= 2
    assert sorted(p.name for p in tmp_path.iterdir()) == ["in.csv", "result.csv", "result.partial.csv"]


@pytest.mark.parametrize("arguments", [[], ["dance"], ["package"], ["run"], ["package", "flume", "--fast"]])
def test_exact_wrong_command_lines_get_help_not_success(xtask, arguments):
    done = xtask(*arguments)
    assert done.returncode == 1
    assert "Usage" in done.stderr
    no_rust(done.stderr)


# What works


def test_exact_a_run_with_ship_motion(flume, xtask, tmp_path):
    inputs = swell(flume, tmp_path / "swell.csv")
    out = tmp_path / "out.csv"
    done = xtask("run", flume.path, "--input", inputs, "--output", out, "--set", "body.mass=0.0015")
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-1] == str(out)
    rows = np.genfromtxt(out, delimiter=",", names=True, deletechars="")
    names = out.read_text().splitlines()[0].split(",")
    assert names[0] == "time" and set(names[1:]) == {n for n in flume.names("output") if flume.variables[n].type != "String"}
    assert rows["time"][0] == 0.0 and rows["time"][-1] == 1.0 and (np.diff(rows["time"]) > 0).all()


def test_cross_our_own_importer_agrees_with_fmpy(flume, xtask, tmp_path):
    """FMPy 0.3.32 and `cargo xtask run` on the same file of inputs: both interpolate linearly at the begin of each step."""
    inputs, out = swell(flume, tmp_path / "swell.csv"), tmp_path / "out.csv"
    assert xtask("run", flume.path, "--input", inputs, "--output", out, "--step", "0.01").returncode == 0
    names = inputs.read_text().splitlines()[0].split(",")
    rows = np.loadtxt(inputs, delimiter=",", skiprows=1)
    signals = np.array([tuple(row) for row in rows], dtype=[(n, float) for n in names])
    record = ["winch.tension", "body.x", "body.z"]
    theirs = fmpy.simulate_fmu(str(flume.path), input=signals, stop_time=1.0, output_interval=0.01, output=record)
    lines = list(csv.reader(out.open()))
    for name in record:
        ours = np.array([float(row[lines[0].index(name)]) for row in lines[1:]])
        assert len(ours) == len(theirs)
        # Communication points that differ in the last bits differ in their sub-steps; solver.tolerance is 1e-3, the rest is rounding.
        scale = np.abs(theirs[name]).max()
        assert np.abs(ours - theirs[name]).max() <= 1e-3 * scale, name


def test_exact_more_columns_of_ship_motion_than_the_fmu_asks_for(fmus, flume, xtask, tmp_path):
    """One file of ship motion serves scenes with fewer derivatives."""
    inputs = swell(flume, tmp_path / "swell.csv", stop=0.1)
    assert xtask("run", fmus["pose"].path, "--input", inputs, "--output", tmp_path / "out.csv").returncode == 0
    refused(
        xtask("run", flume.path, "--input", swell(flume, tmp_path / "less.csv", leave_out=["ship.az"]), "--output", tmp_path / "no.csv"),
        "less.csv", "ship.az", "missing",
    )


def test_exact_our_own_ship_motion_drives_the_flume(flume, xtask, tmp_path):
    sea, out = tmp_path / "sea.csv", tmp_path / "out.csv"
    done = xtask("ship-motion", "--help")
    assert done.returncode == 0 and "--seed" in done.stdout
    option = "--output" if "--output" in done.stdout else "--out"
    done = xtask("ship-motion", "--duration", "2", option, sea)
    assert done.returncode == 0, done.stderr
    done = xtask("run", flume.path, "--input", sea, "--output", out)
    assert done.returncode == 0, done.stderr
    assert len(out.read_text().splitlines()) > 100


def test_exact_packing_prints_its_default_place(xtask):
    done = xtask("package", "flume")
    assert done.returncode == 0, done.stderr
    path = done.stdout.splitlines()[-1]
    assert path.endswith("flume.fmu") and zipfile.is_zipfile(path)
