"""A thin host around fmpy's FMU2Slave: variables by name, and the FMU's messages kept."""

import ctypes
import math
import struct
from pathlib import Path

import fmpy
from fmpy import fmi2
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, fmi2Boolean, fmi2Integer, fmi2Real, fmi2String, fmi2ValueReference

OK, WARNING, DISCARD, ERROR, FATAL = range(5)


class Packed:
    """A packed FMU, unpacked and described."""

    def __init__(self, path, folder):
        self.path = Path(path)
        self.folder = Path(folder)
        fmpy.extract(str(path), unzipdir=str(folder))
        self.description = fmpy.read_model_description(str(path), validate=True)
        self.variables = {v.name: v for v in self.description.modelVariables}

    @property
    def guid(self):
        return self.description.guid

    @property
    def location(self):
        return (self.folder / "resources").as_uri()

    def names(self, causality=None, kind=None):
        wanted = lambda v: causality in (None, v.causality) and kind in (None, v.type)
        return [v.name for v in self.variables.values() if wanted(v)]

    def slave(self, name="cable"):
        """fmpy's own object, nothing called yet."""
        identifier = self.description.coSimulation.modelIdentifier
        return FMU2Slave(guid=self.guid, modelIdentifier=identifier, unzipDirectory=str(self.folder), instanceName=name)

    def instance(self, **options):
        return Instance(self, **options)

    def started(self, time=0.0, parameters=None, inputs=None, **options):
        """An initialized instance."""
        instance = self.instance(**options)
        instance.set(parameters or {})
        instance.start(time, inputs or {})
        return instance


class Instance:
    """One instance; every call returns a status or raises fmpy's FMICallException."""

    def __init__(self, fmu, name="cable", logging=False, slave=None):
        self.fmu = fmu
        self.messages = []
        self.slave = slave or fmu.slave(name)

        def log(_environment, instance, status, category, message):
            self.messages.append((status, category.decode(), message.decode(), instance.decode()))

        # The FMU formats its messages itself, so that the variadic rest is empty.
        callbacks = fmi2.fmi2CallbackFunctions()
        callbacks.logger = fmi2.fmi2CallbackLoggerTYPE(log)
        self.slave.instantiate(callbacks=callbacks, loggingOn=logging)
        self.component = self.slave.component

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.free()

    def free(self):
        component, self.component = getattr(self, "component", None), None
        if component is not None:
            self.slave.fmi2FreeInstance(component)

    __del__ = free

    def start(self, time=0.0, inputs=None, stop=None, tolerance=None):
        self.slave.setupExperiment(startTime=time, stopTime=stop, tolerance=tolerance)
        self.slave.enterInitializationMode()
        self.set(inputs or {})
        self.slave.exitInitializationMode()

    def step(self, time, h):
        self.slave.doStep(time, h)

    def run(self, steps, h, inputs=None, first=0, record=None):
        """Steps number first .. first + steps - 1 of size h; inputs(t) are set before each. Returns what `record` names, or all outputs."""
        record = record or self.fmu.names("output")
        rows = []
        for k in range(first, first + steps):
            if inputs:
                self.set(inputs(k * h))
            self.step(k * h, h)
            rows.append(self.get(record))
        return rows

    def set(self, values):
        for kind, (references, given) in self._by_type(values).items():
            getattr(self.slave, f"set{kind}")(references, given)

    def get(self, names):
        """Values as a dict; one call per base type."""
        found = {}
        for kind in ("Real", "Integer", "Boolean", "String"):
            wanted = [name for name in names if self.fmu.variables[name].type == kind]
            if wanted:
                references = [self.fmu.variables[name].valueReference for name in wanted]
                found.update(zip(wanted, getattr(self.slave, f"get{kind}")(references)))
        return {name: found[name] for name in names}

    def __getitem__(self, name):
        return self.get([name])[name]

    def everything(self):
        return self.get(self.fmu.names())

    def derivatives(self, order, values):
        references = [self.fmu.variables[name].valueReference for name in values]
        self.slave.setRealInputDerivatives(references, [order] * len(references), list(values.values()))

    def _by_type(self, values):
        groups = {}
        for name, value in values.items():
            variable = self.fmu.variables[name]
            references, given = groups.setdefault(variable.type, ([], []))
            references.append(variable.valueReference)
            given.append(value)
        return groups

    def texts(self):
        return "\n".join(message for _, _, message, _ in self.messages)


def status(call, *arguments):
    """The status of a call that fmpy turns into an exception."""
    try:
        result = call(*arguments)
    except FMICallException as problem:
        return problem.status
    return result if isinstance(result, int) else OK


def bits(values):
    """Comparable to the last bit, NaN included."""
    return {name: struct.pack("<d", value) if isinstance(value, float) else value for name, value in values.items()}


def finite(values):
    return all(not isinstance(value, float) or math.isfinite(value) for value in values.values())
