"""fmi2FMUstate: rollback to the bit, across instances, as bytes."""

import ctypes

import motion
import pytest
from host import ERROR, OK, bits, status

SCENES = ["flume", "no_ship", "anchor", "vacuum", "ned", "pose", "pose_velocity", "payout", "body_force", "tangent", "thesis", "bare"]
H = 0.02


def inputs(fmu):
    """Ship motion, a winch that turns, a current that changes and a force, as far as the scene has them."""
    ship = motion.inputs(motion.wave, fmu)
    have = set(fmu.names("input"))

    def at(t):
        values = ship(t)
        if "winch.setpoint" in have:
            values["winch.setpoint"] = float(fmu.variables["winch.setpoint"].start) + 0.5 * t
            values["winch.setpoint_rate"] = 0.5
        if "current.x" in have:
            values["current.x"] = 0.1 * t
        if "body.force.z" in have:
            values["body.force.z"] = 0.01 * t
        return values

    return at


def run(instance, steps, first):
    return [bits(row) for row in instance.run(steps, H, inputs(instance.fmu), first=first)]


@pytest.mark.parametrize("name", SCENES)
def test_exact_rollback_is_bit_identical(fmus, name):
    fmu = fmus[name]
    with fmu.started() as straight:
        expected = run(straight, 16, 0)
    with fmu.started() as i:
        assert run(i, 6, 0) == expected[:6], "two instances differ"
        point = i.slave.getFMUstate()
        before = bits(i.everything())
        for length in (10, 3, 1):
            assert run(i, length, 6) == expected[6 : 6 + length]
            i.slave.setFMUstate(point)
            assert bits(i.everything()) == before
        # Steps of other sizes in between leave nothing behind.
        i.step(6 * H, 0.37 * H)
        i.slave.setFMUstate(point)
        assert run(i, 10, 6) == expected[6:]
        i.slave.terminate()
        i.slave.setFMUstate(point)
        assert run(i, 10, 6) == expected[6:]
        i.slave.freeFMUstate(point)
        assert point.value is None


@pytest.mark.parametrize("name", SCENES)
def test_exact_bytes_go_to_other_instances(fmus, name):
    fmu = fmus[name]
    with fmu.started() as a, fmu.instance() as fresh, fmu.started() as busy:
        run(a, 5, 0)
        state = a.slave.getFMUstate()
        text = a.slave.serializeFMUstate(state)
        assert a.slave.serializeFMUstate(state) == text
        expected = run(a, 5, 5)
        busy.run(3, 0.01)
        for b in (fresh, busy):
            read = b.slave.deSerializeFMUstate(text)
            b.slave.setFMUstate(read)
            assert run(b, 5, 5) == expected
            b.slave.freeFMUstate(read)
        a.slave.freeFMUstate(state)


def test_exact_a_state_survives_its_instance(flume):
    with flume.started() as a:
        run(a, 3, 0)
        state = a.slave.getFMUstate()
        expected = run(a, 3, 3)
    with flume.instance() as b:
        b.slave.setFMUstate(state)
        assert run(b, 3, 3) == expected
        b.slave.freeFMUstate(state)


def test_exact_a_handle_may_be_used_again(flume):
    with flume.started() as i:
        state = i.slave.getFMUstate()
        first = state.value
        run(i, 2, 0)
        assert i.slave.fmi2GetFMUstate(i.slave.component, ctypes.byref(state)) == OK
        assert state.value == first
        expected = run(i, 3, 2)
        i.slave.setFMUstate(state)
        assert run(i, 3, 2) == expected
        i.slave.freeFMUstate(state)
        i.slave.freeFMUstate(state)  # NULL by now, and harmless


def test_exact_a_state_carries_parameters_and_tuning(flume):
    with flume.started(parameters={"body.mass": 2e-3, "cable.EA": 150.0}) as a, flume.started() as b:
        run(a, 3, 0)
        a.set({"fluid.drag.amplification": 1.2})
        state = a.slave.getFMUstate()
        expected = run(a, 5, 3)
        b.slave.setFMUstate(state)
        assert b.get(["body.mass", "cable.EA", "fluid.drag.amplification"]) == {
            "body.mass": 2e-3, "cable.EA": 150.0, "fluid.drag.amplification": 1.2,
        }
        assert run(b, 5, 3) == expected
        a.slave.freeFMUstate(state)


def test_exact_input_derivatives_are_part_of_the_state(fmus):
    with fmus["pose"].started() as i:
        run(i, 3, 0)
        i.derivatives(1, {"ship.x": 0.1, "ship.roll": -0.2})
        state = i.slave.getFMUstate()
        expected = run(i, 3, 3)
        i.slave.setFMUstate(state)
        assert run(i, 3, 3) == expected
        i.slave.freeFMUstate(state)


def test_exact_foreign_and_broken_bytes_are_refused(flume, fmus):
    """Every shortening, flips of single bytes all over, another FMU's state, noise: fmi2Error, and the instance is as it was."""
    with flume.started() as i, fmus["anchor"].started() as other:
        run(i, 2, 0)
        state = i.slave.getFMUstate()
        good = i.slave.serializeFMUstate(state)
        foreign = other.slave.getFMUstate()
        before = bits(i.everything())
        bad = [good[:n] for n in (0, 1, 7, 8, len(good) // 2, len(good) - 1)] + [good + b"\0", b"noise" * 100]
        bad += [good[:n] + bytes([good[n] ^ 1]) + good[n + 1 :] for n in range(0, len(good), max(1, len(good) // 200))]
        bad.append(other.slave.serializeFMUstate(foreign))
        for text in bad:
            assert status(i.slave.deSerializeFMUstate, text) == ERROR
        assert status(i.slave.setFMUstate, foreign) == ERROR
        assert status(i.slave.setFMUstate, None) == ERROR
        assert bits(i.everything()) == before
        short = ctypes.create_string_buffer(len(good) - 1)
        assert status(i.slave.fmi2SerializeFMUstate, i.slave.component, state, short, len(short)) == ERROR
        i.slave.setFMUstate(state)
        i.slave.freeFMUstate(state)
        other.slave.freeFMUstate(foreign)
