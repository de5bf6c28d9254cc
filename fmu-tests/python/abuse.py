"""What hosts do wrong, one case a process: `python abuse.py CASE FOLDER`, where FOLDER is an unpacked FMU of the flume scene.

Plain ctypes, so that nothing stands between the case and the C interface. A case that ends well prints nothing and exits with 0.
"""

import ctypes as c
import math
import os
import re
import shutil
import stat
import sys
import threading
import time
from pathlib import Path

OK, WARNING, DISCARD, ERROR, FATAL = range(5)
SIGNATURE = c.CFUNCTYPE(None, c.c_void_p, c.c_char_p, c.c_int, c.c_char_p, c.c_char_p)
H = 0.02
CASES = {}


def case(function):
    CASES[function.__name__] = function
    return function


class Callbacks(c.Structure):
    _fields_ = [("logger", c.c_void_p), ("allocate", c.c_void_p), ("free", c.c_void_p), ("finished", c.c_void_p), ("environment", c.c_void_p)]


class Fmu:
    """The unpacked FMU, and its library as a host sees it."""

    def __init__(self, folder):
        self.folder = Path(folder)
        xml = (self.folder / "modelDescription.xml").read_text(encoding="utf-8")
        self.guid = re.search(r'guid="([^"]*)"', xml)[1].encode()
        pattern = r'<ScalarVariable name="([^"]*)" valueReference="(\d+)"([^>]*)>\s*<(\w+)'
        rows = re.findall(pattern, xml)
        self.variables = {name: (int(vr), kind) for name, vr, _, kind in rows}
        self.outputs = [name for name, _, rest, kind in rows if 'causality="output"' in rest and kind == "Real"]
        self.location = (self.folder / "resources").as_uri().encode()
        self.messages = []
        self.logger = SIGNATURE(lambda _e, name, level, category, text: self.messages.append((level, category.decode(), text.decode(), name)))
        self.path = str(next((self.folder / "binaries" / "linux64").glob("*.so")))
        self.open()

    def open(self):
        self.library = c.CDLL(self.path)
        self.library.fmi2Instantiate.restype = c.c_void_p

    def close(self):
        handle = self.library._handle
        c.CDLL(None).dlclose(c.c_void_p(handle))

    def __getattr__(self, name):
        return getattr(self.library, f"fmi2{name}")

    def callbacks(self):
        return Callbacks(logger=c.cast(self.logger, c.c_void_p))

    def instantiate(self, name=b"rope", kind=1, guid=None, location=b"", callbacks="ours", debug=0):
        structure = self.callbacks() if callbacks == "ours" else callbacks
        pointer = None if structure is None else c.byref(structure)
        return self.Instantiate(name, kind, guid if guid is not None else self.guid, location or self.location, pointer, 0, debug)

    def good(self, **options):
        instance = self.instantiate(**options)
        assert instance, self.messages
        return c.c_void_p(instance)

    def start(self, i, begin=0.0):
        assert self.SetupExperiment(i, 0, c.c_double(0), c.c_double(begin), 0, c.c_double(0)) == OK
        assert self.EnterInitializationMode(i) == OK
        assert self.ExitInitializationMode(i) == OK, self.messages

    def started(self, **options):
        i = self.good(**options)
        self.start(i)
        return i

    def step(self, i, point, h):
        return self.DoStep(i, c.c_double(point), c.c_double(h), 1)

    def set(self, i, name, value):
        return self.SetReal(i, c.byref(c.c_uint(self.variables[name][0])), c.c_size_t(1), c.byref(c.c_double(value)))

    def get(self, i, names=None):
        names = names or self.outputs
        references, values = (c.c_uint * len(names))(*(self.variables[n][0] for n in names)), (c.c_double * len(names))()
        assert self.GetReal(i, references, c.c_size_t(len(names)), values) == OK
        return list(values)

    def sail(self, i, first=0, last=5):
        """A little ship motion; all outputs after every step."""
        rows = []
        for k in range(first, last):
            t = k * H
            for name, value in [("ship.z", 0.002 * math.sin(3 * t)), ("ship.vz", 0.006 * math.cos(3 * t))]:
                assert self.set(i, name, value) == OK
            assert self.step(i, t, H) in (OK, WARNING), self.messages
            rows.append(self.get(i))
        return rows

    def works(self, i, first=0):
        """It is at a communication point and steps on, with finite outputs."""
        assert all(math.isfinite(x) for row in self.sail(i, first, first + 2) for x in row)

    def refused(self, status, *words):
        """fmi2Error, and the last message says so."""
        assert status == ERROR, (status, words)
        level, category, text, _ = self.messages[-1]
        assert (level, category) == (ERROR, "logStatusError") and all(w in text for w in words), (text, words)


@case
def wrong_order(fmu):
    i = fmu.good()
    fmu.refused(fmu.ExitInitializationMode(i), "fmi2ExitInitializationMode")
    fmu.refused(fmu.step(i, 0.0, H), "fmi2DoStep")
    fmu.refused(fmu.Terminate(i), "fmi2Terminate")
    assert fmu.EnterInitializationMode(i) == OK
    fmu.refused(fmu.EnterInitializationMode(i), "fmi2EnterInitializationMode")
    fmu.refused(fmu.SetupExperiment(i, 0, c.c_double(0), c.c_double(0), 0, c.c_double(0)), "fmi2SetupExperiment")
    fmu.refused(fmu.step(i, 0.0, H), "fmi2DoStep")
    assert fmu.ExitInitializationMode(i) == OK
    fmu.refused(fmu.ExitInitializationMode(i), "fmi2ExitInitializationMode")
    fmu.works(i)
    assert fmu.Terminate(i) == OK
    fmu.refused(fmu.step(i, 2 * H, H), "fmi2DoStep")
    fmu.refused(fmu.set(i, "ship.z", 0.0), "fmi2SetReal")
    assert fmu.Reset(i) == OK
    fmu.start(i)
    fmu.works(i)
    fmu.FreeInstance(i)


NAMES = """SetDebugLogging SetupExperiment EnterInitializationMode ExitInitializationMode Terminate Reset GetReal GetInteger GetBoolean
    GetString SetReal SetInteger SetBoolean SetString GetFMUstate SetFMUstate FreeFMUstate SerializedFMUstateSize SerializeFMUstate
    DeSerializeFMUstate GetDirectionalDerivative SetRealInputDerivatives GetRealOutputDerivatives DoStep CancelStep GetStatus GetRealStatus
    GetIntegerStatus GetBooleanStatus GetStringStatus""".split()


@case
def null_everything(fmu):
    nothing = [c.c_void_p(None)] * 8
    for name in NAMES:
        assert getattr(fmu, name)(*nothing) == ERROR, name
    fmu.FreeInstance(None)
    assert not fmu.Instantiate(None, 0, None, None, None, 0, 0)
    assert not fmu.Instantiate(None, 1, None, None, c.byref(fmu.callbacks()), 0, 1)
    assert not fmu.Instantiate(b"rope", 1, None, None, None, 0, 0)


@case
def null_arrays_with_elements(fmu):
    i = fmu.started()
    null, one = c.c_void_p(None), c.c_size_t(1)
    for name in ("GetReal", "GetInteger", "GetBoolean", "GetString", "SetReal", "SetInteger", "SetBoolean", "SetString"):
        fmu.refused(getattr(fmu, name)(i, null, one, null), name, "NULL")
    fmu.refused(fmu.SetRealInputDerivatives(i, null, one, null, null), "NULL")
    fmu.refused(fmu.SetDebugLogging(i, 1, one, null), "NULL")
    fmu.refused(fmu.GetFMUstate(i, null), "NULL")
    fmu.refused(fmu.SetFMUstate(i, null), "NULL")
    fmu.refused(fmu.SerializedFMUstateSize(i, null, null), "NULL")
    fmu.refused(fmu.DeSerializeFMUstate(i, null, one, null), "NULL")
    fmu.refused(fmu.GetRealStatus(i, 2, null), "NULL")
    fmu.refused(fmu.GetBooleanStatus(i, 3, null), "NULL")
    huge = c.c_size_t(2**63)
    fmu.refused(fmu.GetReal(i, c.byref(c.c_uint(0)), huge, c.byref(c.c_double())), "long")
    fmu.works(i)
    fmu.FreeInstance(i)


@case
def memory_that_is_no_instance(fmu):
    zeros = (c.c_uint64 * 64)()
    inside = c.addressof(zeros)
    for address in (inside, inside + 1):
        for name in NAMES:
            assert getattr(fmu, name)(c.c_void_p(address), *[c.c_void_p(None)] * 7) == ERROR, name
        fmu.FreeInstance(c.c_void_p(address))
    i = fmu.started()
    fmu.refused(fmu.SetFMUstate(i, c.c_void_p(inside)), "not from this FMU")
    fmu.refused(fmu.FreeFMUstate(i, c.byref(c.c_void_p(inside))), "not from this FMU")
    assert list(zeros) == [0] * 64
    fmu.works(i)
    fmu.FreeInstance(i)


@case
def inputs_that_are_no_numbers(fmu):
    i = fmu.started()
    for bad in (math.nan, math.inf, -math.inf):
        fmu.refused(fmu.set(i, "ship.z", bad), "ship.z", "finite")
        derivative = (c.byref(c.c_uint(fmu.variables["ship.z"][0])), c.c_size_t(1), c.byref(c.c_int(1)), c.byref(c.c_double(bad)))
        fmu.refused(fmu.SetRealInputDerivatives(i, *derivative), "finite")
    assert fmu.get(i, ["ship.z"]) == [0.0]
    fmu.works(i)
    for name, absurd in (("ship.z", 1e9), ("ship.vx", 1e300), ("winch.setpoint", -1e12)):
        state = c.c_void_p()
        assert fmu.GetFMUstate(i, c.byref(state)) == OK
        assert fmu.set(i, name, absurd) == OK
        assert fmu.step(i, 2 * H, H) <= ERROR
        assert all(map(math.isfinite, fmu.get(i)))
        assert fmu.SetFMUstate(i, state) == OK and fmu.FreeFMUstate(i, c.byref(state)) == OK
    fmu.works(i, 2)
    fmu.FreeInstance(i)


@case
def steps_that_are_none(fmu):
    i = fmu.started()
    for h in (0.0, -H, math.nan, math.inf, -math.inf):
        begin = time.monotonic()
        fmu.refused(fmu.step(i, 0.0, h), "step size")
        # Some FMUs loop for ever on such steps.
        assert time.monotonic() - begin < 1.0
    for point in (math.nan, math.inf, -1.0, 5.0, 1e300):
        fmu.refused(fmu.step(i, point, H), "communication point")
    fmu.works(i)
    fmu.FreeInstance(i)


@case
def experiments_that_are_none(fmu):
    i = fmu.good()
    bad = [(0, 0.0, math.nan, 0, 0.0), (0, 0.0, math.inf, 0, 0.0), (1, math.nan, 0.0, 0, 0.0), (1, 0.0, 0.0, 0, 0.0), (1, -1.0, 0.0, 0, 0.0),
           (0, 0.0, 1.0, 1, 0.0), (0, 0.0, 0.0, 1, math.nan)]
    for tolerance_given, tolerance, begin, stop_given, stop in bad:
        status = fmu.SetupExperiment(i, tolerance_given, c.c_double(tolerance), c.c_double(begin), stop_given, c.c_double(stop))
        fmu.refused(status, "fmi2SetupExperiment")
    # What is not defined is not looked at.
    assert fmu.SetupExperiment(i, 0, c.c_double(math.nan), c.c_double(0.0), 0, c.c_double(math.nan)) == OK
    fmu.start(i)
    fmu.works(i)
    fmu.FreeInstance(i)


@case
def wrong_guid(fmu):
    for guid in (b"", b"{}", fmu.guid[:-1], fmu.guid + b" ", fmu.guid.upper() + b"x", b"\xff\xfe", b"x" * 100_000):
        assert not fmu.instantiate(guid=guid)
        level, category, text, _ = fmu.messages[-1]
        assert (level, category) == (ERROR, "logStatusError") and "GUID" in text
    fmu.FreeInstance(fmu.started())


@case
def locations_in_every_form(fmu):
    """Each form that importers were seen to send, for a folder whose name needs encoding."""
    awkward = fmu.folder / "Ein Ordner, 100% & #1 ß"
    awkward.mkdir(exist_ok=True)
    shutil.copytree(fmu.folder / "resources", awkward / "resources", dirs_exist_ok=True)
    raw = str(awkward / "resources")
    encoded = (awkward / "resources").as_uri().removeprefix("file://")
    lower = re.sub("%..", lambda m: m[0].lower(), encoded)
    forms = ["file://{}", "file:{}", "file://localhost{}", "file:///{}", "file://{}/", "FILE://{}", "File://LOCALHOST{}/", "file:////{}"]
    for form in forms:
        for path in (raw, encoded, lower):
            i = fmu.good(location=form.format(path).encode())
            fmu.FreeInstance(i)
    # fmpy sends a folder beside the temporary one; libcosim and others a bare path.
    fmu.FreeInstance(fmu.good(location=raw.encode()))
    fmu.FreeInstance(fmu.good(location=f"file://{encoded}/../resources".encode()))
    for location in (b"http://x/y", b"resources", b"file:resources", b"file://elsewhere/x", b"file:", b"file:///a%00b", b"file:///%ff",
                     b"file:///C:/fmu/resources", b"file:///no/such/folder", b"\xff"):
        fmu.messages.clear()
        assert not fmu.instantiate(location=location), location
        assert fmu.messages and fmu.messages[-1][:2] == (ERROR, "logStatusError"), location
    # NULL and nothing stand for the scene in the library, which has this GUID only if it is the default one.
    for location in (None, b""):
        structure = fmu.callbacks()
        i = fmu.Instantiate(b"rope", 1, fmu.guid, location, c.byref(structure), 0, 0)
        assert i, fmu.messages
        fmu.FreeInstance(c.c_void_p(i))


@case
def callbacks_freed_after_instantiate(fmu):
    """Struct and strings are good during the call only: here they are overwritten after it."""
    structure = fmu.callbacks()
    texts = [c.create_string_buffer(text) for text in (b"rope", fmu.guid, fmu.location)]
    i = c.c_void_p(fmu.Instantiate(texts[0], 1, texts[1], texts[2], c.byref(structure), 0, 1))
    assert i
    c.memset(c.byref(structure), 0xFF, c.sizeof(structure))
    for text in texts:
        c.memset(text, 0x21, len(text) - 1)
    fmu.start(i)
    fmu.works(i)
    fmu.refused(fmu.step(i, 9.0, H), "communication point")
    assert {name for *_, name in fmu.messages} == {b"rope"}
    fmu.FreeInstance(i)


@case
def no_callbacks(fmu):
    for structure in (None, Callbacks()):
        i = fmu.good(callbacks=structure, debug=1)
        assert fmu.step(i, 0.0, H) == ERROR
        fmu.start(i)
        fmu.works(i)
        fmu.FreeInstance(i)


@case
def allocators_are_never_called(fmu):
    """Calling them would crash."""
    structure = fmu.callbacks()
    structure.allocate = structure.free = structure.finished = structure.environment = 8
    i = fmu.good(callbacks=structure, debug=1)
    fmu.start(i)
    fmu.works(i)
    fmu.FreeInstance(i)


@case
def a_logger_that_calls_back(fmu):
    """It may not use the instance that is at work, and says so instead of waiting for itself."""
    answers, holder = [], []
    actions = [lambda i: fmu.step(i, 0.0, H), lambda i: fmu.Reset(i), lambda i: fmu.FreeInstance(i) and None]

    @SIGNATURE
    def logger(*_):
        answers.extend(action(holder[0]) for action in actions[:2] if holder)
        if holder:
            fmu.library.fmi2FreeInstance(holder[0])

    structure = Callbacks(logger=c.cast(logger, c.c_void_p))
    holder.append(fmu.good(callbacks=structure))
    (i,) = holder
    assert fmu.step(i, 0.0, H) == ERROR
    assert answers == [ERROR, ERROR]
    fmu.start(i)
    fmu.works(i)
    fmu.FreeInstance(i)


@case
def names_with_percent_signs(fmu):
    """Messages go through printf in most hosts: nothing in them may be taken for a format, whatever names are about."""
    libc = c.CDLL(None)
    name = "100% %s %n %d #r1# ß".encode()
    i = fmu.good(name=name, debug=1)
    fmu.start(i)
    fmu.works(i)
    fmu.refused(fmu.SetString(i, c.byref(c.c_uint(77_777)), c.c_size_t(1), c.byref(c.c_char_p(b"%s%n"))), "77777")
    assert fmu.SetDebugLogging(i, 1, c.c_size_t(1), c.byref(c.c_char_p(b"%s%n#r1#"))) == ERROR
    assert not fmu.instantiate(name=name, guid=b"%s%n%n")
    assert not fmu.instantiate(name=name, location=b"%s%n#r1#")
    buffer = c.create_string_buffer(1 << 16)
    for _, category, text, said in fmu.messages:
        assert said == name and "%" not in text + category and "#" not in text
        libc.snprintf(buffer, c.c_size_t(len(buffer)), text.encode())
        assert buffer.value == text.encode()
    fmu.FreeInstance(i)


def alone(fmu):
    i = fmu.started()
    rows = fmu.sail(i)
    fmu.FreeInstance(i)
    return rows


def on_threads(works):
    problems = []

    def guarded(work):
        try:
            work()
        except BaseException as problem:
            problems.append(problem)

    threads = [threading.Thread(target=guarded, args=(work,)) for work in works]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not problems, problems


@case
def eight_instances_on_eight_threads(fmu):
    expected, runs = alone(fmu), [None] * 8

    def work(k):
        i = fmu.started(name=f"rope {k}".encode())
        runs[k] = fmu.sail(i)
        fmu.FreeInstance(i)

    on_threads([lambda k=k: work(k) for k in range(8)])
    assert all(run == expected for run in runs)


@case
def made_on_one_thread_used_on_others(fmu):
    expected, made, rows = alone(fmu), [], []
    on_threads([lambda: made.append(fmu.good())])
    (i,) = made
    on_threads([lambda: fmu.start(i)])
    for k in range(5):
        on_threads([lambda: rows.extend(fmu.sail(i, k, k + 1))])
    assert rows == expected
    on_threads([lambda: fmu.FreeInstance(i)])


@case
def a_thread_with_little_stack(fmu):
    """Hosts step on threads of 512 kB, macOS's default for all but the first."""
    expected, rows = alone(fmu), []
    threading.stack_size(512 * 1024)
    on_threads([lambda: rows.extend(alone(fmu))])
    assert rows == expected


@case
def reloaded_under_live_instances(fmu):
    """What fmi4c does at every further instance."""
    expected, instances = alone(fmu), []
    for _ in range(3):
        if instances:
            fmu.close()
            fmu.open()
        instances.append(fmu.started())
    for i in instances:
        assert fmu.sail(i) == expected
        fmu.FreeInstance(i)


@case
def unloaded_before_its_thread_ends(fmu):
    """Thread-local destructors of a library that is gone would crash as the thread ends."""

    def work():
        i = fmu.started()
        fmu.step(i, 7.0, H)  # a refusal takes the way of errors, too
        fmu.works(i)
        fmu.FreeInstance(i)
        fmu.close()

    for _ in range(3):
        on_threads([work])
        fmu.open()


def resident():
    """Bytes of this process in memory."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@case
def ten_thousand_instances(fmu):
    def cycle():
        fmu.FreeInstance(fmu.good())

    for _ in range(1000):
        cycle()
    before = resident()
    for _ in range(9000):
        cycle()
    # An instance has some 100 kB; a leak of 100 bytes in each cycle would show as 900 kB.
    assert resident() - before < 512 * 1024, resident() - before


@case
def a_thousand_runs(fmu):
    """Start, step, save, go back, free: none of it may leave anything behind."""

    def cycle():
        i = fmu.good()
        fmu.start(i)
        state, size = c.c_void_p(), c.c_size_t()
        assert fmu.GetFMUstate(i, c.byref(state)) == OK
        assert fmu.SerializedFMUstateSize(i, state, c.byref(size)) == OK
        buffer = c.create_string_buffer(size.value)
        assert fmu.SerializeFMUstate(i, state, buffer, size) == OK
        assert fmu.step(i, 0.0, 1e-4) in (OK, WARNING)
        assert fmu.DeSerializeFMUstate(i, buffer, size, c.byref(state)) == OK
        assert fmu.SetFMUstate(i, state) == OK and fmu.FreeFMUstate(i, c.byref(state)) == OK
        fmu.refused(fmu.step(i, 7.0, H), "communication point")
        fmu.messages.clear()
        fmu.FreeInstance(i)

    # By then the heap has found its size.
    for _ in range(100):
        cycle()
    before = resident()
    for _ in range(200):
        cycle()
    # A fiftieth of one saved state for each cycle.
    assert resident() - before < 96 * 1024, resident() - before


@case
def resources_that_cannot_be_written(fmu):
    """They may be shared: nothing is written, nothing is locked."""
    folder = fmu.folder / "resources"
    paths = [folder, *folder.rglob("*")]
    for path in paths:
        path.chmod(path.stat().st_mode & ~(stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH))
    before = {str(p): (p.stat().st_mtime_ns, p.stat().st_size) for p in paths}
    a, b = fmu.started(), fmu.started()
    assert fmu.sail(a) == fmu.sail(b)
    assert {str(p): (p.stat().st_mtime_ns, p.stat().st_size) for p in [folder, *folder.rglob("*")]} == before
    fmu.FreeInstance(a)
    fmu.FreeInstance(b)
    for path in paths:
        path.chmod(path.stat().st_mode | stat.S_IWUSR)


@case
def resources_that_go_away(fmu):
    """They are read when the instance is made; some hosts remove the folder early."""
    expected = alone(fmu)
    copy = fmu.folder / "for a moment"
    shutil.copytree(fmu.folder / "resources", copy)
    i = fmu.good(location=copy.as_uri().encode())
    shutil.rmtree(copy)
    fmu.start(i)
    assert fmu.sail(i) == expected
    assert fmu.Reset(i) == OK
    fmu.start(i)
    assert fmu.sail(i) == expected
    fmu.FreeInstance(i)


@case
def a_working_folder_that_is_gone(fmu):
    gone = fmu.folder / "gone"
    gone.mkdir()
    os.chdir(gone)
    gone.rmdir()
    i = fmu.started()
    fmu.works(i)
    fmu.FreeInstance(i)


@case
def instances_that_nobody_frees(fmu):
    for _ in range(5):
        fmu.works(fmu.started())


@case
def the_rounding_mode_is_the_hosts(fmu):
    """MXCSR's and the x87's control bits are as before; flags may be raised."""
    libm = c.CDLL("libm.so.6")

    def control():
        environment = (c.c_uint8 * 64)()
        assert libm.fegetenv(environment) == 0
        return bytes(environment[0:2]), int.from_bytes(bytes(environment[28:32]), "little") & ~0x3F

    before = control()
    i = fmu.started()
    fmu.works(i)
    fmu.FreeInstance(i)
    assert control() == before


if __name__ == "__main__":
    CASES[sys.argv[1]](Fmu(sys.argv[2]))
