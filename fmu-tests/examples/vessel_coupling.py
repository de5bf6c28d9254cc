"""A ship in Python, with six degrees of freedom, and the cable of `overboard` move each other.

    cargo xtask example vessel_coupling [OPTIONS]

The ship (vessel.py) is the one that `cargo xtask ship-motion` has, or another by --length, --beam and --draught; the cable hangs over its stern,
and by --offset to port of its middle. It prints what the cable does to the ship at rest beside hydrostatics, runs both in waves,
coupled and not, shows momentum and work at the coupling, halves the coupling's step, and writes series and a page of figures to
target/examples/vessel_coupling. The FMU runs in libcosim, stepped from Python, or in fmpy where libcosimpy does not exist; both give the same
numbers. It takes one or two minutes.
"""

import argparse
import importlib.util
import math
import sys
from copy import deepcopy
from dataclasses import replace
from pathlib import Path

import numpy as np
from common import ROOT, SCENES, SHIP, Failure, motion, packed, table, variant, write_csv
from coupling import couple, equilibrium
from figures import BLACK, BLUE, GREEN, ORANGE, Line, chart, html_table, page
from slave import Variables
from vessel import GRAVITY, Hull, Vessel, suspended

OUT = ROOT / "target" / "examples" / "vessel_coupling"
RECORD = ["body.z", "winch.tension"]
# The stern of the scene's ship lies 40 m abaft of its centre of gravity.
STERN = 40.0


def placed(variables, hull, offset):
    """Parameters that put winch and sheave as far abaft of another ship's stern as the scene does, and `offset` m to port."""
    parameters = {}
    for name in ("winch.position", "sheave[1].position"):
        x, y, _ = variables.vector(name)
        parameters |= {f"{name}[1]": x + STERN - 0.5 * hull.length, f"{name}[2]": y + offset}
    return parameters


def still_water(variables):
    """Parameters that take the current away."""
    return {name: 0.0 for name in variables.known if name.startswith("fluid.current.profile[") and not name.endswith(",1]")}


def weights(variables, parameters):
    """Rows of weight (N) and place (ship axes, m) of a cable that hangs plumb from the sheave: on the drum, between drum and sheave, on the sheave,
    and hanging, with the body, where it leaves the sheave; what is in the water is lighter by the water it displaces."""
    of = lambda name: parameters.get(name, variables.start(name))
    vector = lambda name: np.array([of(f"{name}[{i}]") for i in (1, 2, 3)])
    weight, thickness = GRAVITY * of("cable.mass_per_length"), of("cable.diameter")
    drum, sheave = of("winch.radius") + 0.5 * thickness, of("sheave[1].radius") + 0.5 * thickness
    span = vector("sheave[1].position") - vector("winch.position")
    # The common tangent above both wheels, from the drum up to the sheave abaft of it: its slope, and its length.
    slope = math.atan2(span[2], -span[0]) - math.asin((drum - sheave) / np.linalg.norm(span))
    deck = math.sqrt(span @ span - (drum - sheave) ** 2)
    wound, turned = drum * (of("winch.initial_angle") - slope), sheave * (0.5 * math.pi + slope)
    leaves = vector("sheave[1].position") - [sheave, 0.0, 0.0]
    free = of("cable.length") - wound - deck - turned
    middle = vector("winch.position") + 0.5 * span + [0.0, 0.0, 0.5 * (drum + sheave)]
    rows = [[weight * wound, *vector("winch.position")], [weight * deck, *middle]]
    rows.append([weight * turned, *(leaves + [0.5 * sheave, 0.0, 0.5 * sheave])])
    hanging = weight * free + GRAVITY * of("body.mass")
    if "fluid.density" in variables.known:
        wet = free - (leaves[2] - of("fluid.waterline"))
        hanging -= GRAVITY * of("fluid.density") * (0.25 * math.pi * thickness**2 * wet + of("body.volume"))
    # A stiff wire that leaves at an angle bends into the plumb line as if it had a hinge that much below.
    hinge = math.sqrt(of("cable.EI") / hanging)
    return [*rows, [hanging, *(leaves - [0.0, 0.0, hinge])]]


def at_rest(fmu, hull, parameters):
    """Sinkage (m), roll and pitch (rad) at which ship and cable rest: coupled, and by hydrostatics."""
    vessel = Vessel(hull)
    equilibrium(fmu, vessel, parameters)
    return vessel.pose[2:5], np.array(suspended(hull, weights(Variables(fmu), parameters)))


def excited(hull, times, motions):
    """The waves' load as a function of time, from the ship's motion at the times."""
    vessel = Vessel(hull)
    step = times[1] - times[0]
    return lambda t: vessel.excitation(motions[min(round(t / step), len(times) - 1)])


def convergence(fmu, hull, parameters, excitation, seconds, steps, host):
    """Greatest errors of heave (m), pitch (rad) and tension (N) against the finest of the steps (s), for all others, and the share of the work at
    the coupling that its two sides disagree by."""
    vessel = Vessel(hull)
    equilibrium(fmu, vessel, parameters)
    runs = {h: couple(fmu, deepcopy(vessel), h, round(seconds / h), parameters, RECORD, host, excitation) for h in steps}
    finest = min(steps)
    found = {}
    for h, run in runs.items():
        # Communication points of the finest run that this one has.
        every = round(h / finest)
        pose, tension = (np.abs(run[name] - runs[finest][name][::every]).max(axis=0) for name in ("pose", "winch.tension"))
        work = np.abs(run["work_vessel"] - run["work_cable"]).max() / np.ptp(run["work_vessel"])
        found[h] = [pose[2], pose[4], tension, work]
    return found


def dry_scene():
    """TOML text of `overboard` without water: nothing but ship, cable and body has momentum. Integrated so well that the coupling's error shows."""
    text = (SCENES / "overboard.toml").read_text(encoding="utf-8").replace('name = "overboard"', 'name = "overboard_dry"')
    text = text.replace('method = "tr_bdf2" ', 'tolerance = 1e-4\nmethod = "rodas4" ')
    begin, end = text.index("[fluid]"), text.index("[ship]")
    lines = (text[:begin] + text[end:]).splitlines()
    wet = ("volume =", "drag_area =", "drag_coefficient =", "added_mass =")
    return "\n".join(line for line in lines if not line.startswith(wet)) + "\n"


def momentum(fmu, hull, parameters, h, seconds, host="fmpy", push=2e4, lasting=2.0):
    """Pushes the ship forward with push·sin²(πt/lasting) N and compares the way (m) of the common centre of mass of ship, cable and body with that
    of one point of their mass, which the ship's method moves, so that nothing but the coupling's error is left. Returns times, both ways, and
    the ship's own."""
    hull = replace(hull, station_period=math.inf)
    vessel = Vessel(hull)
    points = [f"cable.point[{k}].x" for k in range(1, 62)]
    equilibrium(fmu, vessel, parameters)
    forward = lambda t: np.array([push * math.sin(math.pi * t / lasting) ** 2 if t < lasting else 0.0, 0, 0, 0, 0, 0])
    run = couple(fmu, vessel, h, round(seconds / h), parameters, ["body.x", *points], host, forward)
    of = lambda name: parameters.get(name, Variables(fmu).start(name))
    length, ship, body = of("cable.length"), hull.inertia[0], of("body.mass")
    cable = length * of("cable.mass_per_length")
    # Simpson's rule over the points, which are equally far apart along the cable.
    simpson = np.array([1.0] + [4.0, 2.0] * 29 + [4.0, 1.0]) / 180.0
    places = np.stack([run[name] for name in points])
    total = ship + body + cable
    centre = (ship * run["pose"][:, 0] + body * run["body.x"] + cable * (simpson @ places)) / total
    acceleration = np.array([forward(t)[0] for t in run["time"]]) / total
    mean = 0.5 * h * (acceleration[1:] + acceleration[:-1])
    speed = np.concatenate([[0.0], np.cumsum(mean)])
    way = np.concatenate([[0.0], np.cumsum(0.5 * h * (speed[1:] + speed[:-1]))])
    return run["time"], centre - centre[0], way, run["pose"][:, 0]


def host_here():
    """libcosim where libcosimpy is installed (it exists for Windows and Linux on x86-64), else fmpy."""
    return "libcosim" if importlib.util.find_spec("libcosimpy") else "fmpy"


def options():
    hull = Hull()
    parser = argparse.ArgumentParser(prog="vessel_coupling", description=__doc__.split("\n")[0])
    add = lambda name, default, text: parser.add_argument(name, type=float, default=default, metavar="X", help=f"{text}; default {default:g}")
    add("--length", hull.length, "ship's length, m")
    add("--beam", hull.beam, "ship's breadth, m")
    add("--draught", hull.draught, "ship's draught, m")
    add("--body-mass", 400.0, "mass of the body at the cable's end, kg")
    add("--offset", 6.0, "winch and sheave to port of the ship's middle, m")
    add("--hs", 1.88, "significant wave height, m (sea state 4)")
    add("--tp", 8.8, "peak period, s")
    add("--heading", 150.0, "direction of the waves, degrees from the bow: 180 is head seas")
    add("--seconds", 30.0, "of the run in waves")
    add("--step", 0.02, "coupling's step, s")
    add("--converge", 4.0, "seconds of the runs with halved steps; 0 for none")
    add("--momentum", 4.0, "seconds of the runs in air that show the momentum; 0 for none")
    parser.add_argument("--host", choices=["fmpy", "libcosim"], default=host_here(), help=f"default here {host_here()}")
    parser.add_argument("--out", type=Path, default=OUT, help="folder of the results")
    return parser


MILLIDEGREES = 1e3 * 180.0 / math.pi


class Report:
    """What is printed and put on the page, in the order of its coming."""

    def __init__(self, introduction):
        self.parts = [f"<p>{introduction}</p>"]

    def table(self, title, head, rows):
        print(f"{title}\n{table(head, rows)}\n", flush=True)
        self.parts.append(f"<h2>{title}</h2>{html_table(head, rows)}")

    def say(self, text):
        print(text + "\n", flush=True)
        self.parts.append(f"<p>{text}</p>")

    def chart(self, *arguments, **options):
        self.parts.append(chart(*arguments, **options))


def show_rest(report, fmu, hull, parameters):
    """The static effect of the cable, in still water."""
    found, expected = at_rest(fmu, hull, parameters)
    rows = []
    names = [("sinkage, mm", -1e3), ("roll, millidegrees", MILLIDEGREES), ("pitch, millidegrees", MILLIDEGREES)]
    for (name, size), a, b in zip(names, found, expected):
        # Without an offset there is no roll to compare.
        apart = f"{100.0 * (a / b - 1.0):.3f} %" if abs(b) > 1e-9 else ""
        rows.append([name, "", f"{a * size:.4f}", f"{b * size:.4f}", apart])
    report.table("What the cable does to the ship at rest", ["", "", "coupled", "hydrostatics", "apart"], rows)


def show_waves(report, fmu, hull, parameters, sea, args):
    """The same waves with the coupling, and with the ship as if the cable's load stayed what it is at rest; returns the series of both."""
    times, motions = motion(args.out / "motion.csv", duration=args.seconds, step=args.step, **sea)
    vessel, excitation = Vessel(hull), excited(hull, times, motions)
    equilibrium(fmu, vessel, parameters)
    runs = {}
    for way, two_way in (("coupled", True), ("one way", False)):
        runs[way] = couple(fmu, deepcopy(vessel), args.step, len(times) - 1, parameters, RECORD, args.host, excitation, two_way)
    both, alone = runs["coupled"], runs["one way"]
    change = both["pose"] - alone["pose"]
    rms = lambda run: np.sqrt(np.mean(np.square(run["pose"] - run["pose"][0]), axis=0))
    rows = []
    for i, (name, a, b) in enumerate(zip(("surge", "sway", "heave", "roll", "pitch", "yaw"), rms(alone), rms(both))):
        size, unit = (1e3, "mm") if i < 3 else (MILLIDEGREES, "millidegrees")
        rows.append([name, unit, f"{a * size:.3f}", f"{b * size:.3f}", f"{np.abs(change[:, i]).max() * size:.4f}"])
    head = ["motion", "", "rms one way", "rms coupled", "changed by up to"]
    report.table(f"In waves, {args.seconds:g} s under {args.host}", head, rows)
    time = both["time"]
    pair = lambda of: [Line(way, time, of(runs[way]), colour, way == "one way") for way, colour in (("coupled", BLUE), ("one way", ORANGE))]
    report.chart("Pitch of the ship", pair(lambda run: np.degrees(run["pose"][:, 4])), "time, s", "degrees")
    changes = [Line(name, time, MILLIDEGREES * change[:, i], colour) for name, i, colour in (("roll", 3, GREEN), ("pitch", 4, BLUE))]
    report.chart("What the cable's varying load changes", changes, "time, s", "millidegrees")
    report.chart("Tension at the winch", pair(lambda run: 1e-3 * run["winch.tension"]), "time, s", "kN")
    sides = [Line("as the ship sees it", time, both["work_vessel"], BLUE), Line("as the cable sees it", time, both["work_cable"], BLACK, True)]
    report.chart("Work of the cable on the ship", sides, "time, s", "J")
    exchanged, apart = np.ptp(both["work_vessel"]), np.abs(both["work_vessel"] - both["work_cable"]).max()
    share = 100.0 * apart / exchanged
    report.say(f"Work exchanged at the coupling: {exchanged:.0f} J; its two sides disagree by up to {apart:.3g} J, {share:.4f} % of it.")
    return runs


def show_momentum(report, dry, args):
    """A small ship, so that the cable's share shows."""
    hull = Hull(16.0, 5.0, 1.2)
    rows = []
    for h in (0.04, 0.02, 0.01):
        _, centre, way, own = momentum(dry, hull, placed(Variables(dry), hull, 0.0), h, args.momentum, args.host)
        rows.append([f"{1e3 * h:g} ms", "", f"{way[-1]:.6f}", *(f"{1e3 * np.abs(x - way).max():.4f}" for x in (own, centre))])
    head = ["step", "", "way of all, m", "ship's own off, mm", "common centre of mass off, mm"]
    report.table(f"Momentum: a ship of {1e-3 * hull.displacement:.0f} t, cable and body in air, pushed forward", head, rows)


def show_convergence(report, fmu, hull, parameters, sea, args):
    """Halved steps."""
    steps = [0.04, 0.02, 0.01, 0.005]
    times, motions = motion(args.out / "motion-fine.csv", duration=args.converge, step=steps[-1], **sea)
    # The cable's own error must not hide the coupling's.
    parameters = parameters | {"solver.tolerance": 1e-6}
    errors = convergence(fmu, hull, parameters, excited(hull, times, motions), args.converge, steps, args.host)
    rows = [[f"{1e3 * h:g} ms", "", *(f"{size * e:.3g}" for size, e in zip((1e6, 1e6, 1.0, 100.0), found))] for h, found in errors.items()]
    head = ["step", "", "heave, um", "pitch, urad", "tension, N", "work apart, %"]
    report.table(f"Against steps of {1e3 * steps[-1]:g} ms, {args.converge:g} s", head, rows)
    coarse = steps[:-1]
    x = [1e3 * h for h in coarse]
    columns = [("heave", 0, BLUE), ("pitch", 1, GREEN), ("tension", 2, ORANGE)]
    lines = [Line(name, x, [errors[h][i] / errors[coarse[0]][i] for h in coarse], colour, marks=True) for name, i, colour in columns]
    lines.append(Line("second order", x, [(h / coarse[0]) ** 2 for h in coarse], BLACK, dashed=True))
    report.chart("Error over that of the longest step", lines, "step, ms", "", logarithmic=True)


def main():
    args = options().parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    hull = Hull(args.length, args.beam, args.draught)
    fmu, dry = packed("overboard"), variant(dry_scene(), args.out / "scenes")
    variables = Variables(fmu)
    parameters = placed(variables, hull, args.offset) | {"body.mass": args.body_mass}
    sea = dict(hs=args.hs, tp=args.tp, heading=args.heading, length=args.length, beam=args.beam, draught=args.draught, ramp=5.0)
    size = f"{args.length:g} m x {args.beam:g} m x {args.draught:g} m, {1e-3 * hull.displacement:.0f} t"
    report = Report(f"A ship of {size}; {args.body_mass:g} kg on {variables.start('cable.length'):g} m of wire.")
    show_rest(report, fmu, hull, parameters | still_water(variables))
    runs = show_waves(report, fmu, hull, parameters, sea, args)
    if args.momentum > 0.0:
        show_momentum(report, dry, args)
    if args.converge > 0.0:
        show_convergence(report, fmu, hull, parameters, sea, args)
    for way, run in runs.items():
        columns = {"time": run["time"]} | dict(zip(SHIP, np.hstack([run["pose"], run["rate"]]).T))
        write_csv(args.out / f"{way.replace(' ', '-')}.csv", columns | {name: run[name] for name in (*RECORD, "work_vessel", "work_cable")})
    path = args.out / "index.html"
    path.write_text(page("A ship and a cable move each other", report.parts), encoding="utf-8")
    print(path)


if __name__ == "__main__":
    try:
        main()
    except Failure as failure:
        sys.exit(f"error: {failure}")
