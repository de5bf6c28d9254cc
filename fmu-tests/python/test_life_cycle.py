"""The life of an instance under hosts that do not follow the rules."""

import ctypes
import math
import threading
from ctypes import byref, c_void_p

import fmpy
import motion
import numpy as np
import pytest
from fmpy import fmi2
from fmpy.fmi2 import fmi2FMUstate, fmi2Integer, fmi2Real, fmi2Status, fmi2String
from host import DISCARD, ERROR, OK, WARNING, Instance, bits, finite, status

NONE = c_void_p(None)


def calls(slave):
    """One call of every function that takes an instance with the phases that allow it, harmless where allowed: I(nstantiated),
    (i)N(itialization), S(tepping), T(erminated); `!` marks calls that change the phase, tried only where they are refused."""
    c = slave.component
    real, integer, text, state, size = fmi2Real(), fmi2Integer(), fmi2String(), fmi2FMUstate(), ctypes.c_size_t()
    keep = [real, integer, text, state, size]
    return keep, {
        "fmi2SetDebugLogging": ("INST", lambda f: f(c, 1, 0, None)),
        "fmi2SetupExperiment": ("I", lambda f: f(c, 0, 0.0, 0.0, 0, 0.0)),
        "fmi2EnterInitializationMode": ("I!", lambda f: f(c)),
        "fmi2ExitInitializationMode": ("N!", lambda f: f(c)),
        "fmi2Terminate": ("S!", lambda f: f(c)),
        "fmi2GetReal": ("INST", lambda f: f(c, None, 0, None)),
        "fmi2GetInteger": ("INST", lambda f: f(c, None, 0, None)),
        "fmi2GetBoolean": ("INST", lambda f: f(c, None, 0, None)),
        "fmi2GetString": ("INST", lambda f: f(c, None, 0, None)),
        "fmi2SetReal": ("INS", lambda f: f(c, None, 0, None)),
        "fmi2SetInteger": ("INS", lambda f: f(c, None, 0, None)),
        "fmi2SetBoolean": ("INS", lambda f: f(c, None, 0, None)),
        "fmi2SetString": ("INS", lambda f: f(c, None, 0, None)),
        "fmi2SetRealInputDerivatives": ("INS", lambda f: f(c, None, 0, None, None)),
        "fmi2GetRealOutputDerivatives": ("ST", lambda f: f(c, None, 0, None, None)),
        "fmi2GetDirectionalDerivative": ("NST", lambda f: f(c, None, 0, None, 0, None, None)),
        "fmi2SetFMUstate": ("", lambda f: f(c, None)),
        "fmi2SerializedFMUstateSize": ("", lambda f: f(c, None, byref(size))),
        "fmi2SerializeFMUstate": ("", lambda f: f(c, None, None, 0)),
        "fmi2DeSerializeFMUstate": ("", lambda f: f(c, None, 0, byref(state))),
        "fmi2DoStep": ("S!", lambda f: f(c, 0.0, 0.01, 1)),
        "fmi2CancelStep": ("", lambda f: f(c)),
        "fmi2GetRealStatus": ("ST", lambda f: f(c, fmi2.fmi2LastSuccessfulTime, byref(real))),
        "fmi2GetBooleanStatus": ("ST", lambda f: f(c, fmi2.fmi2Terminated, byref(integer))),
    }


ARRIVE = {
    "I": lambda i: None,
    "N": lambda i: (i.slave.setupExperiment(), i.slave.enterInitializationMode()),
    "S": lambda i: i.start(),
    "T": lambda i: (i.start(), i.slave.terminate()),
}


def sail(instance, steps=6):
    return [bits(row) for row in instance.run(steps, 0.02, motion.inputs(motion.wave, instance.fmu))]


@pytest.fixture(scope="module")
def untouched(flume):
    """A run that nobody disturbed."""
    with flume.started() as instance:
        return sail(instance)


@pytest.mark.parametrize("phase", ARRIVE)
def test_exact_wrong_order_is_refused_and_changes_nothing(flume, untouched, phase):
    with flume.instance() as i:
        ARRIVE[phase](i)
        _, table = calls(i.slave)
        before = bits(i.everything())
        for name, (allowed, call) in table.items():
            i.messages.clear()
            if phase not in allowed:
                assert status(call, getattr(i.slave, name)) == ERROR, f"{name} in {phase}"
                assert i.messages and name in i.texts(), f"{name} in {phase} says nothing"
                assert bits(i.everything()) == before, f"{name} in {phase} changed something"
            elif not allowed.endswith("!"):
                assert status(call, getattr(i.slave, name)) == OK, f"{name} in {phase}: {i.texts()}"
        # As good as new after all that.
        if phase == "T":
            i.slave.reset()
        if phase in "IT":
            i.start()
        elif phase == "N":
            i.slave.exitInitializationMode()
        assert sail(i) == untouched


def test_exact_all_sequences_of_three_calls_leave_a_working_process(fmus):
    """Every word of three phase-changing calls, right or wrong, ends in an instance that can be reset and used."""
    fmu = fmus["bare"]
    letters = {
        "setup": lambda i: i.slave.setupExperiment(),
        "enter": lambda i: i.slave.enterInitializationMode(),
        "exit": lambda i: i.slave.exitInitializationMode(),
        "step": lambda i: i.step(0.0, 0.02),
        "terminate": lambda i: i.slave.terminate(),
        "reset": lambda i: i.slave.reset(),
    }
    # The words that a host may say, with what may follow.
    right = {"I": {"setup": "I", "enter": "N", "reset": "I"}, "N": {"exit": "S", "reset": "I"}, "T": {"reset": "I"},
             "S": {"step": "s", "terminate": "T", "reset": "I"}}
    right["s"] = right["S"]
    for word in [(a, b, c) for a in letters for b in letters for c in letters]:
        with fmu.instance() as i:
            phase = "I"
            for letter in word:
                # A second step from t = 0 is no step from the present time.
                expected = OK if letter in right[phase] and not (phase == "s" and letter == "step") else ERROR
                assert status(letters[letter], i) == expected, f"{letter} of {word}: {i.texts()}"
                phase = right[phase][letter] if expected == OK else phase
            i.slave.reset()
            assert status(i.start) == OK and status(i.step, 0.0, 0.02) == OK, word


def test_exact_null_is_no_instance(flume):
    slave = flume.slave()
    slave.component = None
    keep, table = calls(slave)
    for name, (_, call) in table.items():
        assert status(call, getattr(slave, name)) == ERROR, name
    slave.fmi2FreeInstance(None)
    slave.fmi2FreeInstance(NONE)


def instantiate(fmu, name=b"x", kind=fmi2.fmi2CoSimulation, guid=None, location=None, logger=True):
    """fmi2Instantiate as it is, with what it logged."""
    messages = []

    @fmi2.fmi2CallbackLoggerTYPE
    def log(_environment, _instance, level, category, message):
        messages.append((level, category.decode(), message.decode()))

    callbacks = fmi2.fmi2CallbackFunctions()
    if logger:
        callbacks.logger = log
    slave = fmu.slave()
    slave.keep = log
    guid = fmu.guid.encode() if guid is None else guid
    location = fmu.location.encode() if location is None else location
    slave.component = slave.fmi2Instantiate(name, kind, guid, location or None, byref(callbacks), 0, 0)
    return slave, messages


@pytest.mark.parametrize(
    "request_, words",
    [
        ({"guid": b"{00000000-0000-0000-0000-000000000000}"}, ["GUID", "{00000000"]),
        ({"guid": b""}, ["GUID"]),
        ({"kind": fmi2.fmi2ModelExchange}, ["fmi2CoSimulation"]),
        ({"name": b""}, ["name"]),
        ({"location": b"file:///no/such/folder"}, ["/no/such/folder", "scene.toml"]),
        ({"location": b"http://x/y"}, ["http://x/y", "file:"]),
    ],
)
def test_exact_a_wrong_request_gives_null_and_the_reason(flume, request_, words):
    for logger in (True, False):
        slave, messages = instantiate(flume, logger=logger, **request_)
        assert not slave.component
        assert bool(messages) == logger
    _, messages = instantiate(flume, **request_)
    assert all(level == ERROR and category == "logStatusError" for level, category, _ in messages)
    assert all(word in " ".join(text for _, _, text in messages) for word in words), messages


def test_exact_without_resources_the_library_simulates_the_default_scene(flume, fmus, untouched):
    slave, messages = instantiate(flume, location=b"")
    assert slave.component, messages
    with Instance.__new__(Instance) as i:
        i.fmu, i.slave, i.component, i.messages = flume, slave, slave.component, messages
        i.start()
        assert sail(i) == untouched
    # Another FMU's description does not fit the default scene.
    slave, messages = instantiate(fmus["anchor"], location=b"")
    assert not slave.component and "GUID" in messages[0][2]


@pytest.mark.parametrize("form", ["file://{}", "file:{}", "file://localhost{}", "file:///{}", "file://{}/", "FILE://{}", "{}"])
def test_exact_resource_locations_as_importers_write_them(flume, form, awkward):
    raw = awkward / "resources"
    raw.symlink_to(flume.folder / "resources")
    encoded = raw.as_uri().removeprefix("file://")
    for path in [str(raw)] + [encoded] * form.upper().startswith("FILE"):
        slave, messages = instantiate(flume, location=form.format(path).encode())
        assert slave.component, (form, messages)
        slave.fmi2FreeInstance(slave.component)


def test_exact_simulating_from_a_folder_with_spaces_and_umlauts(flume, awkward, monkeypatch):
    """fmpy unpacks into the temporary folder, so both the archive and the resources lie in an awkward place."""
    monkeypatch.setattr("tempfile.tempdir", str(awkward))
    path = awkward / "ein Flume ß.fmu"
    path.write_bytes(flume.path.read_bytes())
    result = fmpy.simulate_fmu(str(path), stop_time=0.5, output=["winch.tension", "body.x", "body.z", "status.code"])
    assert len(result) > 10
    assert all(np.isfinite(result[name]).all() for name in result.dtype.names)
    assert (result["status.code"] == 0).all()
    # fmpy's own way through the FMU is the one of the other tests.
    with flume.started() as i:
        i.run(50, 0.01)
        # Steps of 0.01 s and of fmpy's output interval end at the same time but differ in their sub-steps: solver.tolerance = 1e-3.
        assert result["winch.tension"][-1] == pytest.approx(i["winch.tension"], rel=1e-3)


def test_exact_communication_points_must_fit(flume, untouched):
    with flume.started() as i:
        i.run(2, 0.02, motion.inputs(motion.wave, flume))
        before = bits(i.everything())
        now = 0.04
        for time, h in [
            (now, 0.0), (now, -0.01), (now, math.nan), (now, math.inf), (now, -math.inf), (math.nan, 0.02), (math.inf, 0.02),
            (0.0, 0.02), (0.06, 0.02), (now, 1e-300), (1e300, 0.02),
        ]:
            i.messages.clear()
            assert status(i.step, time, h) == ERROR, (time, h)
            assert "fmi2DoStep" in i.texts()
            assert bits(i.everything()) == before
        inputs = motion.inputs(motion.wave, flume)
        assert [bits(row) for row in i.run(4, 0.02, inputs, first=2)] == untouched[2:]


def test_exact_a_stop_time_holds_with_tolerance(flume):
    with flume.instance() as i:
        i.start(stop=0.1)
        for k in range(10):
            i.step(k * 0.01, 0.01)  # 10 * 0.01 is a little more than 0.1 as many hosts add it up
        assert status(i.step, 0.1, 0.01) == ERROR
        assert "stop time" in i.texts()
        i.slave.terminate()


def test_exact_sums_of_steps_do_not_drift(flume):
    """Hosts add their steps up; a thousand additions later both still mean the same time."""
    with flume.started(time=-0.3) as i:
        time = -0.3
        for _ in range(1000):
            i.step(time, 0.001)
            time += 0.001
        assert i.slave.getRealStatus(fmi2.fmi2LastSuccessfulTime) == pytest.approx(time, abs=1e-12)


def test_exact_a_step_that_fails_is_discarded_and_the_run_goes_on(flume):
    """One sub-step is never enough for a second; a step as short as a sub-step goes through."""
    with flume.started(parameters={"solver.steps_max": 1}) as i:
        i.set({"current.x": 0.2})
        before = i.everything()
        assert status(i.step, 0.0, 1.0) == DISCARD
        text = i.texts()
        assert "t = " in text and "m along the cable" in text and "Try" in text, text
        value = fmi2Real()
        assert i.slave.fmi2GetRealStatus(i.slave.component, fmi2.fmi2LastSuccessfulTime, byref(value)) == OK
        assert value.value == 0.0
        assert i.slave.getBooleanStatus(fmi2.fmi2Terminated) is False
        assert status(i.slave.getStringStatus, fmi2.fmi2PendingStatus) == DISCARD
        after = i.everything()
        assert after["status.code"] == 2 and after["status.message"]
        assert finite(after)
        # The outputs are those of the last good state.
        kept = [n for n in i.fmu.names("output") if not n.startswith(("status.", "solver."))]
        assert bits({n: before[n] for n in kept}) == bits({n: after[n] for n in kept})
        assert status(i.step, 0.0, 1e-6) in (OK, WARNING)
        assert i["status.code"] < 2


def test_exact_nothing_is_called_back_and_nothing_printed(flume, capfd):
    """Trouble goes to the logger; neither standard output nor standard error sees anything, not even of refused calls."""
    with flume.started() as i:
        status(i.step, 7.0, 0.1)
        status(i.set, {"ship.x": math.nan})
        sail(i, 2)
    instantiate(flume, guid=b"no")
    assert capfd.readouterr() == ("", "")


def test_exact_log_categories(flume):
    with flume.instance(logging=True) as i:
        i.start()
        i.step(0.0, 0.02)
        categories = {category for _, category, _, _ in i.messages}
        assert {"logEvents", "logSolver"} <= categories <= {c.name for c in flume.description.logCategories}
        assert {name for *_, name in i.messages} == {"cable"}
        assert all(text == text.strip() and "%" not in text and "#" not in text for _, _, text, _ in i.messages)
        i.messages.clear()
        i.slave.setDebugLogging(True, ["logStatusError"])
        i.step(0.02, 0.02)
        assert not i.messages
        status(i.step, 9.0, 0.02)
        assert [m[:2] for m in i.messages] == [(ERROR, "logStatusError")]
        assert status(i.slave.setDebugLogging, True, ["logWeather"]) == ERROR


def test_exact_eight_threads_at_once(flume, untouched):
    """Instances that are never used, and ones that are, on eight threads; each run is the one that a lone instance makes."""
    slaves = [flume.slave(f"thread {k}") for k in range(8)]  # fmpy changes the working folder while it loads
    runs, problems = [None] * 8, []

    def work(k):
        try:
            for _ in range(20):
                Instance(flume, slave=slaves[k]).free()
            with Instance(flume, slave=slaves[k]) as i:
                i.start()
                runs[k] = sail(i)
            with Instance(flume, slave=slaves[k]) as i:
                i.start()
        except BaseException as problem:
            problems.append(problem)

    threads = [threading.Thread(target=work, args=(k,)) for k in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not problems
    assert all(run == untouched for run in runs)


def test_exact_made_on_one_thread_stepped_on_others_freed_on_another(flume, untouched):
    made = []
    on_a_thread(lambda: made.append(flume.instance()))
    (i,) = made
    on_a_thread(i.start)
    rows = []
    inputs = motion.inputs(motion.wave, flume)
    for k in range(6):
        on_a_thread(lambda: rows.extend(bits(row) for row in i.run(1, 0.02, inputs, first=k)))
    assert rows == untouched
    on_a_thread(i.free)


def on_a_thread(work):
    problems = []

    def guarded():
        try:
            work()
        except BaseException as problem:
            problems.append(problem)

    thread = threading.Thread(target=guarded)
    thread.start()
    thread.join()
    assert not problems, problems


def test_exact_the_library_may_be_closed_and_opened_under_live_instances(flume, untouched):
    """What fmi4c (Ecos) does at every further instance."""
    instances = []
    for k in range(3):
        if instances:
            fmpy.freeLibrary(instances[-1].slave.dll._handle)
        i = flume.instance(name=f"instance {k}")
        i.start()
        instances.append(i)
    for i in instances:
        assert sail(i) == untouched
        i.free()


def test_exact_a_freed_instance_is_noticed_where_that_can_be_seen(flume):
    """Freeing NULL or memory that is no instance is harmless."""
    slave = flume.slave()
    nothing = (ctypes.c_uint64 * 8)()
    slave.fmi2FreeInstance(ctypes.addressof(nothing))
    slave.component = ctypes.addressof(nothing)
    assert status(slave.terminate) == ERROR
    assert list(nothing) == [0] * 8
