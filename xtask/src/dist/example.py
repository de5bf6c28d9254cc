"""Runs one of the FMUs for ten seconds and prints what the cable does: python example.py flume.fmu

Needs fmpy (pip install fmpy). A ship, where the scene has one, heaves by a centimetre; a winch, where there is one, holds still.
"""

import sys

import numpy as np
from fmpy import read_model_description, simulate_fmu

path = sys.argv[1] if len(sys.argv) > 1 else "flume.fmu"
inputs = [v for v in read_model_description(path).modelVariables if v.causality == "input"]

# All inputs stay at their start values, but for a heave of 1 cm every 4 s, from rest, with its velocity and acceleration.
time = np.linspace(0.0, 10.0, 1001)
frequency = 2 * np.pi / 4.0
heave = {
    "ship.z": 0.005 * (1 - np.cos(frequency * time)),
    "ship.vz": 0.005 * frequency * np.sin(frequency * time),
    "ship.az": 0.005 * frequency**2 * np.cos(frequency * time),
}
columns = {"time": time, **{v.name: float(v.start) + heave.get(v.name, 0 * time) for v in inputs}}
signals = np.array(list(zip(*columns.values())), dtype=[(name, float) for name in columns])

result = simulate_fmu(path, stop_time=10.0, output_interval=0.05, input=signals if inputs else None)
for name in ("cable.tension_max", "cable.tension_min", "body.z", "load.z", "winch.angle"):
    if name in result.dtype.names:
        print(f"{name:18} from {result[name].min():.6g} to {result[name].max():.6g}")
assert (result["status.code"] == 0).all(), "status.code says that the FMU had trouble"
