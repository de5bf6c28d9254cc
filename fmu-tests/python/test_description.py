"""What is in the archive and in modelDescription.xml."""

import ctypes
import math
import re
import shutil
import subprocess
import zipfile

import fmpy
import pytest
import scenes
from fmpy.validation import validate_fmu

ALL = scenes.BUILT_IN + [change.__name__ for change in scenes.VARIANTS]

FUNCTIONS = """
    GetTypesPlatform GetVersion SetDebugLogging Instantiate FreeInstance SetupExperiment EnterInitializationMode ExitInitializationMode
    Terminate Reset GetReal GetInteger GetBoolean GetString SetReal SetInteger SetBoolean SetString GetFMUstate SetFMUstate FreeFMUstate
    SerializedFMUstateSize SerializeFMUstate DeSerializeFMUstate GetDirectionalDerivative SetRealInputDerivatives
    GetRealOutputDerivatives DoStep CancelStep GetStatus GetRealStatus GetIntegerStatus GetBooleanStatus GetStringStatus
""".split()


@pytest.mark.parametrize("name", ALL)
def test_exact_fmpy_finds_no_problem(fmus, name):
    path = str(fmus[name].path)
    assert validate_fmu(path) == []
    description = fmpy.read_model_description(path, validate=True, validate_variable_names=True, validate_model_structure=True)
    assert description.coSimulation.modelIdentifier == name
    assert description.fmiVersion == "2.0"


@pytest.mark.parametrize("name", ALL)
def test_exact_our_own_validator_agrees(fmus, xtask, name):
    done = xtask("validate", fmus[name].path)
    assert (done.returncode, done.stderr) == (0, "")


def test_exact_every_built_in_scene_is_listed(xtask):
    done = xtask("scenes")
    assert done.returncode == 0
    lines = done.stdout.splitlines()
    assert sorted(line.split()[0] for line in lines) == scenes.BUILT_IN
    assert all(len(line.split()) > 3 for line in lines), "a scene has no description"


def test_exact_the_archive_is_one_that_every_importer_reads(flume):
    with zipfile.ZipFile(flume.path) as archive:
        entries = archive.infolist()
        assert archive.testzip() is None
    names = [entry.filename for entry in entries]
    assert {"modelDescription.xml", "binaries/linux64/flume.so", "resources/scene.toml", "documentation/index.html"} <= set(names)
    assert len(names) == len(set(names))
    for entry in entries:
        assert entry.compress_type in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
        assert entry.extract_version <= 20, "needs more than zip 2.0"
        assert entry.flag_bits & ~0x800 == 0, "only the flag for UTF-8 names may be there"
        assert "\\" not in entry.orig_filename and not entry.filename.startswith("/")


def test_exact_packing_twice_gives_the_same_bytes(flume, xtask, tmp_path):
    again = tmp_path / "again.fmu"
    assert xtask("package", "flume", "--out", again).returncode == 0
    assert again.read_bytes() == flume.path.read_bytes()


def test_exact_every_scene_has_its_own_guid(fmus):
    assert len({fmus[name].guid for name in ALL}) == len(ALL)


def test_exact_all_34_functions_and_nothing_else_are_exported(flume):
    path = flume.folder / "binaries" / "linux64" / "flume.so"
    library = ctypes.CDLL(str(path))
    assert len(FUNCTIONS) == 34
    assert all(getattr(library, f"fmi2{name}") for name in FUNCTIONS)
    if shutil.which("nm"):  # binutils come with every C linker
        listed = subprocess.run(["nm", "-D", "--defined-only", str(path)], capture_output=True, text=True, check=True).stdout
        assert sorted(line.split()[-1] for line in listed.splitlines()) == sorted(f"fmi2{name}" for name in FUNCTIONS)


def xyz(stem):
    return [f"{stem}.{axis}" for axis in "xyz"]


SHIP = [f"ship.{c}" for c in "x y z roll pitch yaw".split()]
SHIP_RATE = [f"ship.{c}" for c in "vx vy vz roll_rate pitch_rate yaw_rate".split()]
SHIP_ACCELERATION = [f"ship.{c}" for c in "ax ay az roll_acceleration pitch_acceleration yaw_acceleration".split()]
SHIP_OUT = xyz("ship.force") + xyz("ship.moment") + xyz("ship.force_world")
WINCH_IN = ["winch.setpoint", "winch.setpoint_rate"]
WINCH_OUT = [f"winch.{c}" for c in "tension angle rate torque payout".split()] + xyz("winch.force")
CABLE = ["cable.tension_max", "cable.tension_min", "cable.slack"]
BODY = xyz("body") + ["body.vx", "body.vy", "body.vz", "body.tension"]
POINTS = [name for k in range(1, 26) for name in xyz(f"cable.point[{k}]")]
STATUS = ["status.code", "status.message", "solver.steps", "solver.rejected", "solver.iterations", "solver.energy_error"]
FLUID = ["current.x", "current.y"]

SIGNALS = {
    "flume": (SHIP + SHIP_RATE + SHIP_ACCELERATION + WINCH_IN + FLUID, SHIP_OUT + WINCH_OUT + CABLE + POINTS + BODY + STATUS),
    "no_ship": (WINCH_IN + FLUID, WINCH_OUT + CABLE + POINTS + BODY + STATUS),
    "pose": (SHIP + WINCH_IN + FLUID, SHIP_OUT + WINCH_OUT + CABLE + POINTS + BODY + STATUS),
    "pose_velocity": (SHIP + SHIP_RATE + WINCH_IN + FLUID, SHIP_OUT + WINCH_OUT + CABLE + POINTS + BODY + STATUS),
    "vacuum": (SHIP + SHIP_RATE + SHIP_ACCELERATION + WINCH_IN, SHIP_OUT + WINCH_OUT + CABLE + POINTS + BODY + STATUS),
    "anchor": (
        SHIP + SHIP_RATE + SHIP_ACCELERATION + FLUID,
        SHIP_OUT + ["anchor.tension"] + xyz("anchor.force") + CABLE + POINTS + BODY + STATUS,
    ),
    "no_body": (SHIP + SHIP_RATE + SHIP_ACCELERATION + WINCH_IN + FLUID, SHIP_OUT + WINCH_OUT + CABLE + POINTS + STATUS),
    "body_force": (
        SHIP + SHIP_RATE + SHIP_ACCELERATION + WINCH_IN + FLUID + xyz("body.force"),
        SHIP_OUT + WINCH_OUT + CABLE + POINTS + BODY + STATUS,
    ),
    "no_points": (SHIP + SHIP_RATE + SHIP_ACCELERATION + WINCH_IN + FLUID, SHIP_OUT + WINCH_OUT + CABLE + BODY + STATUS),
    "bare": ([], ["anchor.tension"] + xyz("anchor.force") + CABLE + BODY + STATUS),
}


@pytest.mark.parametrize("name", SIGNALS)
def test_exact_a_scene_has_its_own_inputs_and_outputs_and_no_others(fmus, name):
    inputs, outputs = SIGNALS[name]
    assert set(fmus[name].names("input")) == set(inputs)
    # More outputs than these may come; none of these may go, and none of a part that the scene does not have may be there.
    found = set(fmus[name].names("output"))
    assert set(outputs) <= found
    parts = {output.split(".")[0].split("[")[0] for output in outputs}
    assert {output.split(".")[0].split("[")[0] for output in found} == parts
    assert ("cable.point[1].x" in found) == ("cable.point[1].x" in outputs)


def numbers(tree, path=""):
    """Every number of a scene file with its dotted name."""
    items = tree.items() if isinstance(tree, dict) else enumerate(tree, 1)
    for key, value in items:
        name = f"{path}.{key}".lstrip(".") if isinstance(tree, dict) else f"{path}[{key}]"
        if isinstance(value, (dict, list)):
            yield from numbers(value, name)
        elif isinstance(value, (int, float)) and not isinstance(value, bool):
            yield re.sub(r"\]\[", ",", name), value


@pytest.mark.parametrize("name", ["flume", "anchor", "thesis", "ned"])
def test_exact_every_number_of_the_scene_is_a_parameter(fmus, name):
    fmu = fmus[name]
    # An output is called winch.angle; the number that decides how many variables there are is none of them.
    renamed = {"winch.angle": "winch.initial_angle", "outputs.points": None}
    tree = scenes.flume() if name == "flume" else scenes.tree(name)
    for key, value in numbers(tree):
        key = renamed.get(key, key)
        if key is not None:
            variable = fmu.variables[key]
            assert variable.causality == "parameter" and variable.variability in ("fixed", "tunable"), key
            assert float(variable.start) == value, key


def test_exact_units_and_types_are_declared(flume):
    units = {unit.name: unit for unit in flume.description.unitDefinitions}
    expected = {
        "ship.x": ("m", {"m": 1}), "ship.roll": ("rad", {"rad": 1}), "ship.vx": ("m/s", {"m": 1, "s": -1}),
        "winch.tension": ("N", {"kg": 1, "m": 1, "s": -2}), "winch.torque": ("N.m", {"kg": 1, "m": 2, "s": -2}),
        "cable.EI": ("N.m2", {"kg": 1, "m": 3, "s": -2}), "fluid.density": ("kg/m3", {"kg": 1, "m": -3}),
        "gravity": ("m/s2", {"m": 1, "s": -2}),
    }
    for name, (unit, base) in expected.items():
        variable = flume.variables[name]
        declared = variable.unit or variable.declaredType.unit
        assert declared == unit, name
        powers = {b: getattr(units[unit].baseUnit, b) for b in ("kg", "m", "s", "A", "K", "mol", "cd", "rad")}
        assert {b: p for b, p in powers.items() if p} == base, name
        assert units[unit].baseUnit.factor == 1.0 and units[unit].baseUnit.offset == 0.0
    for variable in flume.variables.values():
        assert variable.type != "Real" or variable.declaredType is not None, variable.name


def test_exact_capabilities_are_stated(flume):
    cs = flume.description.coSimulation
    assert cs.canHandleVariableCommunicationStepSize and cs.canGetAndSetFMUstate and cs.canSerializeFMUstate
    assert cs.canNotUseMemoryManagementFunctions and not cs.canBeInstantiatedOnlyOncePerProcess
    assert cs.providesDirectionalDerivative and cs.maxOutputDerivativeOrder == 1 and cs.canInterpolateInputs
    experiment = flume.description.defaultExperiment
    values = [float(x) for x in (experiment.startTime, experiment.stopTime, experiment.tolerance, experiment.stepSize)]
    assert all(math.isfinite(x) for x in values) and values[1] > values[0] and values[3] > 0


@pytest.mark.parametrize("name", ALL)
def test_exact_start_values_are_those_of_a_fresh_instance(fmus, name):
    fmu = fmus[name]
    expected = {v.name: v for v in fmu.variables.values() if v.start is not None}
    assert set(fmu.names("parameter") + fmu.names("input")) == set(expected)
    with fmu.instance() as fresh:
        for prepare in (lambda: None, fresh.start):
            prepare()
            for key, value in fresh.get(list(expected)).items():
                start = expected[key].start
                assert value == (int(start) if expected[key].type == "Integer" else float(start)), key
