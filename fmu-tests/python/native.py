"""The host in C, `fmu-tests/c/drive.c`: compiled, and told what to drive."""

import re
import subprocess
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1] / "c" / "drive.c"
INPUTS = ["ship.z", "ship.vz", "ship.az"]
OUTPUTS = ["winch.tension", "body.x", "body.z", "cable.tension_max"]


def compile_host(compiler, target, *flags):
    """Compiles the host; any warning is an error."""
    command = [compiler, "-std=c99", "-O1", "-g", "-Wall", "-Wextra", "-Werror", "-o", str(target), str(SOURCE), *flags]
    subprocess.run(command, check=True)
    return target


def arguments(folder, library, seconds, path=str, uri=None):
    """What the host is told of an unpacked FMU; `path` says how the host's system writes a path."""
    folder = Path(folder)
    xml = (folder / "modelDescription.xml").read_text(encoding="utf-8")
    references = dict(re.findall(r'<ScalarVariable name="([^"]*)" valueReference="(\d+)"', xml))
    guid = re.search(r'guid="([^"]*)"', xml)[1]
    resources = uri or (folder / "resources").as_uri()
    return [path(folder / library), guid, resources, str(seconds), *(references[name] for name in INPUTS + OUTPUTS)]


def table(text):
    """The printed outputs, a row for each communication step."""
    return [[float(word) for word in line.split()] for line in text.splitlines()]
