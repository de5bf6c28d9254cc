"""A host in C: what ctypes hides (a real printf logger, freed structs), and valgrind's view of the memory."""

import math
import os
import re
import shutil
import subprocess
import sys

import native
import pytest

# Instructions per simulated second of the flume, the day they were counted (rustc 1.95, baseline x86-64).
FROZEN_INSTRUCTIONS = 144_000_000

pytestmark = pytest.mark.skipif(sys.platform != "linux" or not shutil.which("cc"), reason="needs Linux and a C compiler named cc")


@pytest.fixture(scope="module")
def host(tmp_path_factory):
    return native.compile_host("cc", tmp_path_factory.mktemp("c") / "drive", "-ldl", "-lm")


def test_exact_a_host_in_c_gets_what_fmi_promises(flume, host):
    command = [host, *native.arguments(flume.folder, "binaries/linux64/flume.so", 1.0)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    rows = native.table(done.stdout)
    assert len(rows) == 50 and all(math.isfinite(x) for row in rows for x in row)


def test_exact_the_processor_does_not_change_a_bit(flume, host):
    """The kernels compiled for old processors give what those for the newest at hand give: no sum or product is fused."""
    command = [host, *native.arguments(flume.folder, "binaries/linux64/flume.so", 1.0)]
    run = lambda simd: subprocess.run(command, capture_output=True, check=True, env={**os.environ, "FAIRLEAD_SIMD": simd}).stdout
    newest = run("avx512")
    assert newest and run("avx2") == newest and run("baseline") == newest


@pytest.mark.skipif(not shutil.which("valgrind"), reason="valgrind is not installed")
def test_exact_valgrind_finds_nothing(flume, host):
    """No access to freed or foreign memory, no decision on uninitialized values, no leak over the whole life cycle.

    With the kernels for old processors: valgrind up to 3.19 at least does not know all of AVX (VMOVQ between registers in its storing form)."""
    memcheck = ["valgrind", "--quiet", "--error-exitcode=9", "--leak-check=full", "--errors-for-leak-kinds=definite,indirect,possible"]
    command = [*memcheck, host, *native.arguments(flume.folder, "binaries/linux64/flume.so", 0.04)]
    done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, "FAIRLEAD_SIMD": "baseline"})
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.skipif(not shutil.which("valgrind"), reason="valgrind is not installed")
def test_frozen_instructions_of_a_simulated_second(flume, host, tmp_path):
    """What a step costs, counted and not timed: instructions of the flume's kernels for old processors, the start taken off."""

    def instructions(seconds):
        counted = tmp_path / f"callgrind-{seconds}"
        command = [host, *native.arguments(flume.folder, "binaries/linux64/flume.so", seconds)]
        callgrind = ["valgrind", "--quiet", "--tool=callgrind", f"--callgrind-out-file={counted}", *command]
        subprocess.run(callgrind, check=True, capture_output=True, env={**os.environ, "FAIRLEAD_SIMD": "baseline"})
        return int(re.search(r"^(?:summary|totals): (\d+)", counted.read_text(), re.M)[1])

    per_second = (instructions(0.6) - instructions(0.2)) / 0.4
    print(f"{per_second / 1e6:.0f} million instructions per simulated second")
    # Another compiler may need some more; a kernel that fell back to one number at a time needs twice as many.
    assert per_second < 1.1 * FROZEN_INSTRUCTIONS
