"""A ship in Python, with six degrees of freedom, and the cable of `overboard` move each other.

    cargo xtask example vessel_coupling [OPTIONS]

The ship (vessel.py) is the one that `cargo xtask ship-motion` has, or another by --length, --beam and --draught; the cable hangs over its stern, and with
--offset to port of its middle. It prints what the cable does to the ship at rest beside the closed form, runs both in waves, coupled and not,
halves the coupling's step, and writes series and a page of figures to target/examples/vessel_coupling. The FMU runs in libcosim,
stepped from Python, or in fmpy where libcosimpy does not exist; both give the same numbers.
"""

import argparse
import importlib.util
import math
import sys
from pathlib import Path

import numpy as np
from common import ROOT, SCENES, SHIP, Failure, motion, packed, table, write_csv
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
    """Rows of weight (N) and place (ship axes, m) of a cable that hangs plumb from the sheave: on the drum, between drum and sheave, and hanging, with
    the body, at the point where it leaves the sheave; what is in the water is lighter by the water it displaces."""
    of = lambda name: parameters.get(name, variables.start(name))
    vector = lambda name: np.array([of(f"{name}[{i}]") for i in (1, 2, 3)])
    weight, thickness = GRAVITY * of("cable.mass_per_length"), of("cable.diameter")
    drum, sheave = of("winch.radius") + 0.5 * thickness, of("sheave[1].radius") + 0.5 * thickness
    wound = drum * of("winch.initial_angle")
    span = vector("sheave[1].position") - vector("winch.position")
    # A common tangent above two circles is as long as their centres are apart but for the radii's difference.
    deck = math.sqrt(span @ span - (drum - sheave) ** 2)
    # The cable turns by a right angle and the slope of the deck's span on the sheave, and leaves abaft of it.
    turned = sheave * (0.5 * math.pi + math.asin((drum - sheave) / np.linalg.norm(span)) + math.atan2(span[2], -span[0]))
    leaves = vector("sheave[1].position") - [sheave, 0.0, 0.0]
    free = of("cable.length") - wound - deck - turned
    rows = [[weight * wound, *vector("winch.position")], [weight * deck, *(vector("winch.position") + 0.5 * span + [0.0, 0.0, 0.5 * (drum + sheave)])]]
    rows.append([weight * turned, *(leaves + [0.5 * sheave, 0.0, 0.5 * sheave])])
    hanging = weight * free + GRAVITY * of("body.mass")
    if "fluid.density" in variables.known:
        wet = free - (leaves[2] - of("fluid.waterline"))
        hanging -= GRAVITY * of("fluid.density") * (0.25 * math.pi * thickness**2 * wet + of("body.volume"))
    return [*rows, [hanging, *leaves]]


def at_rest(fmu, hull, parameters):
    """Sinkage (m), roll and pitch (rad) at which ship and cable rest: coupled, and in closed form."""
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
    runs = {}
    for h in steps:
        vessel = Vessel(hull)
        equilibrium(fmu, vessel, parameters)
        runs[h] = couple(fmu, vessel, h, round(seconds / h), parameters, RECORD, host, excitation)
    finest = min(steps)
    found = {}
    for h, run in runs.items():
        # Communication points of the finest run that this one has.
        every = round(h / finest)
        apart = lambda name, column=None: np.abs(run[name] - runs[finest][name][::every])[(slice(None),) + (() if column is None else (column,))].max()
        work = np.abs(run["work_vessel"] - run["work_cable"]).max() / np.ptp(run["work_vessel"])
        found[h] = [apart("pose", 2), apart("pose", 4), apart("winch.tension"), work]
    return found


def dry_scene():
    """TOML text of `overboard` without water: nothing but ship, cable and body has momentum."""
    text = (SCENES / "overboard.toml").read_text(encoding="utf-8").replace('name = "overboard"', 'name = "overboard_dry"')
    begin, end = text.index("[fluid]"), text.index("[ship]")
    lines = (text[:begin] + text[end:]).splitlines()
    wet = ("volume =", "drag_area =", "drag_coefficient =", "added_mass =")
    return "\n".join(line for line in lines if not line.startswith(wet)) + "\n"


def momentum(fmu, hull, parameters, h, seconds, host="fmpy", push=2e4, lasting=2.0):
    """Pushes the ship forward with push·sin²(πt/lasting) N and compares the way (m) of the common centre of mass of ship, cable and body with that of a
    point of their mass (the double integral, in closed form). Returns times, both ways, and the ship's own."""
    hull.station_period = math.inf
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
    t = np.minimum(run["time"], lasting)
    turn = 2.0 * math.pi / lasting
    way = 0.5 * push / total * (0.5 * t**2 + (np.cos(turn * t) - 1.0) / turn**2 + lasting * (run["time"] - t))
    return run["time"], centre - centre[0], way, run["pose"][:, 0]


def pack_dry(folder):
    """Packs the scene without water; returns the FMU's path."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "overboard_dry.toml"
    path.write_text(dry_scene(), encoding="utf-8")
    return packed(path)


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
    add("--step", 0.02, "coupling's step, s; a tenth of the ramp of 5 s at most")
    add("--converge", 4.0, "seconds of the runs with halved steps; 0 for none")
    parser.add_argument("--host", choices=["fmpy", "libcosim"], default=host_here(), help=f"default here {host_here()}")
    parser.add_argument("--out", type=Path, default=OUT, help="folder of the results")
    return parser


def main():
    args = options().parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    hull = Hull(args.length, args.beam, args.draught)
    fmu, dry = packed("overboard"), pack_dry(args.out / "scenes")
    variables = Variables(fmu)
    parameters = placed(variables, hull, args.offset) | {"body.mass": args.body_mass}
    parts = [f"<p>A ship of {args.length:g} m x {args.beam:g} m x {args.draught:g} m, {1e-3 * hull.displacement:.0f} t; {args.body_mass:g} kg on 150 m of wire.</p>"]

    def show(title, head, rows):
        print(f"{title}\n{table(head, rows)}\n", flush=True)
        parts.append(f"<h2>{title}</h2>{html_table(head, rows)}")

    found, expected = at_rest(fmu, hull, parameters | still_water(variables))
    names, sizes = ["sinkage, mm", "roll, millidegrees", "pitch, millidegrees"], [-1e3, 1e3 * 180 / math.pi, 1e3 * 180 / math.pi]
    rows = [
        [name, "", f"{a * size:.4f}", f"{b * size:.4f}", f"{100 * (a / b - 1) if b else 0:.3f} %"]
        for name, size, a, b in zip(names, sizes, found, expected)
    ]
    show("What the cable does to the ship at rest", ["", "", "coupled", "closed form", "apart"], rows)

    # In waves, coupled and with the ship as if the cable's load stayed what it is at rest.
    sea = dict(hs=args.hs, tp=args.tp, heading=args.heading, length=args.length, beam=args.beam, draught=args.draught, ramp=5.0)
    times, motions = motion(args.out / "motion.csv", duration=args.seconds, step=args.step, **sea)
    runs = {}
    for way, two_way in (("coupled", True), ("one way", False)):
        vessel = Vessel(hull)
        equilibrium(fmu, vessel, parameters)
        runs[way] = couple(fmu, vessel, args.step, len(times) - 1, parameters, RECORD, args.host, excited(hull, times, motions), two_way)
    both, alone = runs["coupled"], runs["one way"]
    change = both["pose"] - alone["pose"]
    rms = lambda x: np.sqrt(np.mean(np.square(x - x[0]), axis=0))
    rows = [
        [name, unit, f"{a * size:.3f}", f"{b * size:.3f}", f"{c * size:.4f}"]
        for name, unit, size, a, b, c in zip(
            ["surge", "sway", "heave", "roll", "pitch", "yaw"], ["mm"] * 3 + ["millideg"] * 3, [1e3] * 3 + [1e3 * 180 / math.pi] * 3,
            rms(alone["pose"]), rms(both["pose"]), np.abs(change).max(axis=0),
        )
    ]  # fmt: skip
    show(f"In waves, {args.seconds:g} s under {args.host}", ["motion", "rms", "one way", "coupled", "changed by up to"], rows)
    work = both["work_vessel"]
    disagree = np.abs(work - both["work_cable"]).max()
    exchanged = f"exchanged at the coupling: {np.ptp(work):.0f} J; its two sides disagree by up to {disagree:.3g} J, {100 * disagree / np.ptp(work):.4f} %"
    print(exchanged + "\n", flush=True)

    small = Hull(16.0, 5.0, 1.2)
    ways = {h: momentum(dry, small, placed(variables, small, 0.0), h, 4.0, args.host) for h in (0.04, 0.02, 0.01)}
    rows = [
        [f"{1e3 * h:g} ms", "", f"{way[-1]:.6f}", f"{1e3 * np.abs(own - way).max():.4f}", f"{1e3 * np.abs(centre - way).max():.4f}"]
        for h, (_, centre, way, own) in ways.items()
    ]
    head = ["step", "", "way of all by Newton, m", "ship's own off, mm", "common centre of mass off, mm"]
    show("Momentum: a ship of 69 t, cable and body in air, pushed forward", head, rows)

    parts += [
        chart("Pitch of the ship", [Line(w, r["time"], np.degrees(r["pose"][:, 4]), c) for (w, r), c in zip(runs.items(), (BLUE, ORANGE))], "time, s", "deg"),
        chart(
            "What the cable's varying load changes",
            [Line(n, both["time"], 1e3 * np.degrees(change[:, i]), c) for n, i, c in (("roll", 3, GREEN), ("pitch", 4, BLUE))],
            "time, s", "millidegrees",
        ),
        chart("Tension at the winch", [Line(w, r["time"], 1e-3 * r["winch.tension"], c) for (w, r), c in zip(runs.items(), (BLUE, ORANGE))], "time, s", "kN"),
        chart(
            "Work of the cable on the ship",
            [Line("as the ship sees it", both["time"], work, BLUE), Line("as the cable sees it", both["time"], both["work_cable"], BLACK, dashed=True)],
            "time, s", "J",
        ),
        f"<p>{exchanged}</p>",
    ]  # fmt: skip
    if args.converge > 0.0:
        steps = [0.04, 0.02, 0.01, 0.005]
        times, motions = motion(args.out / "motion-fine.csv", duration=args.converge, step=steps[-1], **{**sea, "ramp": 0.5 * args.converge})
        fine = parameters | {"solver.tolerance": 1e-6}
        errors = convergence(fmu, hull, fine, excited(hull, times, motions), args.converge, steps, args.host)
        rows = [[f"{1e3 * h:g} ms", "", *(f"{size * e:.3g}" for size, e in zip((1e6, 1e6, 1.0, 100.0), found))] for h, found in errors.items()]
        head = ["step", "", "heave, um", "pitch, urad", "tension, N", "work apart, %"]
        show(f"Against steps of {1e3 * steps[-1]:g} ms, {args.converge:g} s", head, rows)
        coarse = steps[:-1]
        lines = [
            Line(name, [1e3 * h for h in coarse], [errors[h][i] / errors[coarse[0]][i] for h in coarse], colour, marks=True)
            for name, i, colour in (("heave", 0, BLUE), ("pitch", 1, GREEN), ("tension", 2, ORANGE))
        ]
        lines.append(Line("second order", [1e3 * h for h in coarse], [(h / coarse[0]) ** 2 for h in coarse], BLACK, dashed=True))
        parts.append(chart("Error over that of the longest step", lines, "step, ms", "", logarithmic=True))
    for way, run in runs.items():
        columns = {"time": run["time"]} | dict(zip(SHIP, np.hstack([run["pose"], run["rate"]]).T)) | {name: run[name] for name in (*RECORD, "work_vessel", "work_cable")}
        write_csv(args.out / f"{way.replace(' ', '-')}.csv", columns)
    path = args.out / "index.html"
    path.write_text(page("A ship and a cable move each other", parts), encoding="utf-8")
    print(path)


if __name__ == "__main__":
    try:
        main()
    except Failure as failure:
        sys.exit(f"error: {failure}")
