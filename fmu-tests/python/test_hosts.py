"""Packed FMUs in the hosts of their users: fmpy, libcosim and Ecos give what our own driver gives; the FMU toolbox has no complaint.

libcosim and Ecos run in processes of their own: what they print can be looked at, and a crash is a failed test.
"""

import csv
import json
import math
import subprocess
import sys
import zipfile
from pathlib import Path

import motion
import pytest
import scenes

HOSTS = Path(__file__).parent / "hosts"
# Exact as a binary number and in nanoseconds, so that all hosts come to the same communication points to the last bit.
STEP, STEPS = 1 / 64, 16
EXTERNAL = ["cosim", "ecos"]


def inputs(fmu):
    """A series for every input: away from its start value, smoothly, from rest; rates fit to what they are rates of."""
    ship = motion.inputs(motion.rising, fmu)
    frequency, amplitude = 2.0, 0.05
    rates = {"winch.setpoint_rate"}

    def at(t):
        values = {}
        for name in fmu.names("input"):
            angle = frequency * t
            rise = amplitude * frequency * math.sin(angle) if name in rates else amplitude * (1 - math.cos(angle))
            values[name] = float(fmu.variables[name].start) + rise
        return {**values, **ship(t)}

    rows = [at(k * STEP) for k in range(STEPS + 1)]
    return {name: [row[name] for row in rows] for name in fmu.names("input")}


def recorded(fmu):
    """Numeric outputs and their types; libcosim and Ecos have strings too, but nothing to compare them with."""
    return {name: fmu.variables[name].type for name in fmu.names("output") if fmu.variables[name].type != "String"}


def instances(fmu):
    """Two that differ: the second is on a lighter planet with a heavier cable, and is not driven."""
    series = inputs(fmu)
    rest = {name: [float(fmu.variables[name].start)] * (STEPS + 1) for name in series}
    changed = {"gravity": 9.5, "cable.mass_per_length": 1.1 * float(fmu.variables["cable.mass_per_length"].start)}
    return {"driven": ({}, series), "changed": (changed, rest)}


def run(host, tmp_path, kind, path, step, steps, instances, record, parameters=None):
    """A job in an external host. `instances`: {name: (start values, {input: [value at each communication point]})}."""
    job = {
        "kind": kind, "path": str(path), "step": step, "steps": steps, "record": record, "parameters": parameters,
        "instances": {
            name: {"start": {**start, **{n: s[0] for n, s in series.items()}} if kind == "fmu" else {}, "inputs": series}
            for name, (start, series) in instances.items()
        },
    }
    (tmp_path / "job.json").write_text(json.dumps(job), encoding="utf-8")
    command = [sys.executable, HOSTS / f"{host}.py", tmp_path / "job.json", tmp_path / "results.json"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if done.returncode == 77:
        pytest.skip(done.stderr.strip())
    assert done.returncode == 0, done.stdout + done.stderr
    # Neither the host nor the FMU has anything to complain about.
    assert done.stdout + done.stderr == ""
    return json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))


def driven(fmu, xtask, tmp_path):
    """What `cargo xtask run` makes of the same two instances."""
    results = {}
    for name, (start, series) in instances(fmu).items():
        command = ["run", fmu.path, "--output", tmp_path / f"{name}.csv", "--step", STEP, "--stop", STEP * STEPS]
        if series:
            table = tmp_path / f"{name}-inputs.csv"
            with table.open("w", newline="") as file:
                writer = csv.writer(file)
                writer.writerow(["time", *series])
                writer.writerows([k * STEP, *(s[k] for s in series.values())] for k in range(STEPS + 1))
            command += ["--input", table]
        for key, value in start.items():
            command += ["--set", f"{key}={value!r}"]
        done = xtask(*command)
        assert done.returncode == 0, done.stderr
        with (tmp_path / f"{name}.csv").open() as file:
            rows = list(csv.DictReader(file))[1:]
        read = {"Real": float, "Integer": int, "Boolean": lambda text: bool(int(text))}
        results[name] = {v: [read[kind](row[v]) for row in rows] for v, kind in recorded(fmu).items()}
    return results


@pytest.fixture(scope="module")
def references(fmus, xtask, tmp_path_factory):
    """Our own driver's results by scene."""
    known = {}

    def of(name):
        if name not in known:
            known[name] = driven(fmus[name], xtask, tmp_path_factory.mktemp(name))
        return known[name]

    return of


def same(found, expected):
    """To the last bit: the same library on the same machine, given the same numbers at the same times."""
    for instance, variables in expected.items():
        for variable, values in variables.items():
            assert found[instance][variable] == values, (instance, variable)


def test_exact_the_two_instances_do_differ(flume, references):
    """Else the comparisons below would say nothing about overridden inputs and parameters."""
    reference = references("flume")
    for variable in ("winch.angle", "winch.tension", "body.z"):
        assert reference["driven"][variable][-1] != reference["changed"][variable][-1]
        assert len(set(reference["driven"][variable])) > STEPS / 2
    assert len(reference["driven"]["body.z"]) == STEPS


@pytest.mark.parametrize("name", scenes.BUILT_IN)
def test_cross_fmpy_gives_what_our_driver_gives(fmus, references, name):
    fmu = fmus[name]
    record, jobs = recorded(fmu), instances(fmu)
    started = {}
    for key, (start, series) in jobs.items():
        started[key] = fmu.started(parameters=start, inputs={n: s[0] for n, s in series.items()})
    found = {key: {variable: [] for variable in record} for key in jobs}
    for k in range(STEPS):
        for key, (_, series) in jobs.items():
            started[key].set({n: s[k] for n, s in series.items()})
            started[key].step(k * STEP, STEP)
            for variable, value in started[key].get(list(record)).items():
                found[key][variable].append(value)
    for instance in started.values():
        instance.free()
    same(found, references(name))


@pytest.mark.parametrize("host", EXTERNAL)
@pytest.mark.parametrize("name", scenes.BUILT_IN)
def test_cross_other_hosts_give_what_our_driver_gives(fmus, references, tmp_path, name, host):
    """libcosim of libcosimpy 0.0.6, Ecos of ecospy 0.7.2."""
    fmu = fmus[name]
    same(run(host, tmp_path, "fmu", fmu.path, STEP, STEPS, instances(fmu), recorded(fmu)), references(name))


def fmutool(path):
    """All that `fmutool -check` says."""
    command = [Path(sys.executable).with_name("fmutool"), "-input", path, "-check"]
    done = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    return done.stdout + done.stderr


@pytest.mark.parametrize("name", scenes.BUILT_IN)
def test_cross_the_fmu_toolbox_finds_no_problem(fmus, name):
    """fmu-manipulation-toolbox 2.0: FMI's schema, and the rules that a schema cannot say."""
    said = fmutool(fmus[name].path)
    assert "This FMU seems to be compliant with FMI-2.0." in said and "No semantic error against the FMI-2 standard." in said, said
    assert not any(word in said for word in ("ERROR", "WARNING", "CRITICAL", "Traceback")), said


def test_exact_the_fmu_toolbox_does_look(flume, tmp_path):
    """A tool that finds nothing in a broken FMU would prove nothing in the others."""
    broken = tmp_path / "broken.fmu"
    with zipfile.ZipFile(flume.path) as source, zipfile.ZipFile(broken, "w") as target:
        for name in source.namelist():
            text = source.read(name)
            if name == "modelDescription.xml":
                text = text.replace(b'initial="exact"', b'initial="calculated"', 1)
            target.writestr(name, text)
    assert "ERROR" in fmutool(broken)


# The example systems that `cargo xtask package --osp --ssp` writes beside an FMU.

# A winch takes its set-point as an angle with its rate, or in metres of cable.
ANGLE = {"winch.angle": "winch.setpoint", "winch.rate": "winch.setpoint_rate"}
PAYOUT = {"winch.payout": "winch.setpoint"}


def followed(fmu):
    """fmpy as the master of the example system: two cables, the second's winch following the first's where there is one."""
    wires = {}
    if "winch.setpoint" in fmu.variables:
        wires = ANGLE if fmu.variables["winch.setpoint"].unit == "rad" else PAYOUT
    series, record = inputs(fmu), recorded(fmu)
    found = {key: {variable: [] for variable in record} for key in ("leader", "follower")}
    with fmu.started() as leader, fmu.started() as follower:
        for k in range(STEPS):
            leader.set({n: s[k] for n, s in series.items()})
            follower.set({input: leader[output] for output, input in wires.items()})
            leader.step(k * STEP, STEP), follower.step(k * STEP, STEP)
            for key, instance in (("leader", leader), ("follower", follower)):
                for variable, value in instance.get(list(record)).items():
                    found[key][variable].append(value)
    return found


@pytest.mark.parametrize("host, kind", [("cosim", "osp"), ("cosim", "ssp"), ("ecos", "ssp")])
@pytest.mark.parametrize("name", scenes.BUILT_IN)
def test_cross_the_example_systems_run(fmus, beside, tmp_path, name, host, kind):
    fmu, folder = fmus[name], beside(name)
    path = folder / f"{name}.ssp"
    if kind == "osp":
        # The file says its own step size, and a hundredth of a second is no binary number.
        path = folder / f"{name}_Test_OspSystemStructure.xml"
        text = (folder / f"{name}_OspSystemStructure.xml").read_text(encoding="utf-8")
        assert "0.01" in text
        path.write_text(text.replace("0.01", str(STEP)), encoding="utf-8")
    jobs = {"leader": ({}, inputs(fmu)), "follower": ({}, {})}
    found = run(host, tmp_path, kind, path, STEP, STEPS, jobs, recorded(fmu), "initialValues")
    same(found, followed(fmu))


def test_cross_libcosim_connects_whole_groups(flume, beside, tmp_path):
    """It reads the groups from flume_OspModelDescription.xml."""
    folder = beside("flume")
    text = (folder / "flume_OspSystemStructure.xml").read_text(encoding="utf-8").replace("0.01", str(STEP))
    path = folder / "flume_Groups_OspSystemStructure.xml"
    path.write_text(text.replace("VariableConnection", "VariableGroupConnection").replace("<Variable ", "<VariableGroup "), encoding="utf-8")
    jobs = {"leader": ({}, inputs(flume)), "follower": ({}, {})}
    same(run("cosim", tmp_path, "osp", path, STEP, STEPS, jobs, recorded(flume)), followed(flume))


@pytest.mark.parametrize("host", EXTERNAL)
def test_cross_a_parameter_set_is_applied(flume, beside, tmp_path, host):
    """libcosim and Ecos take a changed number from the .ssv; each cable of the system is bound to it."""
    folder = beside("flume")
    changed = tmp_path / "changed.ssp"
    with zipfile.ZipFile(folder / "flume.ssp") as source, zipfile.ZipFile(changed, "w") as target:
        for name in source.namelist():
            text = source.read(name)
            if name.endswith(".ssv"):
                assert text.count(b'value="9.81"') == 1
                text = text.replace(b'value="9.81"', b'value="9.5"')
            target.writestr(name, text)
    record = {"winch.tension": "Real"}
    with flume.started(parameters={"gravity": 9.5}) as light:
        expected = [row["winch.tension"] for row in light.run(STEPS, STEP, record=record)]
    found = run(host, tmp_path, "ssp", changed, STEP, STEPS, {"leader": ({}, {})}, record, "initialValues")
    assert found["leader"]["winch.tension"] == expected
