"""Derivatives through the C interface: of inputs, of outputs by time, of outputs by the inputs of a step."""

import ctypes
import math

import pytest
from fmpy.fmi2 import fmi2Integer, fmi2Real, fmi2ValueReference

H = 0.01
SHIP = ["ship.x", "ship.y", "ship.z", "ship.roll", "ship.pitch", "ship.yaw"]
TENSIONS = ["winch.tension", "body.tension", "cable.tension_max"]
POSITIONS = ["body.x", "body.y", "body.z", "winch.angle"]


def sea(t):
    """A gentle motion of the flume's ship: pose, rates and accelerations."""
    found = {}
    rates = ["ship.vx", "ship.vy", "ship.vz", "ship.roll_rate", "ship.pitch_rate", "ship.yaw_rate"]
    accelerations = ["ship.ax", "ship.ay", "ship.az", "ship.roll_acceleration", "ship.pitch_acceleration", "ship.yaw_acceleration"]
    for k, (x, v, a) in enumerate(zip(SHIP, rates, accelerations)):
        w, size = 2.0 + 0.3 * k, 0.004
        found |= {x: size * math.sin(w * t), v: size * w * math.cos(w * t), a: -size * w * w * math.sin(w * t)}
    return found


def sailed(fmu, steps, tolerance=1e-7):
    instance = fmu.started(inputs=sea(0.0), parameters={"solver.tolerance": tolerance})
    for k in range(steps):
        instance.set(sea(k * H))
        instance.step(k * H, H)
    return instance


def references(fmu, names):
    return (fmi2ValueReference * len(names))(*[fmu.variables[name].valueReference for name in names])


def rates(fmu, instance, names, order=1):
    values = (fmi2Real * len(names))()
    orders = (fmi2Integer * len(names))(*[order] * len(names))
    call = instance.slave.dll.fmi2GetRealOutputDerivatives
    status = call(ctypes.c_void_p(instance.component), references(fmu, names), ctypes.c_size_t(len(names)), orders, values)
    return status, dict(zip(names, values))


def along(fmu, instance, outputs, seeds):
    values, seed = (fmi2Real * len(outputs))(), (fmi2Real * len(seeds))(*seeds.values())
    status = instance.slave.dll.fmi2GetDirectionalDerivative(
        ctypes.c_void_p(instance.component),
        references(fmu, outputs),
        ctypes.c_size_t(len(outputs)),
        references(fmu, list(seeds)),
        ctypes.c_size_t(len(seeds)),
        seed,
        values,
    )
    return status, dict(zip(outputs, values))


def test_exact_output_derivatives_are_the_slopes_of_the_outputs(fmus):
    """Positions against the velocity outputs (rounding of the differences, 1e-8); tensions against differences over half a
    millisecond of a fine run: 2 % of the greatest, since they smooth the cable's own waves of some milliseconds (over 2 ms by a fifth), and four
    times what the solver's tolerance of 1e-9 of the tension leaves of a difference over a step."""
    fmu = fmus["flume"]
    instance = sailed(fmu, 30)
    status, found = rates(fmu, instance, TENSIONS + POSITIONS + ["ship.force.x"])
    assert status == 0
    for position, velocity in zip(POSITIONS, ["body.vx", "body.vy", "body.vz", "winch.rate"]):
        assert found[position] == pytest.approx(instance[velocity], rel=1e-7, abs=1e-8)
    # The same motion again in fine steps; the last step of 10 ms before has the inputs of its own begin.
    fine, h, end = fmu.started(inputs=sea(0.0), parameters={"solver.tolerance": 1e-9}), 2.5e-4, 1200
    kept = {}
    for k in range(end + 1):
        fine.set(sea(k * h))
        fine.step(k * h, h)
        kept[k + 1] = fine.get(TENSIONS)
        if k + 1 == end:
            _, slopes = rates(fmu, fine, TENSIONS)
    differences = {name: (kept[end + 1][name] - kept[end - 1][name]) / (2 * h) for name in TENSIONS}
    size = max(map(abs, differences.values()))
    tolerable = 0.02 * size + 4e-9 * max(kept[end].values()) / h
    for name in TENSIONS:
        assert abs(slopes[name] - differences[name]) < tolerable, name


def test_exact_an_output_without_derivatives_is_refused_by_name(fmus):
    fmu = fmus["flume"]
    instance = sailed(fmu, 1)
    for name, order, words in [("solver.energy_error", 1, "no derivatives"), ("winch.tension", 2, "expected 1"), ("ship.x", 1, "no output")]:
        assert rates(fmu, instance, [name], order)[0] == 3
        assert name in instance.messages[-1][2] and words in instance.messages[-1][2]


@pytest.mark.parametrize("seeds", [{"ship.z": 1.0}, {"ship.ax": 1.0}, {"ship.x": 0.3, "ship.vz": 2.0}, {"winch.setpoint": 1.0}, {"current.x": 1.0}])
@pytest.mark.parametrize("name", ["flume", "ned"])
def test_exact_directional_derivatives_match_differences_of_the_step(fmus, name, seeds):
    """The step is done again with the inputs a little changed: 1 % of the greatest, as documented. The tolerance is tight, since a change of
    the input changes the sub-steps too: their error is 5 % of these differences at 1e-7."""
    fmu = fmus[name]
    instance = sailed(fmu, 20, 1e-9)
    # Small beside what bends the drag, large beside the tolerance; a jump of the pose by 1e-5 m is one of 1e-3 m/s.
    t, change = 20 * H, 1e-5 if seeds.keys() & set(SHIP) else 1e-4
    begin, inputs = instance.slave.getFMUState(), sea(20 * H) | {"winch.setpoint": instance["winch.setpoint"], "current.x": 0.0}

    def stepped(s):
        instance.slave.setFMUState(begin)
        instance.set({key: value + s * seeds.get(key, 0.0) for key, value in inputs.items()})
        instance.step(t, H)
        return instance.get(TENSIONS + POSITIONS)

    above, below = stepped(change), stepped(-change)
    stepped(0.0)
    status, found = along(fmu, instance, TENSIONS + POSITIONS, seeds)
    assert status == 0
    for group in (TENSIONS, POSITIONS):
        differences = {key: (above[key] - below[key]) / (2 * change) for key in group}
        tolerable = 0.01 * max(map(abs, differences.values()))
        for key in group:
            assert abs(found[key] - differences[key]) < tolerable, (key, found[key], differences[key])
    instance.slave.freeFMUState(begin)


def test_exact_asking_for_derivatives_changes_nothing(fmus):
    fmu = fmus["flume"]
    asked, plain = sailed(fmu, 5), sailed(fmu, 5)
    assert rates(fmu, asked, TENSIONS)[0] == 0 and along(fmu, asked, TENSIONS, {"ship.x": 1.0})[0] == 0
    for instance in (asked, plain):
        instance.set(sea(5 * H))
        instance.step(5 * H, H)
    names = fmu.names("output")
    assert asked.get(names) == plain.get(names)


def test_exact_a_directional_derivative_needs_a_step(fmus):
    fmu = fmus["flume"]
    instance = fmu.started()
    assert along(fmu, instance, TENSIONS, {"ship.x": 1.0})[0] == 3
    assert "after a step" in instance.messages[-1][2]
