"""Explicit two-way coupling of a vessel in Python with a cable FMU: the FMU gets the ship's motion and gives the force and moment on the ship.

One step of h from t: the FMU gets pose, rates and accelerations at t and goes to t + h on its own, with the ship's motion continued from them.
Then the vessel goes to t + h with the load that the FMU shows there (the cable first, the vessel after it: a Gauss-Seidel scheme without
iteration). The load at t + h belongs to a continued pose that the vessel then misses by a term of h³, which the FMU makes up for in its next
step: second order in all.
"""

import numpy as np
from common import SHIP, Failure
from slave import CosimSlave, FmpySlave
from vessel import generalized

LOAD = [f"ship.force_world.{c}" for c in "xyz"] + [f"ship.moment.{c}" for c in "xyz"]


def load(out, pose):
    """The cable's load on the six coordinates from the first six outputs."""
    return generalized(out[:3], out[3:6], pose[3:6])


def equilibrium(fmu, vessel, parameters, record=(), still=0.0):
    """Brings the vessel to rest under the cable's load: the FMU is initialized, at rest, at the pose that its load brings about, until that stays.
    Returns the outputs LOAD + record there."""
    for _ in range(12):
        with FmpySlave(fmu, SHIP, LOAD + list(record), parameters, vessel.state()) as slave:
            out = slave.get()
        before = vessel.pose
        vessel.rest(load(out, vessel.pose) + still)
        # The load changes by far less than itself for a change of pose, so that each round gains digits: to a hundredth of a micrometre.
        if np.all(np.abs(vessel.pose - before) <= 1e-8):
            return out
    raise Failure("the ship and the cable find no common equilibrium; expected a ship that does not give way to the cable")


def slave(host, fmu, record, parameters, first, h):
    """The FMU under `host`, fmpy or libcosim, initialized with the ship's `first` state."""
    if host == "libcosim":
        return CosimSlave(fmu, SHIP, LOAD + list(record), h, parameters, first)
    return FmpySlave(fmu, SHIP, LOAD + list(record), parameters, first)


def couple(fmu, vessel, h, steps, parameters, record=(), host="fmpy", excitation=None, two_way=True):
    """Runs both from the vessel's present state, for which `equilibrium` cares.

    `excitation`: function of time that gives six loads. With `two_way` false the vessel does not feel the cable's changes, only what it bore at the
    start. Returns series by name: time, pose [.][6], rate [.][6], load [.][6], work_vessel and work_cable (J) done by the cable on the
    ship as the vessel and as the FMU see it, and each of `record`.
    """
    start = vessel.state()
    excitation = excitation or (lambda _: np.zeros(6))
    with FmpySlave(fmu, SHIP, LOAD + list(record), parameters, start) as calm:
        # libcosim shows no outputs before its first step; they are the same.
        out = calm.get()
    first = load(out, vessel.pose)
    series = {name: [] for name in ("time", "pose", "rate", "load", "work_vessel", "work_cable", *record)}
    work_vessel = work_cable = 0.0
    vessel.accelerate(first + excitation(0.0))
    with slave(host, fmu, record, parameters, start, h) as cable:
        for k in range(steps + 1):
            now = load(out, vessel.pose) if two_way else first
            row = (k * h, vessel.pose, vessel.rate, now, work_vessel, work_cable, *out[6:])
            for name, value in zip(series, row):
                series[name].append(value)
            if k == steps:
                break
            before = vessel.pose, vessel.rate
            out = cable.step(k * h, h, vessel.state())
            # The moment at t + h is turned by the angles known by now; it is turned anew for the next row, which changes it by h³.
            then = load(out, vessel.pose + h * vessel.rate + 0.5 * h * h * vessel.acceleration) if two_way else first
            vessel.step(h, then + excitation((k + 1) * h))
            # The vessel: mean load times way, which is exactly what its energy gains. The cable: power at the communication points, where its own
            # ship moves as it was told; trapezoidal rule.
            work_vessel += 0.5 * (now + then) @ (vessel.pose - before[0])
            work_cable += 0.5 * h * (now @ before[1] + then @ vessel.rate)
    return {name: np.array(values) for name, values in series.items()}
