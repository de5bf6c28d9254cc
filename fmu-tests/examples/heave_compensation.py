"""An active heave compensation in Python drives the winch of `overboard` through fmpy, in sea states 3 to 6.

    cargo xtask example heave_compensation [OPTIONS]

For each sea state the ship moves as `cargo xtask ship-motion` says, and the 400 kg body at the end of 150 m of wire is held in several ways:
with the winch still, with the controller of `ahc.py` outside the FMU (100 Hz, a late and noisy sensor), with the FMU's own algorithm, and, with
--ideal, with a perfect sensor and an ideal winch. It prints one table and writes it as CSV, with every run's series and a page of figures,
to target/examples/heave_compensation. A simulated second takes one or two: with everything it takes half an hour on one core.

The least line load on the sheave is no finer than the mesh: where it comes near zero, as in sea state 6, look again with --mesh-error 1e-3, which
takes about twice as long. With elements of 5 cm instead of 10 cm the detachments that the table shows there are gone.

The scene is a variant of modelDescription/scenes/overboard.toml: one more turn of wire lies on the drum, and the mesh is fine as
much farther from the sheave, because a ship in sea state 6 lifts its stern by more than the 2.2 m that the built-in scene can pay out.
"""

import argparse
import math
import multiprocessing
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

import ahc
import numpy as np
from common import ROOT, SCENES, SEA_STATES, SHIP, Failure, motion, rotation, table, turning, variant, write_csv
from figures import BLACK, BLUE, GREEN, ORANGE, PURPLE, RED, Line, chart, html_table, page
from slave import FmpySlave, Variables

OUT = ROOT / "target" / "examples" / "heave_compensation"
# Bow quartering seas: 150 degrees from the ship's x axis, as the scene's own comment has them.
HEADING = 150
HELD, EXTERNAL, IDEAL = "winch held", "controller", "ideal"
BUILT_IN = ["simplified_sheave", "sheave", "waterline"]
COLOURS = {HELD: BLACK, EXTERNAL: BLUE, IDEAL: GREEN, "simplified_sheave": ORANGE, "sheave": RED, "waterline": PURPLE}

# What the ideal winch has: 1/k₁ of an acceleration is no lag to speak of, and no limit is met.
IDEAL_WINCH = {"winch.gain_position": 1e4, "winch.gain_rate": 200.0, "winch.max_rate": 100.0, "winch.max_acceleration": 1e4}

RECORD = {
    "body_z": "body.z", "tension": "winch.tension", "payout": "winch.payout", "rate": "winch.rate", "torque": "winch.torque",
    "line_load_min": "sheave[1].line_load_min", "tension_min": "cable.tension_min",
}


def deep_scene(setpoint="external", mesh_error=1e-2):
    """TOML text of the variant of `overboard`, named overboard_deep or overboard_deep_SETPOINT, with its mesh graded for `mesh_error`."""
    text = (SCENES / "overboard.toml").read_text(encoding="utf-8")
    turn = 2.0 * math.pi * 0.508
    changes = {
        'name = "overboard"': 'name = "overboard_deep"' if setpoint == "external" else f'name = "overboard_deep_{setpoint}"',
        "length = 150.0\n": f"length = {150.0 + turn!r}\n",
        "angle = 4.71238898038469 ": f"angle = {4.71238898038469 + 2.0 * math.pi!r} ",
        "error = 1e-2 ": f"error = {mesh_error!r} ",
        "travel = 2.0\n": "travel = 3.5\n",
        'command = "payout"': f'command = "payout"\nsetpoint = "{setpoint}"',
    }
    for old, new in changes.items():
        if text.count(old) != 1:
            raise Failure(f"overboard.toml: expected `{old}` once; this example changes it")
        text = text.replace(old, new)
    return text


class Hang:
    """The point that the cable hangs from: where it leaves the last sheave, as a point of the ship, and the cable's direction there in the calm."""

    def __init__(self, variables, points):
        """From the FMU's parameters and the calm cable's points, [k][3], in inertial axes (the ship lies at its mean pose, the origin)."""
        self.stock = variables.start("winch.initial_angle") * (variables.start("winch.radius") + 0.5 * variables.start("cable.diameter"))
        centre, axis = (np.array(variables.vector(f"sheave[1].{name}")) for name in ("position", "axis"))
        radius = variables.start("sheave[1].radius") + 0.5 * variables.start("cable.diameter")
        # The first chord below the sheave.
        top = int(np.argmax(points[:, 2]))
        chord = points[top + 2] - points[top + 1]
        self.down = chord / np.linalg.norm(chord)
        outwards = np.cross(self.down, axis)
        outwards *= np.sign(outwards @ (points[top + 1] - centre)) / np.linalg.norm(outwards)
        self.point = centre + radius * outwards

    def along(self, ship):
        """How far (m) and how fast (m/s) the point has moved up along the cable, and how high it has moved (m), for the values of SHIP."""
        turned = rotation(ship[3:6])
        place = ship[:3] + turned @ self.point
        velocity = ship[6:9] + turned @ np.cross(turning(ship[3:6]) @ ship[9:12], self.point)
        shift = place - self.point
        return -self.down @ shift, -self.down @ velocity, shift[2]


@dataclass
class Run:
    """Series of one run, and what it comes to after the ramp."""

    way: str
    state: int
    series: dict = field(default_factory=dict)
    results: dict = field(default_factory=dict)


# What `Run.results` holds: CSV column, heading, number format.
COLUMNS = [
    ("heave_rms", "sheave m", ".3f"), ("residual_rms", "body m", ".4f"), ("share", "share %", ".2f"), ("tension_least", "T min kN", ".2f"),
    ("tension_greatest", "T max kN", ".2f"), ("line_load_least", "load kN/m", ".2f"), ("detached", "detached %", ".2f"),
    ("power_mean", "power kW", ".2f"), ("power_peak", "peak kW", ".1f"), ("rate_peak", "rate m/s", ".2f"), ("clipped", "clipped %", ".2f"),
]


def drive(fmu, way, times, ship, settings, parameters):
    """Runs the FMU over the ship's motion, the winch held, driven by the controller, or by the FMU itself; returns the series."""
    variables = Variables(fmu)
    controlled = way in (HELD, EXTERNAL, IDEAL)
    inputs = SHIP + (["winch.setpoint", "winch.setpoint_rate"] if controlled else [])
    points = [f"cable.point[{k}].{c}" for k in range(1, 20) for c in "xyz"]
    gain = parameters.get("winch.gain_position", variables.start("winch.gain_position"))
    series = {name: [] for name in ("time", "heave", *RECORD)}
    with FmpySlave(fmu, inputs, list(RECORD.values()) + points, parameters) as slave:
        out = slave.get()
        hang = Hang(variables, np.array(out[len(RECORD) :]).reshape(-1, 3))
        radius = variables.start("winch.radius") + 0.5 * variables.start("cable.diameter")
        sense = variables.start("winch.direction")
        controller = ahc.Controller(settings, gain)
        place = {name: i for i, name in enumerate(RECORD)}
        for k in range(len(times)):
            position, velocity, heave = hang.along(ship[k])
            for name, value in zip(series, (times[k], heave, *out)):
                series[name].append(value)
            if k + 1 == len(times):
                break
            command = ()
            if way in (EXTERNAL, IDEAL):
                command = controller.command((position, velocity), out[place["payout"]], sense * radius * out[place["rate"]])
            elif way == HELD:
                command = (0.0, 0.0)
            out = slave.step(times[k], times[k + 1] - times[k], (*ship[k], *command))
        if max(series["payout"]) > hang.stock - 0.25 * math.tau * radius:
            raise Failure(f"{way}: the winch paid out {max(series['payout']):.2f} m; only {hang.stock:.2f} m of cable lie on its drum")
    return {name: np.array(values) for name, values in series.items()}


def results(series, ramp, radius, max_rate):
    """What the series come to after `ramp` seconds. Power is winch.torque times winch.rate: what the cable does to the drum, and the drum's drive
    takes up where it is positive or puts in where it is negative; the drum itself has no inertia."""
    after = {name: values[series["time"] >= ramp] for name, values in series.items()}
    heave, body = after["heave"].std(), after["body_z"].std()
    power = after["torque"] * after["rate"]
    return {
        "heave_rms": heave, "residual_rms": body, "share": 100.0 * body / heave,
        "tension_least": 1e-3 * after["tension"].min(), "tension_greatest": 1e-3 * after["tension"].max(),
        "line_load_least": 1e-3 * after["line_load_min"].min(), "detached": 100.0 * np.mean(after["line_load_min"] <= 0.0),
        "power_mean": 1e-3 * np.abs(power).mean(), "power_peak": 1e-3 * np.abs(power).max(),
        "rate_peak": radius * np.abs(after["rate"]).max(), "clipped": 100.0 * np.mean(np.abs(after["rate"]) > 0.999 * max_rate),
    }


def run_case(fmu, way, state, sea, settings, ramp):
    """One row of the table; `sea` is what `motion` returns."""
    parameters = IDEAL_WINCH if way == IDEAL else {}
    settings = ideal(settings) if way == IDEAL else settings
    series = drive(fmu, way, *sea, settings, parameters)
    variables = Variables(fmu)
    radius = variables.start("winch.radius") + 0.5 * variables.start("cable.diameter")
    return Run(way, state, series, results(series, ramp, radius, parameters.get("winch.max_rate", variables.start("winch.max_rate"))))


def ideal(settings):
    """The same feed-forward with a sensor that tells the truth at once. The PD controller is off: the ideal winch's own is far faster than the
    controller's samples, and a second one around it, 10 ms late, would make it unstable."""
    off = {"delay": 0.0, "assumed_delay": None, "noise": 0.0, "noise_rate": 0.0, "gain_position": 0.0, "gain_rate": 0.0}
    return ahc.Settings(**{**vars(settings), **off})


def sea_motion(state, folder, seconds, ramp, step, seed):
    """Motion of the ship in a sea state, growing out of rest over `ramp` seconds."""
    height, period = SEA_STATES[state]
    sizes = dict(hs=height, tp=period, heading=HEADING, seed=seed, duration=ramp + seconds, step=step, ramp=ramp)
    return motion(folder / f"motion-{state}.csv", **sizes)


def rows(runs):
    """Head and rows of the table, as text."""
    cells = lambda run: [format(float(run.results[name]), form) for name, _, form in COLUMNS]
    return ["sea", "winch", *(head for _, head, _ in COLUMNS)], [[str(run.state), run.way, *cells(run)] for run in runs]


def report(runs, ramp, folder, explained):
    """Writes table, series and page; returns the page's path."""
    columns = {"sea_state": [run.state for run in runs], "winch": [run.way for run in runs]}
    columns.update((name, [float(run.results[name]) for run in runs]) for name, _, _ in COLUMNS)
    write_csv(folder / "table.csv", columns)
    for run in runs:
        write_csv(folder / f"sea-state-{run.state}-{run.way.replace(' ', '-')}.csv", run.series)
    parts = [f"<p>{explained}</p>", html_table(*rows(runs))]
    states = sorted({run.state for run in runs})
    of = lambda state: [run for run in runs if run.state == state]
    line = lambda run, y: Line(run.way, run.series["time"], y, COLOURS[run.way])
    height = lambda run: run.series["body_z"] - run.series["body_z"][run.series["time"] >= ramp].mean()
    ways = list(dict.fromkeys(run.way for run in runs))
    if len(states) > 1:
        shares = [(way, [run for run in runs if run.way == way]) for way in ways if way != HELD]
        lines = [Line(way, [r.state for r in of_way], [r.results["share"] for r in of_way], COLOURS[way], marks=True) for way, of_way in shares]
        parts.append(chart("What remains of the heave at the sheave", lines, "sea state", "body heave, %", zero=True, whole=True))
    for state in states:
        runs_here = of(state)
        parts.append(f"<h2>Sea state {state}: significant wave height {SEA_STATES[state][0]} m, peak period {SEA_STATES[state][1]} s</h2>")
        sheave = Line("sheave", runs_here[0].series["time"], runs_here[0].series["heave"], RED, dashed=True)
        parts.append(chart("Height of sheave and body", [sheave, *(line(run, height(run)) for run in runs_here)], "time, s", "m"))
        moved = [run for run in runs_here if run.way != HELD]
        if moved:
            parts.append(chart("Height of the body", [line(run, 1e3 * height(run)) for run in moved], "time, s", "mm"))
        parts.append(chart("Tension at the winch", [line(run, 1e-3 * run.series["tension"]) for run in runs_here], "time, s", "kN", zero=True))
        load = [line(run, 1e-3 * run.series["line_load_min"]) for run in runs_here]
        parts.append(chart("Least line load on the sheave", load, "time, s", "kN/m", zero=True))
        if moved:
            parts.append(chart("Payout of the winch", [line(run, run.series["payout"]) for run in moved], "time, s", "m"))
    path = folder / "index.html"
    path.write_text(page("Heave compensation on overboard", parts), encoding="utf-8")
    return path


def options():
    parser = argparse.ArgumentParser(prog="heave_compensation", description=__doc__.split("\n")[0])
    parser.add_argument("--sea-states", default="3,4,5,6", metavar="N,...", help=f"of {sorted(SEA_STATES)}; default 3,4,5,6")
    parser.add_argument("--seconds", type=float, default=60.0, help="that count, after the ramp; default 60")
    parser.add_argument("--ramp", type=float, default=10.0, help="seconds in which the ship's motion grows out of rest; default 10")
    parser.add_argument("--sea-seed", type=int, default=1, help="of the waves; default 1")
    parser.add_argument("--ideal", action="store_true", help="run a sensor without delay and noise and an ideal winch, too")
    parser.add_argument("--built-in", default="simplified_sheave", metavar="NAME,...", help=f"of {', '.join(BUILT_IN)}, or none")
    parser.add_argument("--mesh-error", type=float, default=1e-2, metavar="X", help="mesh.error of the scene; default 1e-2")
    parser.add_argument("--jobs", type=int, default=1, help="runs at a time; default 1")
    parser.add_argument("--out", type=Path, default=OUT, help="folder of the results")
    controller = parser.add_argument_group("sensor and controller", "see ahc.py")
    for name, value in vars(ahc.Settings()).items():
        default = "the delay" if name == "assumed_delay" else "the sea's peak period" if name == "period" else value
        kind = int if name == "seed" else float
        controller.add_argument(f"--{name.replace('_', '-')}", type=kind, metavar="X", help=f"default {default}")
    return parser


def chosen(args):
    """Sea states and built-in algorithms asked for."""
    states = [int(text) if text.strip().isdigit() else 0 for text in args.sea_states.split(",")]
    if not set(states) <= set(SEA_STATES):
        raise Failure(f"--sea-states {args.sea_states}: expected some of {sorted(SEA_STATES)}, separated by commas")
    built_in = [] if args.built_in == "none" else args.built_in.split(",")
    if not set(built_in) <= set(BUILT_IN):
        raise Failure(f"--built-in {args.built_in}: expected some of {', '.join(BUILT_IN)}, separated by commas, or none")
    return states, built_in


def main():
    args = options().parse_args()
    states, built_in = chosen(args)
    given = {name: value for name in vars(ahc.Settings()) if (value := getattr(args, name)) is not None}
    args.out.mkdir(parents=True, exist_ok=True)
    external = variant(deep_scene(mesh_error=args.mesh_error), args.out / "scenes")
    fmus = {HELD: external, EXTERNAL: external}
    fmus.update((name, variant(deep_scene(name, args.mesh_error), args.out / "scenes")) for name in built_in)
    if args.ideal:
        fmus[IDEAL] = external
    jobs = []
    for state in states:
        settings = ahc.Settings(**{"period": SEA_STATES[state][1], **given})
        sea = sea_motion(state, args.out, args.seconds, args.ramp, settings.step, args.sea_seed)
        jobs += [(fmu, way, state, sea, settings, args.ramp) for way, fmu in fmus.items()]
    runs = []
    with ProcessPoolExecutor(max_workers=max(1, args.jobs), mp_context=multiprocessing.get_context("spawn")) as pool:
        begin = time.monotonic()
        for job, future in [(job, pool.submit(run_case, *job)) for job in jobs]:
            runs.append(future.result())
            share, seconds = runs[-1].results["share"], time.monotonic() - begin
            print(f"sea state {job[2]}, {job[1]}: body {share:.2f} % of the sheave's heave ({seconds:.0f} s)", flush=True)
    head, body = rows(runs)
    print("\n" + table(head, body) + "\n")
    explained = (
        f"{args.seconds:g} s after {args.ramp:g} s of ramp. Sheave, body: standard deviations of their heights; share: the body's of the sheave's. "
        "T: tension at the winch. Load: least line load within the sheave's contact arc, run-in left out; detached: time in which it is zero. Power: "
        "drum's torque times rate, mean and peak of its magnitude. Rate: greatest speed of the cable at the drum; clipped: time at max_rate. "
        "The least line load wants a finer mesh where it nears zero (--mesh-error 1e-3). "
        f"Sensor and controller: {', '.join(f'{k} {v}' for k, v in vars(settings).items() if k not in ('period', 'assumed_delay'))}."
    )
    path = report(runs, args.ramp, args.out, explained)
    if args.ideal:
        worst = max(run.results["share"] for run in runs if run.way == IDEAL)
        print(f"ideal sensor and winch: at most {worst:.2f} % of the sheave's heave remain at the body; wanted are less than 5 %")
        if worst >= 5.0:
            raise Failure("too much remains")
    print(path)


if __name__ == "__main__":
    try:
        main()
    except Failure as failure:
        sys.exit(f"error: {failure}")
