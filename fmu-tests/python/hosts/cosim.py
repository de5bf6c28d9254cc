"""Runs a job in DNV's libcosim."""

import job

job.host("libcosimpy")
from libcosimpy.CosimEnums import CosimVariableType  # noqa: E402
from libcosimpy.CosimExecution import CosimExecution  # noqa: E402
from libcosimpy.CosimLogging import CosimLogLevel, log_output_level  # noqa: E402
from libcosimpy.CosimManipulator import CosimManipulator  # noqa: E402
from libcosimpy.CosimObserver import CosimObserver  # noqa: E402
from libcosimpy.CosimSlave import CosimLocalSlave  # noqa: E402

log_output_level(CosimLogLevel.WARNING)
task = job.read()
nanoseconds = task["step"] * 1e9
assert nanoseconds == int(nanoseconds), "libcosim counts whole nanoseconds"

if task["kind"] == "fmu":
    execution = CosimExecution.from_step_size(int(nanoseconds))
    # The slaves must outlive the execution.
    slaves = [CosimLocalSlave(task["path"], name) for name in task["instances"]]
    for slave in slaves:
        assert execution.add_local_slave(slave) >= 0
elif task["kind"] == "osp":
    execution = CosimExecution.from_osp_config_file(task["path"])
else:
    execution = CosimExecution.from_ssp_file(task["path"], int(nanoseconds))

indices = {name: execution.slave_index_from_instance_name(name) for name in task["instances"]}
variables = {}
for name, index in indices.items():
    found = execution.slave_variables(index)
    variables[name] = {v.name.decode(): (CosimVariableType(v.type), v.reference) for v in found}
for name, instance in task["instances"].items():
    for variable, value in instance["start"].items():
        kind, reference = variables[name][variable]
        set_start = execution.real_initial_value if kind == CosimVariableType.REAL else execution.integer_initial_value
        assert set_start(indices[name], reference, value), variable

manipulator, observer = CosimManipulator.create_override(), CosimObserver.create_last_value()
assert execution.add_manipulator(manipulator) and execution.add_observer(observer)
readers = {
    CosimVariableType.REAL: observer.last_real_values,
    CosimVariableType.INTEGER: observer.last_integer_values,
    CosimVariableType.BOOLEAN: observer.last_boolean_values,
}
results = {name: {variable: [] for variable in task["record"]} for name in task["instances"]}
for k in range(task["steps"]):
    for name, instance in task["instances"].items():
        if instance["inputs"]:
            references = [variables[name][variable][1] for variable in instance["inputs"]]
            values = [series[k] for series in instance["inputs"].values()]
            assert manipulator.slave_real_values(indices[name], references, values)
    assert execution.step(), f"step {k}"
    for name, index in indices.items():
        for kind, read in readers.items():
            wanted = [v for v in task["record"] if variables[name][v][0] == kind]
            if wanted:
                for variable, value in zip(wanted, read(index, [variables[name][v][1] for v in wanted])):
                    results[name][variable].append(value)
job.write(results)
