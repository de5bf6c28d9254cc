"""Reading and setting variables: always possible where it should be, refused with a reason where not."""

import ctypes
import math

import motion
import pytest
import scenes
from fmpy.fmi2 import fmi2Real, fmi2ValueReference
from host import DISCARD, ERROR, OK, bits, finite, status

ALL = scenes.BUILT_IN + [change.__name__ for change in scenes.VARIANTS]


def sail(instance, steps=6, first=0):
    return [bits(row) for row in instance.run(steps, 0.02, motion.inputs(motion.wave, instance.fmu), first=first)]


@pytest.mark.parametrize("name", ALL)
def test_exact_every_variable_can_be_read_in_every_phase_and_is_finite(fmus, name):
    fmu = fmus[name]
    with fmu.instance() as i:
        assert finite(i.everything())
        i.slave.setupExperiment()
        i.slave.enterInitializationMode()
        first = i.everything()
        assert finite(first)
        assert bits(i.everything()) == bits(first)
        i.slave.exitInitializationMode()
        # Nothing was set in between, so looking early shows the start state.
        assert bits(i.everything()) == bits(first)
        sail(i, 5)
        last = i.everything()
        assert finite(last)
        assert last["status.code"] == 0 and last["status.message"] == b""
        assert last["solver.steps"] >= 5
        i.slave.terminate()
        assert bits(i.everything()) == bits(last)


@pytest.mark.parametrize("name", ["flume", "anchor", "pose"])
def test_exact_looking_during_initialization_changes_nothing(fmus, name):
    """libcosim reads everything in initialization mode, many times."""
    ship = {"ship.x": 0.003, "ship.roll": 0.05}
    with fmus[name].instance() as curious, fmus[name].instance() as plain:
        for i in (curious, plain):
            i.slave.setupExperiment()
            i.slave.enterInitializationMode()
        for _ in range(3):
            curious.everything()
            curious.set({"ship.x": 0.5})
        curious.everything()
        for i in (curious, plain):
            i.set(ship)
        curious.everything()
        for i in (curious, plain):
            i.slave.exitInitializationMode()
        assert sail(curious) == sail(plain)


def test_exact_outputs_are_those_of_the_last_communication_point(flume):
    """Reading after setting without a step in between is answered with what was there."""
    with flume.started() as i:
        sail(i, 2)
        outputs = flume.names("output")
        before = bits(i.get(outputs))
        i.set({"ship.z": 0.2, "current.x": 0.3, "winch.setpoint": 1.0})
        assert bits(i.get(outputs)) == before


@pytest.mark.parametrize("name", ["flume", "thesis", "anchor"])
def test_exact_setting_every_parameter_to_its_own_value_changes_nothing(fmus, name):
    fmu = fmus[name]
    with fmu.instance() as i, fmu.started() as plain:
        i.set(i.get(fmu.names("parameter")))
        i.start()
        assert sail(i) == sail(plain)


@pytest.mark.parametrize("name", ["flume", "thesis", "anchor"])
def test_exact_every_parameter_does_something_or_says_why_not(fmus, name):
    """A thousandth more of each Real parameter, alone: the run changes, or the start is refused by name."""
    fmu = fmus[name]
    turn = {"winch.setpoint": 1.0} if name != "anchor" else {}
    with fmu.started() as plain:
        plain.set(turn)
        expected = sail(plain, 12)
    without_effect = []
    for parameter in fmu.names("parameter", "Real"):
        start = float(fmu.variables[parameter].start)
        with fmu.instance() as i:
            i.set({parameter: start * 1.001 + (1e-3 if start == 0.0 else 0.0)})
            if status(i.start) != OK:
                stem = parameter.split("[")[0]
                assert stem in i.texts() or "cable.length" in i.texts(), f"{parameter}: {i.texts()}"
                continue
            i.set(turn)
            rows = sail(i, 12)
            assert finite(i.everything())
            if rows == expected:
                without_effect.append(parameter)
    # Bounds that are not reached; the length of a direction; the viscosity where no coefficient depends on the Reynolds number.
    idle = {"solver.step_max", "solver.step_min", "winch.axis[2]", "fluid.viscosity"}
    assert set(without_effect) <= idle


def test_exact_stiffness_set_before_the_start_changes_the_stretch(fmus):
    """Hanging in air, the far end's stretch below the anchor is the weight integrated over EA."""
    fmu = fmus["bare"]
    s = scenes.tree("bare")
    length, mass, line = s["cable"]["length"], s["body"]["mass"], s["cable"]["mass_per_length"]
    for stiffness in (20.0, 200.0):
        with fmu.started(parameters={"cable.EA": stiffness}) as i:
            stretch = -i["body.z"] - length
            expected = s["gravity"] * length * (mass + line * length / 2) / stiffness
            # Positions are O(1) m doubles and the equilibrium is solved to 1e-9 of the weight.
            assert stretch == pytest.approx(expected, rel=1e-6)


def test_exact_tunable_parameters_act_in_mid_run(flume):
    tunable = [n for n in flume.names("parameter") if flume.variables[n].variability == "tunable"]
    assert {"fluid.drag.amplification", "winch.gain_position", "winch.gain_rate", "solver.tolerance"} <= set(tunable)
    with flume.started() as plain:
        expected = sail(plain, 8)
    for name in ("fluid.drag.amplification", "winch.gain_position", "solver.tolerance"):
        with flume.started() as i:
            turn = {"winch.setpoint": 1.0}
            i.set(turn)
            head = sail(i, 4)
            i.set({name: 0.5 * i[name]})
            tail = sail(i, 4, first=4)
        with flume.started() as still:
            still.set(turn)
            assert sail(still, 4) == head
            assert sail(still, 4, first=4) != tail, name
    with flume.started() as i:
        i.set({"fluid.drag.amplification": 2.5})
        i.set({"fluid.drag.amplification": float(flume.variables["fluid.drag.amplification"].start)})
        assert sail(i, 8) == expected


def test_exact_tuning_before_and_after_the_start_comes_to_the_same(flume):
    """A parameter that the start state does not depend on: the drum's gains."""
    gains = {"winch.gain_position": 50.0, "winch.gain_rate": 10.0}
    turn = {"winch.setpoint": 1.0, "winch.setpoint_rate": 0.1}
    runs = []
    for early in (True, False):
        with flume.started(parameters=gains if early else {}) as i:
            i.set(turn if early else gains | turn)
            runs.append(sail(i, 6))
    assert runs[0] == runs[1]


def test_exact_fixed_parameters_are_refused_in_mid_run_by_name(flume):
    with flume.started() as plain:
        expected = sail(plain, 8)
    with flume.started() as i:
        rows = sail(i, 4)
        for name in flume.names("parameter"):
            if flume.variables[name].variability == "fixed":
                i.messages.clear()
                assert status(i.set, {name: i[name]}) == ERROR, name
                assert f"{name} " in i.texts() and "fixed" in i.texts()
        for name in flume.names("output"):
            i.messages.clear()
            assert status(i.set, {name: i[name] if flume.variables[name].type != "String" else "x"}) == ERROR, name
            assert name in i.texts() and "output" in i.texts()
        assert rows + sail(i, 4, first=4) == expected


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_exact_numbers_that_are_none_are_refused_and_not_kept(flume, value):
    with flume.started() as plain:
        expected = sail(plain, 8)
    with flume.started() as i:
        rows = sail(i, 4)
        for name in flume.names("input") + ["fluid.drag.amplification"]:
            before = i[name]
            i.messages.clear()
            assert status(i.set, {name: value}) in (DISCARD, ERROR)
            assert name in i.texts() and "finite" in i.texts()
            assert i[name] == before
        # One bad value among good ones: none is taken.
        before = bits(i.everything())
        assert status(i.set, {"ship.x": 1.0, "ship.y": value}) in (DISCARD, ERROR)
        assert status(i.derivatives, 1, {"ship.x": 1.0, "ship.y": value}) in (DISCARD, ERROR)
        assert bits(i.everything()) == before
        assert rows + sail(i, 4, first=4) == expected


@pytest.mark.parametrize("value", [1e300, -1e150, 1e30])
def test_exact_absurd_inputs_harm_nobody(flume, value):
    """Whatever becomes of the step, nothing crashes, nothing that is no number comes out, and a reset makes all well."""
    with flume.started() as plain:
        expected = sail(plain, 4)
    for name in ("ship.x", "ship.roll", "ship.az", "winch.setpoint", "current.x"):
        with flume.started() as i:
            sail(i, 2)
            before = i.everything()
            if status(i.set, {name: value}) == OK:
                status(i.step, 0.04, 0.02)
            assert finite(i.everything()), name
            i.set({name: before[name]})
            status(i.step, 0.04, 0.02)
            assert finite(i.everything()), name
            i.slave.reset()
            i.start()
            assert sail(i, 4) == expected, name


def test_exact_unknown_references_are_refused_and_nothing_is_written(flume):
    with flume.started() as i:
        x = flume.variables["ship.x"].valueReference
        references = (fmi2ValueReference * 2)(x, 0xFFFFFFFF)
        values = (fmi2Real * 2)(0.25, 0.5)
        c = i.slave.component
        before = i["ship.x"]
        assert status(i.slave.fmi2SetReal, c, references, 2, values) == ERROR
        assert "4294967295" in i.texts()
        assert i["ship.x"] == before
        assert status(i.slave.fmi2GetReal, c, references, 2, values) == ERROR
        assert list(values) == [0.25, 0.5]
        # NULL where there should be an array.
        assert status(i.slave.fmi2GetReal, c, None, 1, values) == ERROR
        assert status(i.slave.fmi2GetReal, c, references, 1, None) == ERROR
        # A Real's reference is no Integer's.
        assert status(i.slave.getInteger, [x]) == ERROR


def test_exact_wrong_parameters_are_named_at_the_start_and_can_be_put_right(flume):
    for bad, words in [
        ({"body.mass": -1.0}, ["body.mass", "-1", "> 0", "kg"]),
        ({"cable.diameter": 0.0}, ["cable.diameter", "> 0"]),
        ({"cable.length": 2.0}, ["mesh.regions", "cable.length"]),
        ({"solver.tolerance": -1e-3}, ["solver.tolerance"]),
        ({"body.mass": -1.0, "gravity": -9.0}, ["body.mass", "gravity"]),
    ]:
        with flume.instance() as i:
            i.set(bad)
            assert status(i.start) == ERROR
            assert all(word in i.texts() for word in words), i.texts()
            assert status(i.step, 0.0, 0.01) == ERROR
            i.slave.reset()
            i.start()
            assert len(sail(i, 2)) == 2


def test_exact_a_wrong_tuning_is_refused_and_put_right(flume):
    with flume.started() as plain:
        expected = sail(plain, 8)
    with flume.started() as i:
        rows = sail(i, 4)
        good = i["fluid.drag.amplification"]
        i.messages.clear()
        outcome = status(i.set, {"fluid.drag.amplification": -1.0})
        if outcome == OK:
            outcome = status(i.step, 0.08, 0.02)
        assert outcome in (DISCARD, ERROR)
        assert "fluid.drag.amplification" in i.texts()
        i.set({"fluid.drag.amplification": good})
        assert rows + sail(i, 4, first=4) == expected


def test_exact_strings_stay_good_until_read_again(flume):
    with flume.started() as i:
        reference = (fmi2ValueReference * 1)(flume.variables["status.message"].valueReference)
        text = (ctypes.c_char_p * 1)()
        i.slave.fmi2GetString(i.slave.component, reference, 1, text)
        sail(i, 3)
        i.everything()
        assert text[0] == b""
