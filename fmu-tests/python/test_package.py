"""What lies in an FMU beside model description and library, what is written beside it, and what `cargo xtask dist` gathers."""

import hashlib
import io
import os
import re
import shutil
import struct
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import fmpy
import pytest
import scenes
from conftest import xtask_command
from lxml import etree, html

SCHEMAS = Path(fmpy.__file__).parent
OSP = "{https://open-simulation-platform.com/OspModelDescription/1.0.0}"


def valid(schema, text):
    """Parsed, after FMPy's copy of a schema has been asked."""
    tree = etree.fromstring(text)
    etree.XMLSchema(etree.parse(str(SCHEMAS / schema))).assertValid(tree)
    return tree


def inside(fmu, name):
    with zipfile.ZipFile(fmu.path) as archive:
        return archive.read(name)


def signals(fmu):
    return fmu.names("input") + fmu.names("output")


@pytest.mark.parametrize("name", scenes.BUILT_IN)
def test_exact_every_signal_is_in_one_terminal(fmus, name):
    fmu = fmus[name]
    tree = valid("schema/fmi3/fmi3TerminalsAndIcons.xsd", inside(fmu, "terminalsAndIcons/terminalsAndIcons.xml"))
    members = [member.get("variableName") for member in tree.iter("TerminalMemberVariable")]
    assert sorted(members) == sorted(signals(fmu))
    for terminal in tree.iter("Terminal"):
        names = [child.get("memberName") or child.get("name") for child in terminal if child.tag.startswith("Terminal")]
        assert names and len(names) == len(set(names)) and all(names), terminal.get("name")


def test_exact_the_icon_is_a_small_picture(flume):
    icon = inside(flume, "model.png")
    assert icon[:8] == b"\x89PNG\r\n\x1a\n" and len(icon) < 20_000
    width, height = struct.unpack(">II", icon[16:24])
    assert width == height and 64 <= width <= 256
    assert inside(flume, "terminalsAndIcons/icon.png") == icon


def test_exact_all_licences_are_there(flume):
    own = inside(flume, "documentation/licenses/license.txt").decode()
    assert "Apache License" in own and "MIT" in own and "third-party.txt" in own
    others = inside(flume, "documentation/licenses/third-party.txt").decode()
    # What the root package is compiled from, without a look at cargo: its direct dependencies, in the versions of the lock file.
    wanted = set(tomllib.loads((scenes.ROOT / "Cargo.toml").read_text())["dependencies"])
    locked = {p["name"]: p for p in tomllib.loads((scenes.ROOT / "Cargo.lock").read_text())["package"]}
    for name in wanted - {"fairlead-model-description"}:
        assert f"\n{name} {locked[name]['version']}: " in others, name
    assert "fairlead-model-description" not in others and "faer" not in others
    assert str(Path.home()) not in own + others, "a path of this machine"


@pytest.mark.parametrize("name", scenes.BUILT_IN)
def test_exact_the_manual_has_every_variable_and_no_dead_link(fmus, name):
    fmu = fmus[name]
    page = html.fromstring(inside(fmu, "documentation/index.html").decode())
    cells = {row[0].text_content() for row in page.iter("tr")}
    assert set(fmu.variables) <= cells
    anchors = {element.get("id") for element in page.iter() if element.get("id")}
    with zipfile.ZipFile(fmu.path) as archive:
        files = set(archive.namelist())
    for _, attribute, link, _ in page.iterlinks():
        known = link[1:] in anchors if link.startswith("#") else f"documentation/{link}" in files
        assert known, (attribute, link)
    text = page.text_content()
    for said in ("How to use it", "Frames and signs", "Limits", "status.code", "Positive roll is starboard down"):
        assert said in text, said


@pytest.mark.parametrize("name", scenes.BUILT_IN)
def test_exact_every_signal_is_in_one_osp_group(fmus, beside, name):
    """Numeric or not; ports pair a force with a velocity, one in and one out. What libcosim makes of it is in test_hosts.py."""
    fmu = fmus[name]
    tree = etree.fromstring((beside(name) / f"{name}_OspModelDescription.xml").read_bytes())
    assert tree.tag == f"{OSP}OspModelDescription"
    assert sorted(v.get("ref") for v in tree.iter(f"{OSP}Variable")) == sorted(signals(fmu))
    units = {unit.get("name") for unit in tree.iter(f"{OSP}Unit")}
    assert {v.get("unit") for v in tree.iter(f"{OSP}Variable")} - {None} <= units
    groups = [group for group in tree.find(f"{OSP}VariableGroups").iter() if group.get("name")]
    assert len({group.get("name") for group in groups}) == len(groups)
    # The schema is a sequence of kinds.
    kinds = [group.tag.removeprefix(OSP) for group in tree.find(f"{OSP}VariableGroups")]
    order = (
        "Generic Force Torque LinearVelocity AngularVelocity LinearDisplacement AngularDisplacement LinearAcceleration "
        "AngularAcceleration LinearMechanicalPort"
    ).split()
    assert [order.index(kind) for kind in kinds] == sorted(order.index(kind) for kind in kinds)
    for port in tree.iter(f"{OSP}LinearMechanicalPort"):
        assert [group.tag.removeprefix(OSP) for group in port] == ["Force", "LinearVelocity"]
        force, velocity = ({fmu.variables[v.get("ref")].causality for v in group} for group in port)
        assert len(force) == len(velocity) == 1 and force | velocity == {"input", "output"}


@pytest.mark.parametrize("name", scenes.BUILT_IN)
def test_exact_ssp_files_follow_the_schemas(fmus, beside, name):
    fmu, folder = fmus[name], beside(name)
    values = (folder / f"{name}.ssv").read_bytes()
    parameters = {p.get("name"): p[0].get("value") for p in valid("ssp/schema/SystemStructureParameterValues.xsd", values)[0]}
    assert parameters.keys() == set(fmu.names("parameter"))
    assert all(float(value) == float(fmu.variables[key].start) for key, value in parameters.items())
    with zipfile.ZipFile(folder / f"{name}.ssp") as archive:
        system = valid("ssp/schema/SystemStructureDescription.xsd", archive.read("SystemStructure.ssd"))
        assert archive.read(f"resources/{name}.ssv") == values
        assert archive.read(f"resources/{name}.fmu") == (folder / f"{name}.fmu").read_bytes()
    for component in system.iter("{*}Component"):
        assert {c.get("name"): c.get("kind") for c in component.iter("{*}Connector")} == {
            **dict.fromkeys(fmu.names("input"), "input"), **dict.fromkeys(fmu.names("output"), "output"),
        }


def test_exact_units_name_their_quantity_once(fmus):
    """Every type has a quantity and, unless it is a pure number, a unit; display units go the way FMI wants."""
    for name in scenes.BUILT_IN:
        description = etree.fromstring(inside(fmus[name], "modelDescription.xml"))
        units = {unit.get("name"): unit for unit in description.iter("Unit")}
        for real in description.iterfind("TypeDefinitions/SimpleType/Real"):
            assert real.get("quantity")
            shown = real.get("displayUnit")
            if shown:
                assert shown in {d.get("name") for d in units[real.get("unit")].iter("DisplayUnit")}
        factors = {d.get("name"): float(d.get("factor")) for d in description.iter("DisplayUnit")}
        # A display value is factor times value: 1 rad is 57.3 deg, 1000 N are 1 kN. Rounding is all that may differ.
        for unit, factor in {"deg": 57.29577951308232, "kN": 1e-3, "mm": 1e3, "t": 1e-3}.items():
            assert unit not in factors or abs(factors[unit] / factor - 1) < 1e-15, unit


def test_exact_the_same_bytes_without_the_machine(flume):
    """No date, no path: what two builds of the same sources could differ in."""
    with zipfile.ZipFile(flume.path) as archive:
        assert {entry.date_time for entry in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
        library = archive.read("binaries/linux64/flume.so")
        texts = b"".join(archive.read(name) for name in archive.namelist() if name.endswith((".xml", ".html", ".txt", ".toml")))
    assert str(scenes.ROOT).encode() not in library + texts


@pytest.mark.skipif("FAIRLEAD_REBUILD" not in os.environ, reason="builds the library anew, which takes minutes: set FAIRLEAD_REBUILD=1")
def test_exact_another_checkout_gives_the_same_bytes(flume, tmp_path):
    """Same sources, same compiler, same crates; other folders for sources and build."""
    left_out = shutil.ignore_patterns("target", ".git", ".venv", "__pycache__")
    copy = shutil.copytree(scenes.ROOT, tmp_path / "another checkout", ignore=left_out)
    environment = {key: value for key, value in os.environ.items() if key != "CARGO_TARGET_DIR"}
    # The command asks cargo's variable where its repository is.
    environment["CARGO_MANIFEST_DIR"] = str(copy / "xtask")
    command = [*xtask_command(), "package", "flume", "--out", tmp_path / "flume.fmu"]
    done = subprocess.run(command, cwd=copy, env=environment, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    assert done.returncode == 0, done.stderr
    assert (copy / "target" / "release").is_dir(), "it was not built there"
    assert (tmp_path / "flume.fmu").read_bytes() == flume.path.read_bytes()


def test_exact_dist_has_everything_and_its_checksums(xtask):
    done = xtask("dist")
    assert done.returncode == 0, done.stderr
    folder = Path(done.stdout.splitlines()[-1])
    ends = (".fmu", ".ssv", ".ssp", "_OspModelDescription.xml", "_OspSystemStructure.xml")
    expected = {f"{name}{end}" for name in scenes.BUILT_IN for end in ends}
    expected |= {"CHANGELOG.md", "LICENSE-MIT", "LICENSE-APACHE", "README.txt", "example.py", "SHA256SUMS"}
    assert {path.name for path in folder.iterdir()} == expected
    lines = (folder / "SHA256SUMS").read_text().splitlines()
    sums = dict(reversed(line.split("  ")) for line in lines)
    assert sums == {name: hashlib.sha256((folder / name).read_bytes()).hexdigest() for name in expected - {"SHA256SUMS"}}
    for name in scenes.BUILT_IN:
        assert name in (folder / "README.txt").read_text()
        # The copy within the SSP archive is the same file.
        with zipfile.ZipFile(folder / f"{name}.ssp") as archive:
            assert zipfile.is_zipfile(io.BytesIO(archive.read(f"resources/{name}.fmu")))


def test_exact_the_example_of_dist_runs(flume):
    """It is what users without Rust see first."""
    example = scenes.ROOT / "xtask" / "src" / "dist" / "example.py"
    done = subprocess.run([sys.executable, example, flume.path], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    assert (done.returncode, done.stderr) == (0, "")
    assert re.search(r"body\.z +from -0\.6\d+ to -0\.6\d+", done.stdout), done.stdout
