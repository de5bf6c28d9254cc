"""One instance of an FMU under fmpy or under libcosim, driven from Python with values by name: the same calls for both."""

import shutil
import tempfile
import warnings
from pathlib import Path

import fmpy
from fmpy.fmi2 import FMU2Slave

from common import Failure


class Variables:
    """Names of an FMU's variables with their value references."""

    def __init__(self, path):
        path = Path(path)
        if not path.is_file():
            raise Failure(f"{path}: no such file; expected a packed FMU: `cargo xtask package {path.stem}` makes one")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            self.description = fmpy.read_model_description(str(path), validate=False)
        self.path = path
        self.known = {v.name: v for v in self.description.modelVariables}

    def reals(self, names):
        """Value references of Real variables."""
        for name in names:
            if name not in self.known:
                raise Failure(f"{self.path.name}: it has no variable {name}")
            if self.known[name].type != "Real":
                raise Failure(f"{self.path.name}: {name} is {self.known[name].type}; expected a Real")
        return [self.known[name].valueReference for name in names]

    def start(self, name):
        """Start value of a Real or Integer parameter."""
        if name not in self.known or self.known[name].start is None:
            raise Failure(f"{self.path.name}: expected a parameter {name} with a start value")
        return float(self.known[name].start)

    def vector(self, name):
        """Start values of the parameters name[1], name[2], name[3]."""
        return [self.start(f"{name}[{i}]") for i in (1, 2, 3)]


class FmpySlave:
    """Under fmpy: outputs are there from the start on."""

    def __init__(self, path, inputs, outputs, parameters=None, first=None):
        """Instantiates, sets `parameters` (a dict) and the `first` values of the inputs, and initializes at t = 0."""
        variables = Variables(path)
        self.inputs, self.outputs = variables.reals(inputs), variables.reals(outputs)
        self.folder = tempfile.mkdtemp(prefix="fairlead-")
        fmpy.extract(str(path), unzipdir=self.folder)
        description = variables.description
        self.slave = FMU2Slave(
            guid=description.guid, modelIdentifier=description.coSimulation.modelIdentifier, unzipDirectory=self.folder, instanceName="cable"
        )
        self.slave.instantiate(loggingOn=False)
        parameters = parameters or {}
        self.slave.setReal(variables.reals(parameters), list(map(float, parameters.values())))
        self.slave.setupExperiment(startTime=0.0)
        self.slave.enterInitializationMode()
        if first is not None:
            self.slave.setReal(self.inputs, list(map(float, first)))
        self.slave.exitInitializationMode()

    def get(self):
        """The outputs asked for, in their order."""
        return self.slave.getReal(self.outputs)

    def step(self, time, h, values):
        """Sets the inputs, goes from `time` to `time + h`, and returns the outputs there."""
        self.slave.setReal(self.inputs, [float(x) for x in values])
        self.slave.doStep(currentCommunicationPoint=time, communicationStepSize=h)
        return self.get()

    def close(self):
        """Frees instance, library and files."""
        if self.slave is not None:
            self.slave.freeInstance()
            self.slave = None
            # On Windows a library that is loaded cannot be removed.
            shutil.rmtree(self.folder, ignore_errors=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


class CosimSlave:
    """Under DNV's libcosim (OSP), which Python steps: an override manipulator sets the inputs before each step, a last-value observer reads the
    outputs after it. libcosim initializes with the first step, so there are no outputs before; its step is fixed."""

    def __init__(self, path, inputs, outputs, step, parameters=None, first=None):
        """As FmpySlave; `step` in s must be a whole number of nanoseconds."""
        from libcosimpy.CosimExecution import CosimExecution
        from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
        from libcosimpy.CosimManipulator import CosimManipulator
        from libcosimpy.CosimObserver import CosimObserver
        from libcosimpy.CosimSlave import CosimLocalSlave

        log_output_level(CosimLogLevel.WARNING)
        variables = Variables(path)
        self.inputs, self.outputs = variables.reals(inputs), variables.reals(outputs)
        self.h = step
        self.execution = CosimExecution.from_step_size(round(step * 1e9))
        # The slave must outlive the execution.
        self.slave = CosimLocalSlave(str(path), "cable")
        self.index = self.execution.add_local_slave(self.slave)
        starts = dict(parameters or {})
        starts.update(zip(inputs, first if first is not None else []))
        for name, reference in zip(starts, variables.reals(starts)):
            if not self.execution.real_initial_value(self.index, reference, float(starts[name])):
                raise Failure(f"libcosim does not take {name} = {starts[name]}")
        self.manipulator, self.observer = CosimManipulator.create_override(), CosimObserver.create_last_value()
        self.execution.add_manipulator(self.manipulator)
        self.execution.add_observer(self.observer)

    def step(self, time, h, values):
        """As FmpySlave's; `h` is the step given at the start."""
        assert h == self.h, "libcosim's fixed step"
        self.manipulator.slave_real_values(self.index, self.inputs, [float(x) for x in values])
        if not self.execution.step():
            raise Failure(f"libcosim's step at {time} s failed")
        return self.observer.last_real_values(self.index, self.outputs)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass
