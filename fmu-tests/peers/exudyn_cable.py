"""Exudyn's part of `cargo xtask bench --peers`: one scene on one mesh with one step.

    exudyn_cable.py SCENE ELEMENTS STEP EVERY END OUT

writes what the comparison asks for every EVERY seconds up to END to OUT (CSV, SI units) and prints the CPU seconds of the solver call. The scenes
(p1, p3, p4a, p4b) are those of fmu-tests/references/README.md; the plane's axes are x and z (Exudyn's y).
"""

import sys
import time

sys.exudynFast = True  # the module without range checks

import exudyn as exu  # noqa: E402
import numpy as np  # noqa: E402
from exudyn import itemInterface as item  # noqa: E402
from exudyn.advancedUtilities import CreateSymbolicUserFunction  # noqa: E402

GRAVITY = 9.81
OUTPUT = exu.OutputVariableType


def linear_bending(mbs, t, item_number, place, curvature, curvature_t, curvature_0, stiffness, damping, strain, strain_t, strain_0):
    """The bending moment that Exudyn would take by itself."""
    return stiffness * curvature


class Model:
    """Planar cable elements on nodes of position and slope, rows of x, z, x', z' at equal distances in unstretched length."""

    def __init__(self, rows, length, mass, stiffness, bending, damping, law=None):
        self.container = exu.SystemContainer()
        self.system = self.container.AddSystem()
        self.nodes = [self.system.AddNode(item.Point2DS1(referenceCoordinates=list(row))) for row in rows]
        self.element_length = length / (len(rows) - 1)
        self.elements = []
        for pair in zip(self.nodes, self.nodes[1:], strict=False):
            # Strain and curvature count from the straight, unstretched element, not from the nodes' reference.
            element = item.Cable2D(
                length=self.element_length,
                massPerLength=mass,
                axialStiffness=stiffness,
                bendingStiffness=bending,
                axialDamping=damping,
                strainIsRelativeToReference=0.0,
                # Exudyn asks for a law of the axial force only where there is one of the bending moment, too.
                axialForceUserFunction=law or 0,
                bendingMomentUserFunction=linear_bending if law else 0,
                nodeNumbers=list(pair),
            )
            self.elements.append(self.system.AddObject(element))
            marker = self.system.AddMarker(item.MarkerBodyMass(bodyNumber=self.elements[-1]))
            self.system.AddLoad(item.Gravity(markerNumber=marker, loadVector=[0, -GRAVITY, 0]))
        ground = self.system.AddNode(item.NodePointGround())
        self.ground = self.system.AddMarker(item.MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
        self.sensors = []

    def pin(self, motion=None, sense=True):
        """Holds the first node; `motion` moves it up and down; `sense` records the two components of what holds it."""
        markers = [self.system.AddMarker(item.MarkerNodeCoordinate(nodeNumber=self.nodes[0], coordinate=k)) for k in range(2)]
        pins = [self.system.AddObject(item.CoordinateConstraint(markerNumbers=[self.ground, marker])) for marker in markers]
        if motion is not None:
            # Exudyn evaluates a symbolic function itself instead of calling Python in each step.
            law = CreateSymbolicUserFunction(self.system, motion, "offsetUserFunction", pins[1])
            self.system.SetObjectParameter(pins[1], "offsetUserFunction", law)
        for pin in pins if sense else []:
            self.sense(item.SensorObject(objectNumber=pin, outputVariableType=OUTPUT.Force, storeInternal=True))

    def lump(self, mass):
        """A mass at the last node."""
        self.system.AddObject(item.MassPoint2D(mass=mass, nodeNumber=self.nodes[-1]))
        marker = self.system.AddMarker(item.MarkerNodePosition(nodeNumber=self.nodes[-1]))
        self.system.AddLoad(item.Force(markerNumber=marker, loadVector=[0, -mass * GRAVITY, 0]))

    def sense(self, sensor):
        """Records a quantity."""
        self.sensors.append(self.system.AddSensor(sensor))

    def place(self, node):
        """Records a node's place."""
        self.sense(item.SensorNode(nodeNumber=node, outputVariableType=OUTPUT.Position, storeInternal=True))

    def run(self, step, every, end):
        """Generalized alpha to the end; the recorded quantities at 0, every, ... and the CPU seconds of the solver call."""
        self.system.Assemble()
        settings = exu.SimulationSettings()
        integration = settings.timeIntegration
        integration.numberOfSteps = round(end / step)
        integration.endTime = end
        integration.verboseMode = 0
        # At these tolerances the errors are those of 1e-8 and 1e-10 and the run is cheaper.
        integration.generalizedAlpha.spectralRadius = 0.9
        integration.newton.relativeTolerance, integration.newton.absoluteTolerance = 1e-6, 1e-8
        settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
        settings.solution.file.write = False
        # Every step, and between them by straight lines: where Newton's method fails the program halves a step and its times shift.
        settings.solution.sensors.writePeriod = 0.0
        start = time.process_time()
        if not self.system.SolveDynamic(settings):
            sys.exit("Exudyn's solver gave up")
        seconds = time.process_time() - start
        times = every * np.arange(round(end / every) + 1)
        records = [self.system.GetSensorStoredData(sensor) for sensor in self.sensors]
        if any(record[-1, 0] < end - 0.5 * step for record in records):
            sys.exit(f"Exudyn stopped at {records[0][-1, 0]} s")
        rows = [np.column_stack([np.interp(times, record[:, 0], column) for column in record.T[1:]]) for record in records]
        return times, rows, seconds


def string(elements, step, every, end):
    """P3: a string let go level."""
    rows = [(s, 0.0, 1.0, 0.0) for s in np.linspace(0.0, 1.0, elements + 1)]
    model = Model(rows, 1.0, 2e-4, 222.0, 2.82e-6, 0.02)
    model.lump(1.33e-3)
    model.pin()
    model.place(model.nodes[-1])
    times, (across, up, tip), seconds = model.run(step, every, end)
    return {"time": times, "tension": np.hypot(across[:, 0], up[:, 0]), "x": tip[:, 0], "z": tip[:, 1]}, seconds


def tension_only(mbs, t, item_number, place, strain, strain_t, strain_0, stiffness, damping, curvature, curvature_t, curvature_0):
    """P4b's axial force: no compression, damping always."""
    return stiffness * max(strain, 0.0) + damping * strain_t


def wire(ratio, amplitude, period, law, elements, step, every, end):
    """P4: a heavy wire, stretched by `ratio` at the start, its top heaved after a ramp over two periods."""
    length = 200.0
    rows = [(0.0, -z, 0.0, -slope) for z, slope in map(ratio, np.linspace(0.0, length, elements + 1))]
    model = Model(rows, length, 1.0, 1e7, 20.0, 4e4, law)
    model.lump(500.0)
    sym = exu.symbolic
    rate, ramp = 2.0 * np.pi / period, 2.0 * period

    def motion(mbs, t, item_number, offset):
        eased = sym.IfThenElse(t < ramp, 0.5 - 0.5 * sym.cos(np.pi / ramp * t), sym.Real(1.0))
        return amplitude * eased * sym.sin(rate * t)

    model.pin(motion)
    model.place(model.nodes[-1])
    times, (_, up, tip), seconds = model.run(step, every, end)
    return {"time": times, "tension": -up[:, 0], "x": tip[:, 0], "z": tip[:, 1]}, seconds


def heaved(*run):
    """P4a starts stretched uniformly."""
    return wire(lambda s: (s * 200.11772 / 200.0, 200.11772 / 200.0), 2.5, 6.0, None, *run)


def snapping(*run):
    """P4b starts at rest."""
    hung = lambda s: (s + GRAVITY * (700.0 * s - 0.5 * s * s) / 1e7, 1.0 + GRAVITY * (700.0 - s) / 1e7)  # noqa: E731
    return wire(hung, 5.0, 4.0, tension_only, *run)


def pulley(elements, step, every, end):
    """P1: a pendulum over a pulley, thesis 4.1, configuration 1, with a linear penalty of 1e8 N/m^2."""
    length, stiffness, contact, penalty, mass = 0.44, 1.2276e5, 0.05062, 1e8, 9.43
    gyration, arm, wrap = 0.269, 0.258, np.radians(34.9)
    tension = mass * GRAVITY * np.sin(wrap)
    radius, stretch = contact - tension / (contact * penalty), 1.0 + tension / stiffness

    def row(s):
        angle = min(s * stretch / radius, wrap)
        free = s * stretch - radius * angle
        sine, cosine = np.sin(angle), np.cos(angle)
        return radius * sine + free * cosine, radius * cosine - free * sine, stretch * cosine, -stretch * sine

    model = Model([row(s) for s in np.linspace(0.0, length, elements + 1)], length, 0.059, stiffness, 8e-5, 20.0)
    system = model.system
    # Contact acts on straight segments of each element, twelve at most, with normals towards the circle's centre.
    segments = 12
    centre = system.AddMarker(item.MarkerBodyRigid(bodyNumber=system.AddObject(item.ObjectGround())))
    for element in model.elements:
        shape = system.AddMarker(item.MarkerBodyCable2DShape(bodyNumber=element, numberOfSegments=segments))
        state = [0.1] * segments + [-2.0] * segments + [0.0] * segments
        gaps = system.AddNode(item.NodeGenericData(initialCoordinates=state, numberOfDataCoordinates=3 * segments))
        circle = item.ObjectContactFrictionCircleCable2D(
            markerNumbers=[centre, shape],
            nodeNumber=gaps,
            numberOfContactSegments=segments,
            contactStiffness=penalty * model.element_length / segments,
            circleRadius=contact,
            useSegmentNormals=False,
        )
        system.AddObject(circle)
    x, z = row(length)[:2]
    along = np.array(row(length)[2:]) / stretch
    angle = np.arctan2(along[1], along[0])
    body = system.AddNode(item.NodeRigidBody2D(referenceCoordinates=[x + arm * along[0], z + arm * along[1], angle]))
    load = system.AddObject(item.RigidBody2D(mass=mass, inertia=mass * (gyration**2 - arm**2), nodeNumber=body))
    weight = system.AddMarker(item.MarkerBodyMass(bodyNumber=load))
    system.AddLoad(item.Gravity(markerNumber=weight, loadVector=[0, -GRAVITY, 0]))
    ends = [
        system.AddMarker(item.MarkerNodePosition(nodeNumber=model.nodes[-1])),
        system.AddMarker(item.MarkerBodyPosition(bodyNumber=load, localPosition=[-arm, 0, 0])),
    ]
    joint = system.AddObject(item.RevoluteJoint2D(markerNumbers=ends))
    model.pin(sense=False)
    model.sense(item.SensorObject(objectNumber=joint, outputVariableType=OUTPUT.Force, storeInternal=True))
    model.place(model.nodes[elements // 2])
    model.place(model.nodes[-1])
    times, (force, middle, end_place), seconds = model.run(step, every, end)
    chords = np.arctan2(middle[:, 1] - end_place[:, 1], end_place[:, 0] - middle[:, 0])
    return {"time": times, "tension": np.hypot(force[:, 0], force[:, 1]), "wrap": chords}, seconds


SCENES = {"p1": pulley, "p3": string, "p4a": heaved, "p4b": snapping}


def main():
    scene, elements, step, every, end, out = sys.argv[1:]
    columns, seconds = SCENES[scene](int(elements), float(step), float(every), float(end))
    np.savetxt(out, np.column_stack(list(columns.values())), fmt="%.10g", delimiter=",", header=",".join(columns), comments="")
    print(f"seconds {seconds:.6f}")


if __name__ == "__main__":
    main()
