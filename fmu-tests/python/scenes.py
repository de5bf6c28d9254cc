"""Scenes that the tests pack: the built-in ones, and variants of the flume scene made by changing its TOML tree."""

import copy
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCENES = ROOT / "modelDescription" / "scenes"
BUILT_IN = sorted(path.stem for path in SCENES.glob("*.toml"))


def flume():
    """The default scene as a tree that may be changed."""
    return tomllib.loads((SCENES / "flume.toml").read_text(encoding="utf-8"))


def no_ship(s):
    del s["ship"]


def anchor(s):
    del s["winch"]
    s["anchor"] = {"position": [0.1, 0.02, 0.0]}


def vacuum(s):
    del s["fluid"]


def pose(s):
    s["ship"]["input"] = "pose"


def pose_velocity(s):
    s["ship"]["input"] = "pose_velocity"


def payout(s):
    s["winch"]["command"] = "payout"


def no_points(s):
    s["outputs"]["points"] = 0


def body_force(s):
    s["body"]["force_input"] = True


def no_body(s):
    """Without a weight at its end the cable streams in the current; it starts straight."""
    del s["body"]
    s["initial"] = {"state": "straight", "direction": [0.0, 0.0, -1.0]}


def tangent(s):
    s["winch"]["end"] = "tangent"


def mirrored_winch(s):
    """The cable leaves towards positive angles: the same scene seen from behind."""
    s["winch"]["direction"] = 1
    s["winch"]["angle"] = -s["winch"]["angle"]


def thesis(s):
    """Every other choice of law that the flume scene does not take."""
    s["cable"]["strain"] = "green"
    s["cable"]["compression"] = "linear"
    s["cable"]["damping"] = {"model": "gradient_rate", "coefficient": 1e-3}
    s["fluid"]["drag"] = {"law": "cross_flow", "cd_normal": 1.2, "cd_tangential": 0.02}


def bare(s):
    """A pendulum: a cable, a body, gravity, and nothing else."""
    anchor(s), no_ship(s), vacuum(s), no_points(s)


def ned(s):
    """The same scene written with z down: every position and height is turned about the x axis."""
    s["ship"]["frame"] = "ned"
    turned = lambda v: [v[0], -v[1], -v[2]]
    s["winch"]["position"] = turned(s["winch"]["position"])
    s["winch"]["axis"] = turned(s["winch"]["axis"])
    # Angles stay: the axis is the same in space, and "up" is up in both.
    s["fluid"]["waterline"] *= -1
    s["fluid"]["current"]["profile"] = [[-z, vx, -vy] for z, vx, vy in s["fluid"]["current"]["profile"]]


VARIANTS = [
    no_ship, anchor, vacuum, pose, pose_velocity, payout, no_points, body_force, no_body, tangent, mirrored_winch, thesis, bare, ned,
]


def tree(name):
    """The tree of a variant; its FMU carries the variant's name."""
    s = flume()
    next(change for change in VARIANTS if change.__name__ == name)(s)
    s["name"] = name
    return s


def write(path, s):
    """Writes a tree as TOML."""
    path.write_text(dump(s), encoding="utf-8")
    return path


def dump(table, path=""):
    """TOML text of a tree of tables, arrays and plain values."""
    s = copy.copy(table)
    inner = {key: s.pop(key) for key, value in table.items() if isinstance(value, dict)}
    lines = [f"{key} = {_value(value)}" for key, value in s.items()]
    for key, value in inner.items():
        name = f"{path}.{key}" if path else key
        lines += ["", f"[{name}]", dump(value, name)]
    return "\n".join(lines)


def _value(value):
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(value, list):
        return "[" + ", ".join(_value(v) for v in value) + "]"
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{k} = {_value(v)}" for k, v in value.items()) + " }"
    return repr(value)
