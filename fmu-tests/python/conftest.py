"""Packs each scene once per session, in a temporary folder, through `cargo xtask package`."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest
import scenes
from host import Packed


def xtask_command():
    """A prebuilt binary in FAIRLEAD_XTASK, or cargo."""
    binary = os.environ.get("FAIRLEAD_XTASK")
    return [binary] if binary else ["cargo", "xtask"]


@pytest.fixture(scope="session")
def xtask():
    """Runs a command from the repository's root; returns the finished process with its texts."""

    def run(*arguments, cwd=scenes.ROOT):
        command = xtask_command() + [str(a) for a in arguments]
        return subprocess.run(command, cwd=cwd, capture_output=True, text=True, encoding="utf-8", stdin=subprocess.DEVNULL)

    return run


class Packer:
    def __init__(self, xtask, folder):
        self.xtask = xtask
        self.folder = folder
        self.packed = {}

    def __getitem__(self, name):
        """The FMU of a built-in scene or of a variant."""
        if name not in self.packed:
            scene = name
            if name not in scenes.BUILT_IN:
                scene = scenes.write(self.folder / f"{name}.toml", scenes.tree(name))
            path = self.folder / f"{name}.fmu"
            done = self.xtask("package", scene, "--out", path)
            assert done.returncode == 0, done.stderr
            assert done.stdout.splitlines()[-1] == str(path)
            self.packed[name] = Packed(path, self.folder / name)
        return self.packed[name]


@pytest.fixture(scope="session")
def fmus(xtask, tmp_path_factory):
    """FMUs by name, packed when first asked for."""
    return Packer(xtask, tmp_path_factory.mktemp("fmu"))


@pytest.fixture(scope="session")
def flume(fmus):
    return fmus["flume"]


@pytest.fixture(scope="session")
def beside(xtask, tmp_path_factory):
    """Folder with the FMU of a scene and all that `cargo xtask package --osp --ssp` writes beside it, made when first asked for."""
    known = {}

    def of(name):
        if name not in known:
            folder = tmp_path_factory.mktemp(f"beside-{name}")
            done = xtask("package", name, "--osp", "--ssp", "--out", folder / f"{name}.fmu")
            assert done.returncode == 0, done.stderr
            expected = {f"{name}{end}" for end in (".fmu", ".ssv", ".ssp", "_OspModelDescription.xml", "_OspSystemStructure.xml")}
            assert {path.name for path in folder.iterdir()} == expected
            assert {Path(line).name for line in done.stdout.splitlines()} >= expected
            known[name] = folder
        return known[name]

    return of


@pytest.fixture
def awkward(tmp_path):
    """A folder with spaces, umlauts and signs that URIs treat in a special way."""
    folder = tmp_path / "Ordner mit Ümläuten, 100% & #1 ß+ä"
    folder.mkdir()
    yield folder
    shutil.rmtree(folder)
