"""Runs one of the FMUs for ten seconds and prints what the cable does: python example.py flume.fmu

Needs fmpy (pip install fmpy). A ship, where the scene has one, heaves by a centimetre; a winch, where there is one, holds still.
"""

import sys

import numpy as np
from fmpy import read_model_description, simulate_fmu

path = sys.argv[1] if len(sys.argv) > 1 else "flume.fmu"
names = {variable.name for variable in read_model_description(path).modelVariables}

# A heave of 1 cm every 4 s that begins at rest, with its velocity and acceleration where the FMU takes them.
time = np.linspace(0.0, 10.0, 1001)
angle = 2 * np.pi / 4.0 * time
heave = {
    "ship.z": 0.005 * (1 - np.cos(angle)),
    "ship.vz": 0.005 * (np.pi / 2) * np.sin(angle),
    "ship.az": 0.005 * (np.pi / 2) ** 2 * np.cos(angle),
}
given = [name for name in heave if name in names]
signals = np.array(list(zip(time, *(heave[name] for name in given))), dtype=[(name, float) for name in ["time", *given]])

result = simulate_fmu(path, stop_time=10.0, output_interval=0.05, input=signals if given else None)
for name in ("cable.tension_max", "cable.tension_min", "body.z", "load.z", "winch.angle"):
    if name in result.dtype.names:
        print(f"{name:18} from {result[name].min():.6g} to {result[name].max():.6g}")
assert (result["status.code"] == 0).all(), "status.code says that the FMU had trouble"
