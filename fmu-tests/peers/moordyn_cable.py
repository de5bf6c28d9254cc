"""MoorDyn's part of `cargo xtask bench --peers`: one scene on one mesh with one step.

    moordyn_cable.py SCENE ELEMENTS STEP EVERY END OUT

writes what the comparison asks for every EVERY seconds up to END to OUT (CSV, SI units) and prints the CPU seconds of the stepping loop. The scenes
(p3, p4a, p4b, p5) are those of fmu-tests/references/README.md.
"""

import math
import os
import struct
import sys
import tempfile
import time
from pathlib import Path

import moordyn

GRAVITY = 9.81

INPUT = """--------------------- MoorDyn input ---------------------
{name}
---------------------- LINE TYPES ----------------------
TypeName Diam Mass/m EA BA EI Cd Ca CdAx CaAx
(name) (m) (kg/m) (N) (N-s) (N-m^2) (-) (-) (-) (-)
line {diameter} {mass} {stiffness} {damping} {bending} {drag} {added_mass} {axial_drag} 0
---------------------- POINTS ----------------------
ID Type X Y Z Mass Volume CdA Ca
(#) (name) (m) (m) (m) (kg) (m^3) (m^2) (-)
1 Coupled 0 0 {top} 0 0 0 0
2 Free {x} 0 {z} {body_mass} {volume} {drag_area} {body_added_mass}
---------------------- LINES ----------------------
ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs
(#) (name) (#) (#) (m) (-) (-)
1 line 2 1 {length} {elements} -
---------------------- OPTIONS ----------------------
0 writeLog
1 disableOutput
1 disableOutTime
{step} dtM
1e9 CFL
RK2 tScheme
{gravity} g
{density} rho
{depth} WtrDpth
0 kbot
0 cbot
{currents} Currents
0 WaveKin
{rest_time} TmaxIC
{rest_step} dtIC
{rest_within} threshIC
---------------------- need this line ----------------------
"""

WIRE = {
    "diameter": 0.02,
    "mass": 1.0,
    "stiffness": 1e7,
    "damping": 4e4,
    "bending": 20.0,
    "drag": 0.0,
    "added_mass": 0.0,
    "axial_drag": 0.0,
    "top": 0.0,
    "length": 200.0,
    "x": 0.0,
    "z": -200.137,
    "body_mass": 500.0,
    "volume": 0.0,
    "drag_area": 0.0,
    "body_added_mass": 0.0,
    # Vacuum: water of no density.
    "density": 0.0,
    "depth": 1000.0,
    "currents": 0,
    "rest_time": 100.0,
    "rest_step": 1.0,
    "rest_within": 1e-7,
}
STRING = {
    "diameter": 4.5e-4,
    "mass": 2e-4,
    "stiffness": 222.0,
    "damping": 0.02,
    "bending": 2.82e-6,
    "drag": 0.0,
    "added_mass": 0.0,
    "axial_drag": 0.0,
    "top": 0.0,
    "length": 1.0,
    "x": 1.0,
    "z": 0.0,
    "body_mass": 1.33e-3,
    "volume": 0.0,
    "drag_area": 0.0,
    "body_added_mass": 0.0,
    "density": 0.0,
    "depth": 1000.0,
    "currents": 0,
    "rest_time": 0.0,
    "rest_step": 1.0,
    "rest_within": 1e-7,
}
REACH = math.hypot(0.7097202495, 0.6868668200)
NYLON = {
    "diameter": 4.5e-4,
    "mass": 2e-4,
    "stiffness": 222.0,
    "damping": 0.002,
    "bending": 0.0,
    "drag": 2.30,
    "added_mass": 1.0,
    "axial_drag": 0.05,
    "top": 0.46,
    "length": 1.01,
    # Straight towards the place where the sphere would rest: from there the current bends it.
    "x": 1.01 * 0.7097202495 / REACH,
    "z": 0.46 - 1.01 * 0.6868668200 / REACH,
    "body_mass": 1.33e-3,
    "volume": 5.235987755982989e-7,
    "drag_area": 0.45 * 7.853981633974483e-5,
    "body_added_mass": 0.5,
    "density": 1026.0,
    "depth": 10.0,
    "currents": 1,
    "rest_time": 0.0,
    "rest_step": 1.0,
    "rest_within": 1e-7,
}
# Rows of z, v_x: the flume's shear flow.
CURRENT = [(-0.5, 0.03655), (0.0, 0.3302)]


def eased(t, amplitude, period):
    """amplitude sin(2 pi t/period) after a half-cosine ramp over two periods, and its acceleration."""
    ramp, rate = 2.0 * period, 2.0 * math.pi / period
    k = math.pi / ramp
    s, s_t, s_tt = (
        (0.5 * (1.0 - math.cos(k * t)), 0.5 * k * math.sin(k * t), 0.5 * k * k * math.cos(k * t)) if t < ramp else (1.0, 0.0, 0.0)
    )
    wave, wave_t = amplitude * math.sin(rate * t), amplitude * rate * math.cos(rate * t)
    return s * wave, s_tt * wave + 2.0 * s_t * wave_t - rate * rate * s * wave


SCENES = {
    "p3": (STRING, lambda t: (0.0, 0.0)),
    "p4a": (WIRE, lambda t: eased(t, 2.5, 6.0)),
    "p4b": (WIRE, lambda t: eased(t, 5.0, 4.0)),
    "p5": (NYLON, lambda t: eased(t, 0.01, 1.0)),
}


def straighten(system, line, elements, top, body):
    """Puts the line's inner nodes on the straight line to the body: MoorDyn itself starts from a catenary. They can be set in a saved state only."""
    moordyn.SaveState(system, "state")
    state = Path("state").read_bytes()
    for k in range(1, elements):
        found = struct.pack("<3d", *moordyn.GetLineNodePos(line, k))
        if state.count(found) != 1:
            sys.exit(f"node {k} is not found in MoorDyn's saved state")
        share = 1.0 - k / elements
        state = state.replace(found, struct.pack("<3d", share * body[0], 0.0, top + share * (body[2] - top)))
    Path("state").write_bytes(state)
    moordyn.LoadState(system, "state")


def main():
    name, elements, step, every, end, out = sys.argv[1:]
    elements, step, every, end = int(elements), float(step), float(every), float(end)
    values, motion = SCENES[name]
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        text = INPUT.format(name=name, elements=elements, step=step, gravity=GRAVITY, **values)
        Path("scene.txt").write_text(text)
        profile = "".join(f"{z} {v} 0 0\n" for z, v in CURRENT)
        Path("current_profile.txt").write_text("current\nsteady\nz, v\n" + profile)
        system = moordyn.Create("scene.txt")
        top = values["top"]
        moordyn.SetVerbosity(system, moordyn.LEVEL_WRN)
        moordyn.Init(system, [0.0, 0.0, top], [0.0, 0.0, 0.0])
        line, body = moordyn.GetLine(system, 1), moordyn.GetPoint(system, 2)
        if values["rest_time"] == 0.0:
            straighten(system, line, elements, top, moordyn.GetPointPos(body))
        # A point's velocity is held over a call, so every call is one step.
        steps, each = round(end / step), round(every / step)
        moves = [motion(k * step)[0] for k in range(steps + 1)]
        heights = [[0.0, 0.0, top + z] for z in moves]
        speeds = [[0.0, 0.0, (after - before) / step] for before, after in zip(moves, moves[1:], strict=False)]
        # The force on the held end leaves out the inertia of the half segment that is lumped there.
        lump = 0.5 * values["mass"] * values["length"] / elements
        x, _, z = moordyn.GetPointPos(body)
        rows, seconds = [(0.0, math.hypot(*moordyn.GetLineNodeTen(line, elements)), x, z)], 0.0
        for block in range(0, steps, each):
            start = time.process_time()
            for k in range(block, block + each):
                force = moordyn.Step(system, heights[k], speeds[k], k * step, step)
            seconds += time.process_time() - start
            t = (block + each) * step
            x, _, z = moordyn.GetPointPos(body)
            pull = (force[0], force[2] - lump * motion(t)[1])
            # A cable that pushes, as P4b's damping does, has a tension below 0.
            towards = pull[0] * x + pull[1] * (z - heights[block + each][2])
            rows.append((t, math.copysign(math.hypot(*pull), towards), x, z))
        moordyn.Close(system)
    with Path(out).open("w") as file:
        file.write("time,tension,x,z\n")
        file.writelines(",".join(f"{value:.10g}" for value in row) + "\n" for row in rows)
    print(f"seconds {seconds:.6f}")


if __name__ == "__main__":
    main()
