"""Every case of abuse.py in a process of its own, so that a crash ends that case and nothing else; it has to say nothing."""

import platform
import shutil
import subprocess
import sys
from pathlib import Path

import abuse
import pytest

PROGRAM = Path(abuse.__file__)
pytestmark = pytest.mark.skipif(platform.machine() != "x86_64" or sys.platform != "linux", reason="the cases know Linux on x86-64")


@pytest.mark.parametrize("case", abuse.CASES)
def test_exact_abuse(flume, tmp_path, case):
    folder = shutil.copytree(flume.folder, tmp_path / "fmu")
    done = subprocess.run([sys.executable, str(PROGRAM), case, str(folder)], capture_output=True, text=True, timeout=300)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_exact_a_case_that_fails_is_noticed(flume):
    """The library is not there: the process has to end badly."""
    done = subprocess.run([sys.executable, str(PROGRAM), "wrong_guid", "/no/such/folder"], capture_output=True, text=True)
    assert done.returncode != 0 and done.stderr
