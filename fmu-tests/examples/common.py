"""What the examples share: where things lie, FMUs packed by `cargo xtask package`, ship motions made by `cargo xtask ship-motion`."""

import csv
import math
import os
import subprocess
import tomllib
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
SCENES = ROOT / "modelDescription" / "scenes"

POSE = ["ship.x", "ship.y", "ship.z", "ship.roll", "ship.pitch", "ship.yaw"]
RATE = ["ship.vx", "ship.vy", "ship.vz", "ship.roll_rate", "ship.pitch_rate", "ship.yaw_rate"]
ACCELERATION = ["ship.ax", "ship.ay", "ship.az", "ship.roll_acceleration", "ship.pitch_acceleration", "ship.yaw_acceleration"]
SHIP = POSE + RATE + ACCELERATION

# Significant wave height (m) and most probable peak period (s) of the sea states of NATO's STANAG 4194, annex D (open ocean, North Atlantic,
# after Bales, Lee and Voelker, DTNSRDC/SPD-0919-01, 1981): middles of the ranges of height.
SEA_STATES = {2: (0.3, 6.9), 3: (0.88, 7.5), 4: (1.88, 8.8), 5: (3.25, 9.7), 6: (5.0, 12.4), 7: (7.5, 15.0)}


class Failure(Exception):
    """A mistake of the user's or of a program called; its text says what was expected."""


def xtask(*arguments):
    """Runs a command of `cargo xtask` and returns what it printed; FAIRLEAD_XTASK may name a built xtask."""
    binary = os.environ.get("FAIRLEAD_XTASK")
    command = ([binary] if binary else ["cargo", "xtask"]) + [str(a) for a in arguments]
    try:
        done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, encoding="utf-8", stdin=subprocess.DEVNULL)
    except OSError as problem:
        raise Failure(f"{command[0]} cannot be started ({problem}); expected Rust's cargo on the PATH") from None
    if done.returncode:
        raise Failure(f"`cargo xtask {' '.join(command[1 if binary else 2:])}` failed, see above")
    return done.stdout


def packed(scene, out=None):
    """Path of the FMU of a built-in scene or a scene file, packed now, as `out` or in target/fmu: with the library built before it takes a second."""
    return Path(xtask("package", scene, *([] if out is None else ["--out", out])).splitlines()[-1])


def variant(text, folder):
    """Packs a scene given as TOML text as NAME.fmu in a folder, beside its NAME.toml; returns the FMU's path."""
    folder = Path(folder).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    name = tomllib.loads(text)["name"]
    (folder / f"{name}.toml").write_text(text, encoding="utf-8")
    return packed(folder / f"{name}.toml", folder / f"{name}.fmu")


def motion(path, **options):
    """Ship motion by `cargo xtask ship-motion` with its options (underscores for hyphens): times (s) and the 18 values of SHIP, [time][18]."""
    path = Path(path).resolve()
    arguments = [f"--{name.replace('_', '-')}={value}" for name, value in options.items()]
    xtask("ship-motion", *arguments, "--out", path)
    with open(path, newline="") as file:
        rows = csv.reader(file)
        columns = next(rows)
        table = np.array([[float(x) for x in row] for row in rows])
    return table[:, 0], table[:, [columns.index(name) for name in SHIP]]


def rotation(angles):
    """R_z(yaw) R_y(pitch) R_x(roll), which takes ship components to inertial ones; angles are roll, pitch, yaw in rad."""
    (sa, ca), (sb, cb), (sg, cg) = ((math.sin(a), math.cos(a)) for a in angles)
    return np.array([
        [cg * cb, cg * sb * sa - sg * ca, cg * sb * ca + sg * sa],
        [sg * cb, sg * sb * sa + cg * ca, sg * sb * ca - cg * sa],
        [-sb, cb * sa, cb * ca],
    ])


def turning(angles):
    """The matrix that takes the rates of roll, pitch and yaw to the angular velocity in ship axes, rad/s."""
    (sa, ca), (sb, cb) = ((math.sin(a), math.cos(a)) for a in angles[:2])
    return np.array([[1.0, 0.0, -sb], [0.0, ca, sa * cb], [0.0, -sa, ca * cb]])


def write_csv(path, columns):
    """Columns of equal length under their names."""
    with open(path, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows(zip(*columns.values()))


def table(head, rows):
    """Text of a table with columns of equal width, numbers to the right."""
    widths = [max(len(row[i]) for row in [head, *rows]) for i in range(len(head))]
    line = lambda row: "  ".join(cell.ljust(w) if i < 2 else cell.rjust(w) for i, (cell, w) in enumerate(zip(row, widths))).rstrip()
    return "\n".join([line(head), line(["-" * w for w in widths]), *map(line, rows)])
