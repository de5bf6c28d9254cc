//! Closed forms of motions: frequencies, a pendulum of large amplitude, a falling sphere, a snap.
//!
//! Frequencies are read from the motion itself: the start shape is a mode, and the period comes from the zero crossings of one point.

use super::bench::{Bench, Drive, record, side_by_side};
use super::numerics::{bessel, elliptic_k, pairs, period, relative_rms, root};
use super::row::{Row, Truth::Exact};
use super::scene::{G, Row as ShapeRow, Wire};
use super::section::Section;
use crate::error::{Failure, Result};
use crate::plots::{Chart, INK, PALETTE, Panel, Series};
use std::f64::consts::PI;

const ANCHOR: &str = "[anchor]\nposition = [0, 0, 0]\n";

/// Rows, and perhaps a chart: file, chart, caption.
type Case = (Vec<Row>, Option<(&'static str, Chart, &'static str)>);

/// The section.
///
/// # Errors
/// The FMU's.
pub fn section(bench: &Bench) -> Result<Section> {
    let cases: [fn(&Bench) -> Result<Case>; 6] = [bar, chain, beam, pendulum, sphere, snap];
    let mut rows = Vec::new();
    let mut charts = Vec::new();
    for case in side_by_side(&cases, |case| case(bench)) {
        let (more, chart) = case?;
        rows.extend(more);
        charts.extend(chart);
    }
    let mut section = Section::new("Closed forms: motions")
        .text(
            "Frequencies are measured on the motion: the start shape is a mode of small amplitude, the period comes from the zero crossings of a \
             point.",
        )
        .rows(rows);
    for (file, chart, caption) in charts {
        section = section.chart(file, chart, caption);
    }
    Ok(section)
}

/// Rows of a start shape of `count` intervals.
fn shape(length: f64, count: usize, f: impl Fn(f64) -> ([f64; 3], [f64; 3], [f64; 3])) -> Vec<ShapeRow> {
    (0..=count)
        .map(|i| {
            let s = length * i as f64 / count as f64;
            let (r, t, v) = f(s);
            (s, r, t, v)
        })
        .collect()
}

fn measured_period(times: &[f64], x: &[f64], what: &str) -> Result<f64> {
    period(times, x).ok_or_else(|| Failure(format!("{what}: no swing in the record")))
}

/// A bar with a mass at its tip: β tan β = m_l L/m, ω = β/L √(EA/m_l).
fn bar(bench: &Bench) -> Result<Case> {
    let wire = Wire { length: 50.0, diameter: 0.02, mass_per_length: 1.2, ea: 5e6, ei: 0.0, laws: "" };
    let (tip, pull, amplitude) = (90.0, 5e3, 1e-3);
    let mut rows = Vec::new();
    for n in 0..2 {
        let start_at = f64::from(n) * PI;
        let beta = root(|b| b * b.tan() - wire.mass_per_length * wire.length / tip, start_at + 1e-9, start_at + 0.5 * PI - 1e-9);
        let omega = beta / wire.length * (wire.ea / wire.mass_per_length).sqrt();
        let (stretch, k) = (1.0 + pull / wire.ea, beta / wire.length);
        let start_shape = shape(wire.length, 400, |s| {
            let (sin, cos) = (k * s).sin_cos();
            ([stretch * s + amplitude * sin, 0.0, 0.0], [stretch + amplitude * k * cos, 0.0, 0.0], [0.0; 3])
        });
        let rest = format!("{ANCHOR}[body]\nmass = {tip:?}\nforce_input = true\n[solver]\ntolerance = 1e-6\n");
        let scene = wire.scene(0.0, 24, 0, &rest)?.start_shape(&start_shape);
        let exact = 2.0 * PI / omega;
        let drive = Drive { inputs: &["body.force.x"], at: &|_| vec![pull], ..Drive::still(exact / 40.0, 5.3 * exact) };
        let run = record(&bench.pack(&scene)?, &drive, ["anchor.force.x"])?;
        let force: Vec<f64> = run.columns[0].iter().map(|f| f - pull).collect();
        let found = measured_period(&run.times, &force, "bar")?;
        rows.push(
            Row::relative(Exact, format!("Axial bar with tip mass, mode {}: frequency", n + 1), 2.0 * PI / found, omega, "rad/s")
                .within(1e-5)
                .because(
                    "β tan β = m_l L/m; crossings by cubics at 40 samples a period 2e-6, the integrator's tolerance 1e-6, mesh below both",
                ),
        );
    }
    Ok((rows, None))
}

/// A hanging chain: ω = (j₀/2) √(g/L), shape J₀(2ω √((L − s)/g)).
fn chain(bench: &Bench) -> Result<Case> {
    let wire = Wire { length: 5.0, diameter: 0.01, mass_per_length: 0.8, ea: 1e7, ei: 0.0, laws: "damping.axial = 1e4" };
    let mut rows = Vec::new();
    for (n, zero) in [(1, 2.404_825_557_695_773), (2, 5.520_078_110_286_311)] {
        let omega = 0.5 * zero * (G / wire.length).sqrt();
        let amplitude = 1e-4 * wire.length;
        let w = wire.mass_per_length * G;
        let start_shape = shape(wire.length, 800, |s| {
            let left = (wire.length - s).max(0.0);
            let x = 2.0 * omega * (left / G).sqrt();
            let [j0, j1] = bessel(x);
            // d/ds J₀(2ω √((L−s)/g)) = J₁ ω/√(g (L−s)); J₁(x) → x/2 at the free end.
            let slope = amplitude * if left > 1e-12 { j1 * omega / (G * left).sqrt() } else { omega * omega / G };
            let tangent = 1.0 + w * left / wire.ea;
            let z = -s - w * (wire.length * s - 0.5 * s * s) / wire.ea;
            ([amplitude * j0, 0.0, z], [slope, 0.0, -(tangent * tangent - slope * slope).sqrt()], [0.0; 3])
        });
        let scene = wire.scene(G, 24, 2, &format!("{ANCHOR}[solver]\ntolerance = 1e-6\n"))?.start_shape(&start_shape);
        let exact = 2.0 * PI / omega;
        let run = record(&bench.pack(&scene)?, &Drive::still(exact / 40.0, 5.3 * exact), ["cable.point[2].x"])?;
        let found = measured_period(&run.times, &run.columns[0], "chain")?;
        rows.push(
            Row::relative(Exact, format!("Hanging chain, mode {n}: frequency"), 2.0 * PI / found, omega, "rad/s")
                .within(1e-5)
                .because("J₀'s zeros (Abramowitz & Stegun, table 9.5); crossings by cubics 2e-6, stretch up to 4e-6, amplitude² 1e-8"),
        );
    }
    Ok((rows, None))
}

/// A simply supported beam under a little pull: ω² = k²/m (T/λ + EI k²/λ²), k = nπ/L over the unstretched length.
fn beam(bench: &Bench) -> Result<Case> {
    let wire =
        Wire { length: 1.0, diameter: 0.01, mass_per_length: 0.5, ea: 1e5, ei: 2.0, laws: "compression = \"linear\"\ndamping.axial = 30" };
    let (strain, amplitude) = (1e-5, 1e-5);
    let mut rows = Vec::new();
    for n in 1..=2 {
        let (k, stretch, tension) = (f64::from(n) * PI / wire.length, 1.0 + strain, wire.ea * strain);
        let omega = (k * k / wire.mass_per_length * (tension / stretch + wire.ei * k * k / stretch.powi(2))).sqrt();
        let start_shape = shape(wire.length, 400, |s| {
            let (sin, cos) = (k * s).sin_cos();
            ([stretch * s, 0.0, amplitude * sin], [stretch, 0.0, amplitude * k * cos], [0.0; 3])
        });
        let rest = format!("{ANCHOR}[far_end]\nposition = [{stretch:?}, 0, 0]\n[solver]\ntolerance = 1e-6\n");
        // The second of five points is at L/4, where both modes move.
        let scene = wire.scene(0.0, 16, 5, &rest)?.start_shape(&start_shape);
        let exact = 2.0 * PI / omega;
        let run = record(&bench.pack(&scene)?, &Drive::still(exact / 40.0, 5.3 * exact), ["cable.point[2].z"])?;
        let found = measured_period(&run.times, &run.columns[0], "beam")?;
        rows.push(
            Row::relative(Exact, format!("Simply supported beam, mode {n}: frequency"), 2.0 * PI / found, omega, "rad/s")
                .within(2e-5)
                .because("Euler-Bernoulli with pull; cubic elements add (kh)⁴/1440 (2e-5·n⁴/16), stretching by the bend itself EA A²/(4 EI) = 1e-6"),
        );
    }
    Ok((rows, None))
}

fn pendulum(bench: &Bench) -> Result<Case> {
    // Light and stiff beside the body: the cable's mass shortens the period by m_l L/(12 m) = 2e-6, its stretch lengthens it by about 5e-6.
    let wire = Wire { length: 2.0, diameter: 1e-3, mass_per_length: 1e-5, ea: 1e6, ei: 0.0, laws: "" };
    let angle = 80f64.to_radians();
    let rest = format!(
        "{ANCHOR}[body]\nmass = 1.0\n[initial]\nstate = \"released\"\ndirection = [{:?}, 0, {:?}]\n[solver]\ntolerance = 1e-4\n",
        angle.sin(),
        -angle.cos()
    );
    let run = record(
        &bench.pack(&wire.scene(G, 4, 0, &rest)?)?,
        &Drive::still(0.01, 12.0),
        ["body.x", "body.z", "body.vx", "body.vz", "body.tension"],
    )?;
    let [x, z, vx, vz, tension] = &run.columns;
    let found = measured_period(&run.times, x, "pendulum")?;
    let exact = 4.0 * (wire.length / G).sqrt() * elliptic_k((0.5 * angle).sin());
    // m (g cos θ + v²/L) along the way.
    let statics: Vec<f64> = (0..x.len()).map(|i| (-G * z[i] + vx[i] * vx[i] + vz[i] * vz[i]) / wire.length).collect();
    let rows = vec![
        Row::relative(Exact, "Pendulum from 80°: period", found, exact, "s")
            .within(1e-5)
            .because("4 √(L/g) K(sin θ/2); the cable's mass 2e-6 and stretch 5e-6"),
        Row::error(Exact, "Pendulum from 80°: tension rms against m (g cos θ + v²/L), over its own", relative_rms(&pairs(tension, &statics)), "")
            .within(8e-4)
            .because("tolerance 1e-4; this cable damps nothing, so errors of the steps go on ringing: 8 times the tolerance, as in fmu-tests/rust/convergence.rs; single samples of the least tension are off by more, about 0.2 %"),
    ];
    Ok((rows, None))
}

fn sphere(bench: &Bench) -> Result<Case> {
    // A cable that weighs nothing in water and meets no drag, in a bight beside the body.
    let (rho, half, r) = (1000.0, 10.0, 0.05);
    let d: f64 = 5e-4;
    let wire = Wire {
        length: 2.0 * half,
        diameter: d,
        mass_per_length: rho * PI / 4.0 * d * d,
        ea: 100.0,
        ei: 1e-7,
        laws: "damping.axial = 0.01",
    };
    let start_shape = shape(wire.length, 400, |s| {
        let (straight, turn) = (half - 0.5 * PI * r, (s - half + 0.5 * PI * r) / r);
        let (sin, cos) = turn.sin_cos();
        if s < straight {
            ([0.0, 0.0, -s], [0.0, 0.0, -1.0], [0.0; 3])
        } else if turn < PI {
            ([r - r * cos, 0.0, -straight - r * sin], [sin, 0.0, -cos], [0.0; 3])
        } else {
            ([2.0 * r, 0.0, -straight + (s - straight - PI * r)], [0.0, 0.0, 1.0], [0.0; 3])
        }
    });
    let (mass, volume, area, cd, added) = (8.0, 1e-3, 0.012, 0.5, 0.5);
    let rest = format!(
        "{ANCHOR}[fluid]\ndensity = {rho:?}\nwaterline = 10\nadded_mass = 0\ndrag = {{ law = \"cross_flow\", cd_normal = 0, cd_tangential = 0 }}\n\
         [body]\nmass = {mass:?}\nvolume = {volume:?}\ndrag_area = {area:?}\ndrag_coefficient = {cd:?}\nadded_mass = {added:?}\n\
         [solver]\ntolerance = 1e-4\n"
    );
    let scene = wire.scene(G, 80, 0, &rest)?.start_shape(&start_shape);
    let run = record(&bench.pack(&scene)?, &Drive::still(0.05, 3.0), ["body.vz"])?;
    let weight = (mass - rho * volume) * G;
    let terminal = (2.0 * weight / (rho * cd * area)).sqrt();
    let tau = (mass + added * rho * volume) * terminal / weight;
    let exact: Vec<f64> = run.times.iter().map(|t| -terminal * (t / tau).tanh()).collect();
    let off = run.columns[0].iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let rows = vec![
        Row::relative(Exact, "Dropped sphere: velocity after 3 s, terminal", -run.columns[0][60], -exact[60], "m/s")
            .within(2.5e-4)
            .because("√(2W/(ρ C A)) tanh(t/τ), t = 10 τ; the cable's mass moves with it, 2e-4 of the inertia"),
        Row::error(Exact, "Dropped sphere: greatest error of the velocity on the way, over terminal", off / terminal, "")
            .within(2.5e-4)
            .because("the same"),
    ];
    let series = vec![
        Series::new("fairlead", &run.times, &run.columns[0], PALETTE[0]).width(3.4),
        Series::new("closed form", &run.times, &exact, INK).dashed().width(1.3),
    ];
    let chart = Chart::new("A sphere dropped in still water", "Time, s", vec![Panel::new("Velocity, m/s", series)]);
    Ok((rows, Some(("sphere", chart, "The velocity of a dropped sphere over the closed form; the time constant is τ = 0.3 s."))))
}

fn snap(bench: &Bench) -> Result<Case> {
    let wire =
        Wire { length: 10.0, diameter: 0.01, mass_per_length: 0.5, ea: 2e5, ei: 0.0, laws: "compression = \"linear\"\ndamping.axial = 20" };
    let v = 0.8;
    let start_shape = shape(wire.length, 1, |s| ([s, 0.0, 0.0], [1.0, 0.0, 0.0], [v, 0.0, 0.0]));
    let scene = wire.scene(0.0, 100, 0, &format!("{ANCHOR}[solver]\ntolerance = 1e-3\n"))?.start_shape(&start_shape);
    let transit = wire.length / (wire.ea / wire.mass_per_length).sqrt();
    let exact = v * (wire.ea * wire.mass_per_length).sqrt();
    let run = record(&bench.pack(&scene)?, &Drive::still(transit / 200.0, 2.4 * transit), ["anchor.force.x"])?;
    let share: Vec<f64> = run.times.iter().map(|t| t / transit).collect();
    let plateau: Vec<f64> = share.iter().zip(&run.columns[0]).filter(|(t, _)| (0.3..1.7).contains(*t)).map(|(_, f)| *f).collect();
    let mean = plateau.iter().sum::<f64>() / plateau.len() as f64;
    let rows = vec![
        Row::relative(Exact, "Snap of a moving bar at a stop: tension of the plateau", mean, exact, "N")
            .within(2e-4)
            .because("ΔT = v √(EA m_l); the front, widened by the damping, fades by 0.3 and 1.7 transit times"),
    ];
    let series = vec![
        Series::new("fairlead, 100 elements", &share, &run.columns[0], PALETTE[0]),
        Series::new("v √(EA m_l)", &[0.0, 2.0], &[exact, exact], INK).dashed().width(1.2),
    ];
    let chart = Chart::new("Snap", "Time over the wave's transit time", vec![Panel::new("Force on the stop, N", series)]);
    Ok((
        rows,
        Some(("snap", chart, "Force on the stop of a bar that flies into it: the plateau lasts until the wave returns from the free end.")),
    ))
}
