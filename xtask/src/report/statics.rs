//! Closed forms of equilibria: elastica, elastic catenary, the long tow.

use super::bench::{Bench, point, side_by_side, start, vector};
use super::numerics::{root, table};
use super::row::{Row, Truth::Exact};
use super::scene::{G, NYLON, Wire};
use super::section::Section;
use super::wire::catenary as catenary_form;
use crate::error::Result;
use crate::plots::{Chart, INK, PALETTE, Panel, Series};
use nalgebra::Vector3;
use std::f64::consts::PI;

/// The boundary-value solution of P2: s, x, z, θ, M.
pub const ELASTICA: &str = include_str!("../../../fmu-tests/references/p2_elastica.csv");

/// The cantilever of P2: a drum whose top is the origin holds the slope along x.
pub const CANTILEVER: Wire = Wire { length: 0.0464, ea: 222.660_379, laws: "compression = \"linear\"", ..NYLON };

/// What is at the cantilever's two ends.
pub const CLAMPED: &str = "[winch]\nposition = [0, 0, -0.100225]\naxis = [0, 1, 0]\nradius = 0.1\ngain_position = 1\ngain_rate = 1\n\
                           direction = 1\nend = \"tangent\"\n[body]\nmass = 1.33e-3\n";

type Case = fn(&Bench) -> Result<Vec<Row>>;

/// The section.
///
/// # Errors
/// The FMU's.
pub fn section(bench: &Bench) -> Result<Section> {
    let (mut rows, chart) = elastica(bench)?;
    let cases: [Case; 2] = [catenary, tow];
    for case in side_by_side(&cases, |case| case(bench)) {
        rows.extend(case?);
    }
    Ok(Section::new("Closed forms: equilibria")
        .text(
            "Starts from rest: the FMU finds the static equilibrium before the first step. The elastica is a nylon of 46.4 mm clamped level \
             with 1.33 g at its tip, the cantilever from whose photograph the thesis takes EI.",
        )
        .rows(rows)
        .table(
            &["P2: program", "Elements", "Tip error over length"],
            [
                ("Exudyn 1.13.6, full axial quadrature", "8", "1.9e-3"),
                ("Exudyn, Lobatto and Gauss mixed", "8", "2.2e-4"),
                ("Exudyn, full axial quadrature", "16", "8e-5"),
                ("Exudyn, Lobatto and Gauss mixed", "16", "1.5e-5"),
                ("Exudyn, full axial quadrature", "64", "3e-8"),
                ("Exudyn, Lobatto and Gauss mixed", "64", "6e-8"),
            ]
            .map(|(program, elements, error)| [program, elements, error].map(str::to_owned).to_vec())
            .to_vec(),
        )
        .text("The mixed rule is better at rest; in contact it showed hourglass noise.")
        .chart("elastica", chart, "The cantilever's shape, 32 elements, over the boundary-value solution of the elastica."))
}

fn elastica(bench: &Bench) -> Result<(Vec<Row>, Chart)> {
    let reference = table(ELASTICA);
    let mut rows = Vec::new();
    let mut shape = Vec::new();
    // The mesh's share is measured by the Rust tests: 1.3e-3, 5.3e-5, 1.2e-6; the scene's clamp gives way by 1e-4 of the first element's turn.
    for (elements, bound) in [(8, 1.35e-3), (16, 5.6e-5), (32, 3.4e-6)] {
        let sim = bench.rest(&CANTILEVER.scene(G, elements, reference.len(), CLAMPED)?)?;
        shape = (1..=reference.len()).map(|k| point(&sim, k)).collect::<Result<Vec<_>>>()?;
        let far = shape.iter().zip(&reference).map(|(p, r)| (p[0] - r[1]).hypot(p[2] - r[2])).fold(0.0, f64::max);
        let row = Row::error(Exact, format!("Elastica, {elements} elements: greatest distance over length"), far / CANTILEVER.length, "");
        rows.push(row.within(bound).because("P2, boundary-value solve to 1e-9; cubic elements, and from 32 elements on the drum's clamp"));
    }
    let column = |f: &dyn Fn(&[f64; 3]) -> f64| shape.iter().map(|p| 1e3 * f(p)).collect::<Vec<f64>>();
    let truth = |k: usize| reference.iter().map(|r| 1e3 * r[k]).collect::<Vec<f64>>();
    let series = vec![
        Series::new("fairlead", &column(&|p| p[0]), &column(&|p| p[2]), PALETTE[0]).width(3.4),
        Series::new("elastica", &truth(1), &truth(2), INK).dashed().width(1.3),
    ];
    let chart = Chart { equal_aspect: true, width: 640.0, ..Chart::new("Elastica", "x, mm", vec![Panel::new("z, mm", series)]) };
    Ok((rows, chart))
}

fn catenary(bench: &Bench) -> Result<Vec<Row>> {
    let wire = Wire { length: 10.0, diameter: 0.01, mass_per_length: 1.0, ea: 2e4, ei: 0.0, laws: "" };
    let mass = 1e-3;
    let rest = format!("[anchor]\nposition = [1, 2, 3]\n[body]\nmass = {mass:?}\nforce_input = true\n");
    let fmu = bench.pack(&wire.scene(G, 32, 0, &rest)?)?;
    let mut rows = Vec::new();
    for (name, force) in [("pulled sideways", [60.0, 20.0, 0.0]), ("sagging below both ends", [30.0, -15.0, 60.0])] {
        let inputs: Vec<_> = ["body.force.x", "body.force.y", "body.force.z"].into_iter().zip(force).collect();
        let sim = start(&fmu, &[], &inputs)?;
        let (tip, first) = catenary_form(&wire, Vector3::from(force) - Vector3::z() * mass * G);
        let far = (Vector3::from(vector(&sim, "body")?) - Vector3::new(1.0, 2.0, 3.0) - tip).norm() / wire.length;
        let reaction = (Vector3::from(vector(&sim, "anchor.force")?) - first).norm() / first.norm();
        rows.push(
            Row::error(Exact, format!("Elastic catenary {name}, 32 elements: far end off, over length"), far, "")
                .within(3e-8)
                .because("closed form; cubic elements, measured 1e-8 and 2e-8"),
        );
        rows.push(
            Row::error(Exact, format!("Elastic catenary {name}: force on the anchor off, over itself"), reaction, "")
                .within(1e-9)
                .because("statics; the solver's 1e-10 of the load"),
        );
    }
    Ok(rows)
}

fn tow(bench: &Bench) -> Result<Vec<Row>> {
    let wire = Wire { length: 100.0, diameter: 0.02, mass_per_length: 1.0, ea: 1e8, ei: 0.0, laws: "" };
    let (rho, cd, speed) = (1025.0, 1.2, 1.5);
    let w = G * (wire.mass_per_length - rho * PI / 4.0 * wire.diameter.powi(2));
    let c = 0.5 * rho * wire.diameter * speed * speed;
    let across = |e: f64| 0.5 - 0.1 * e.cos() + 0.1 * e.sin() - 0.4 * (2.0 * e).cos() - 0.011 * (2.0 * e).sin();
    let along = |e: f64| 0.01 * (2.008 - 0.3858 * e + 1.9159 * e.powi(2) - 4.16147 * e.powi(3) + 3.5064 * e.powi(4) - 1.187299 * e.powi(5));
    // w cos φ = ½ρ d C U² f(φ), φ from the horizontal.
    let cross = root(|p| w * p.cos() - c * cd * p.sin().powi(2), 1e-9, 0.5 * PI);
    let loading = root(|p| w * p.cos() - c * cd * across(p), 1e-9, 0.5 * PI);
    let laws = [
        ("cross flow", "law = \"cross_flow\", cd_normal = 1.2, cd_tangential = 0.03", cross, PI * 0.03 * c * cross.cos().powi(2)),
        ("loading functions", "law = \"loading_functions\", cd = 1.2", loading, c * cd * along(loading)),
    ];
    let mut rows = Vec::new();
    for (name, law, phi, pull) in laws {
        let rest = format!("[fluid]\ndensity = {rho:?}\nwaterline = 10\ndrag = {{ {law} }}\n[anchor]\nposition = [0, 0, 0]\n");
        let fmu = bench.pack(&wire.scene(G, 10, 2, &rest)?)?;
        let sim = start(&fmu, &[], &[("current.x", speed)])?;
        let tip = point(&sim, 2)?;
        let angle = (-tip[2]).atan2(tip[0]).to_degrees();
        rows.push(
            Row::absolute(Exact, format!("Critical angle of a long tow, {name}"), angle, phi.to_degrees(), "°")
                .within(6e-7)
                .because("w cos φ = ½ρ d C U² f(φ); 1e-8 rad, the solver's 1e-10 of the weight over a stiffness of weight by length"),
        );
        let tension = (w * phi.sin() + pull) * wire.length;
        rows.push(
            Row::relative(Exact, format!("Tension at the head of the tow, {name}"), sim.get("anchor.tension")?, tension, "N")
                .within(1e-8)
                .because("weight and drag along the straight cable; as above"),
        );
    }
    Ok(rows)
}
