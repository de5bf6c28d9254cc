"""Runs an FMU's win64 library under wine and its linux64 library here, and compares: `python windows.py FMU SUMMARY`.

Prints what it found and writes it to SUMMARY; exit status 0 only if both runs end well and agree within the solver's tolerance.
"""

import os
import platform
import re
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

import native

SECONDS = 20.0
COMPILER = "x86_64-w64-mingw32-gcc"
# Rust's std asks this library for random numbers; wine 8 does not have it.
SHIM = """#include <windows.h>
BOOLEAN NTAPI SystemFunction036(PVOID buffer, ULONG length);
__declspec(dllexport) BOOL WINAPI ProcessPrng(PBYTE data, SIZE_T count) { return SystemFunction036(data, (ULONG)count); }
"""


def wine():
    """The 64-bit loader, which Debian does not put on the path."""
    places = [Path(folder) / "wine64" for folder in [*os.environ["PATH"].split(os.pathsep), "/usr/lib/wine"]]
    found = next((place for place in places if place.is_file()), None)
    if found is None:
        sys.exit("wine64 is not installed (Debian: apt install wine64)")
    return str(found)


def drive(command, **environment):
    done = subprocess.run(command, capture_output=True, text=True, env=os.environ | environment)
    if done.returncode != 0:
        sys.exit(f"{command[0]} ended with {done.returncode}\n{done.stderr}")
    return native.table(done.stdout)


def main(fmu, summary):
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(scratch)
        with zipfile.ZipFile(fmu) as archive:
            archive.extractall(scratch / "fmu")
        name = re.search(r'modelIdentifier="([^"]*)"', (scratch / "fmu" / "modelDescription.xml").read_text(encoding="utf-8"))[1]
        here = native.compile_host("cc", scratch / "drive", "-ldl", "-lm")
        there = native.compile_host(COMPILER, scratch / "drive.exe", "-static")
        (scratch / "shim.c").write_text(SHIM)
        shim = [COMPILER, "-shared", "-o", str(scratch / "bcryptprimitives.dll"), str(scratch / "shim.c"), "-ladvapi32"]
        subprocess.run(shim, check=True)

        arguments = native.arguments(scratch / "fmu", f"binaries/linux64/{name}.so", SECONDS)
        linux = drive([str(here), *arguments])
        windows_path = lambda path: "Z:" + str(path).replace("/", "\\")
        uri = "file:///Z:" + (scratch / "fmu" / "resources").as_posix()
        arguments = native.arguments(scratch / "fmu", f"binaries/win64/{name}.dll", SECONDS, windows_path, uri)
        windows = drive([wine(), str(there), *arguments], WINEPREFIX=str(scratch / "wine"), WINEDEBUG="-all")

    assert len(linux) == len(windows) == round(SECONDS / 0.02)
    xml = zipfile.ZipFile(fmu).read("modelDescription.xml").decode()
    tolerance = float(re.search(r'<DefaultExperiment[^>]*tolerance="([^"]*)"', xml)[1])
    version = subprocess.run([wine(), "--version"], capture_output=True, text=True).stdout.strip()
    text = f"""# {name}: win64 under wine beside linux64

Written by `.ci/windows`. The host in `fmu-tests/c/drive.c` loads the library, leads instances through their life (load, refuse, run, save,
restore, reset, free, unload, twice) and makes a run of {SECONDS:g} s in steps of 0.02 s of a ship that heaves by 10 mm. win64: {version};
linux64: the same FMU's library on {platform.system()}. Bound: the solver's tolerance, {tolerance:g} of the range of each output.

| output | range in the run | greatest difference | part of the range |
|---|---|---|---|
"""
    good = True
    for k, output in enumerate(native.OUTPUTS):
        column = [row[k] for row in linux]
        extent = max(column) - min(column)
        difference = max(abs(a[k] - b[k]) for a, b in zip(linux, windows))
        good &= difference <= tolerance * extent
        text += f"| `{output}` | {extent:.4g} | {difference:.1e} | {difference / extent:.1e} |\n"
    text += f"\n{'They agree.' if good else 'THEY DIFFER.'}\n"
    print(text)
    Path(summary).write_text(text, encoding="utf-8")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
