"""Runs an FMU's libraries for other platforms here and compares them with its linux64 library: `python platforms.py FMU SUMMARY`.

win64 runs under wine, aarch64-linux under qemu. Prints what it found and writes it to SUMMARY; exit status 0 only if all runs end well and
agree within the solver's tolerance.
"""

import os
import platform
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

import native

SECONDS = 20.0
MINGW = "x86_64-w64-mingw32-gcc"
ARM = "aarch64-linux-gnu-gcc"
QEMU = "qemu-aarch64-static"
# Where Debian's cross compiler has the dynamic linker and libraries of the other system.
ARM_SYSTEM = "/usr/aarch64-linux-gnu"
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


def first_line(*command):
    done = subprocess.run(command, capture_output=True, text=True)
    return done.stdout.splitlines()[0].strip()


def drive(command, **environment):
    done = subprocess.run(command, capture_output=True, text=True, env=os.environ | environment)
    if done.returncode != 0:
        sys.exit(f"{command[0]} ended with {done.returncode}\n{done.stderr}")
    return native.table(done.stdout)


def linux64(scratch, name):
    host = native.compile_host("cc", scratch / "drive", "-ldl", "-lm")
    return drive([str(host), *native.arguments(scratch / "fmu", f"binaries/linux64/{name}.so", SECONDS)])


def win64(scratch, name):
    host = native.compile_host(MINGW, scratch / "drive.exe", "-static")
    (scratch / "shim.c").write_text(SHIM)
    shim = [MINGW, "-shared", "-o", str(scratch / "bcryptprimitives.dll"), str(scratch / "shim.c"), "-ladvapi32"]
    subprocess.run(shim, check=True)
    windows_path = lambda path: "Z:" + str(path).replace("/", "\\")
    uri = "file:///Z:" + (scratch / "fmu" / "resources").as_posix()
    arguments = native.arguments(scratch / "fmu", f"binaries/win64/{name}.dll", SECONDS, windows_path, uri)
    return drive([wine(), str(host), *arguments], WINEPREFIX=str(scratch / "wine"), WINEDEBUG="-all")


def aarch64_linux(scratch, name):
    for program, package in ((ARM, "gcc-aarch64-linux-gnu libc6-dev-arm64-cross"), (QEMU, "qemu-user-static")):
        if shutil.which(program) is None:
            sys.exit(f"{program} is not installed (Debian: apt install {package})")
    host = native.compile_host(ARM, scratch / "drive-aarch64", "-ldl", "-lm")
    arguments = native.arguments(scratch / "fmu", f"binaries/aarch64-linux/{name}.so", SECONDS)
    return drive([QEMU, "-L", ARM_SYSTEM, str(host), *arguments])


# FMI's folder under binaries: how to run it here, and under what.
OTHERS = {
    "win64": (win64, lambda: first_line(wine(), "--version")),
    "aarch64-linux": (aarch64_linux, lambda: first_line(QEMU, "--version")),
}


def main(fmu, summary):
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(scratch)
        with zipfile.ZipFile(fmu) as archive:
            archive.extractall(scratch / "fmu")
        xml = (scratch / "fmu" / "modelDescription.xml").read_text(encoding="utf-8")
        name = re.search(r'modelIdentifier="([^"]*)"', xml)[1]
        there = [folder for folder in OTHERS if (scratch / "fmu" / "binaries" / folder).is_dir()]
        if not there:
            sys.exit(f"{fmu}: no library for {' or '.join(OTHERS)}")
        here = linux64(scratch, name)
        runs = {folder: OTHERS[folder][0](scratch, name) for folder in there}

    tolerance = float(re.search(r'<DefaultExperiment[^>]*tolerance="([^"]*)"', xml)[1])
    text = f"""# {name}: other platforms beside linux64

Written by `.ci/platforms`. The host in `fmu-tests/c/drive.c` loads a library, leads instances through their life (load, refuse, run, save,
restore, reset, free, unload, twice) and makes a run of {SECONDS:g} s in steps of 0.02 s of a ship that heaves by 10 mm. linux64: the same
FMU's library on {platform.system()}. Bound: the solver's tolerance, {tolerance:g} of the range of each output.

| platform | run under | output | range in the run | greatest difference | part of the range |
|---|---|---|---|---|---|
"""
    good = True
    for folder, run in runs.items():
        assert len(here) == len(run) == round(SECONDS / 0.02), folder
        under = OTHERS[folder][1]()
        for k, output in enumerate(native.OUTPUTS):
            column = [row[k] for row in here]
            extent = max(column) - min(column)
            difference = max(abs(a[k] - b[k]) for a, b in zip(here, run))
            good &= difference <= tolerance * extent
            text += f"| {folder} | {under} | `{output}` | {extent:.4g} | {difference:.1e} | {difference / extent:.1e} |\n"
    text += f"\n{'They agree.' if good else 'THEY DIFFER.'}\n"
    print(text)
    Path(summary).write_text(text, encoding="utf-8")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
