"""Runs a job in NTNU's Ecos."""

import job

ecospy = job.host("ecospy")
ecospy.EcosLib.set_log_level("warn")
task = job.read()

if task["kind"] == "fmu":
    with ecospy.EcosSimulationStructure() as structure:
        start = {}
        for name, instance in task["instances"].items():
            structure.add_model(name, task["path"])
            start.update((f"{name}::{variable}", value) for variable, value in instance["start"].items())
        structure.add_parameter_set("start", start)
        simulation = ecospy.EcosSimulation(structure=structure, step_size=task["step"])
    parameters = "start"
else:
    simulation = ecospy.EcosSimulation(ssp_path=task["path"], step_size=task["step"])
    parameters = task["parameters"]

assert simulation.init(0, parameters), ecospy.EcosLib.get_last_error()
readers = {"Real": simulation.get_real, "Integer": simulation.get_integer, "Boolean": simulation.get_bool}
results = {name: {variable: [] for variable in task["record"]} for name in task["instances"]}
for k in range(task["steps"]):
    for name, instance in task["instances"].items():
        for variable, series in instance["inputs"].items():
            simulation.set_real(f"{name}::{variable}", series[k])
    simulation.step()
    for name in task["instances"]:
        for variable, kind in task["record"].items():
            results[name][variable].append(readers[kind](f"{name}::{variable}"))
simulation.terminate()
job.write(results)
