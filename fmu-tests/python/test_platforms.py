"""`cargo xtask package --platform`: one FMU for old systems and others."""

import re
import shutil
import subprocess
import zipfile
from pathlib import Path

import fmpy
import pytest
from host import Packed


@pytest.fixture(scope="module")
def portable(xtask, tmp_path_factory):
    folder = tmp_path_factory.mktemp("portable")
    path = folder / "portable.fmu"
    done = xtask("package", "flume", "--platform", "linux64", "--out", path)
    assert done.returncode == 0, done.stderr
    return path, done.stdout


def test_exact_linux64_needs_no_more_than_glibc_2_17(xtask, portable, tmp_path):
    path, said = portable
    major, minor = re.search(r"linux64: needs GLIBC (\d+)\.(\d+)", said).groups()
    assert (int(major), int(minor)) <= (2, 17)
    assert "libgcc_s" not in said and said.splitlines()[-1] == str(path)
    done = xtask("validate", path)
    assert (done.returncode, done.stderr) == (0, "")
    if shutil.which("objdump"):  # another reader of the same tables; binutils come with every C linker
        with zipfile.ZipFile(path) as archive:
            library = archive.extract("binaries/linux64/flume.so", tmp_path)
        text = subprocess.run(["objdump", "-p", library], capture_output=True, text=True, check=True).stdout
        versions = [tuple(map(int, v.split("."))) for v in re.findall(r"GLIBC_([\d.]+)", text)]
        assert versions and max(versions) <= (2, 17), sorted(set(versions))
        assert int(re.search(r"FLAGS_1\s+0x([0-9a-f]+)", text)[1], 16) & 8, "not linked with -z nodelete"
    # Built on this machine, but silent about it.
    assert str(Path.home()).encode() + b"/" not in zipfile.ZipFile(path).read("binaries/linux64/flume.so")


def test_cross_the_portable_library_simulates_what_the_plain_one_does(portable, flume, tmp_path):
    """Another linker and another C library to link against, the same arithmetic: equal GUIDs, and outputs within solver.tolerance."""
    path, _ = portable
    other = Packed(path, tmp_path / "fmu")
    assert other.guid == flume.guid
    results = [fmpy.simulate_fmu(str(p), stop_time=1.0, output=["winch.tension", "body.z"]) for p in (path, flume.path)]
    for name in ("winch.tension", "body.z"):
        assert results[0][name] == pytest.approx(results[1][name], rel=1e-3)


def test_exact_the_plain_build_says_what_it_needs(xtask, tmp_path):
    done = xtask("package", "flume", "--out", tmp_path / "plain.fmu")
    assert re.search(r"^linux64: needs GLIBC \d+\.\d+, .*libc\.so\.6", done.stdout, re.M), done.stdout


def test_exact_an_unknown_platform_is_refused(xtask, tmp_path):
    done = xtask("package", "flume", "--platform", "linux64,amiga", "--out", tmp_path / "x.fmu")
    assert done.returncode == 1 and "amiga" in done.stderr and "win64" in done.stderr
    assert list(tmp_path.iterdir()) == []
