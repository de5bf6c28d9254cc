//! The contact's tangent against central differences: the one figure of the list that FMI cannot see, taken from the library itself.

use super::bench::Bench;
use super::must_hold::Must;
use super::row::{Row, Truth::Exact};
use super::scene::{G, Scene, Wire};
use super::section::Section;
use super::sheaves::{ROPE, regions, sheave};
use crate::error::{Failure, Result};
use fairlead::equilibrium;
use fairlead::integrator::Problem;
use fairlead::scene::file::SceneFile;
use fairlead::sim::Channel;
use fairlead::system::{Matrices, System};
use nalgebra::Vector3;

/// The section.
///
/// # Errors
/// The library's.
pub fn section(_: &Bench) -> Result<Section> {
    let (error, columns) = worst(&scene()?)?;
    let what =
        format!("Stiffness and damping of contact against central differences, over a column's greatest entry: worst of {columns} columns");
    let row = Row::error(Exact, what, error, "").within(1e-6).must(Must::Tangent).because(
        "asked for 1e-6: rounding over the step, and the step's square; every coordinate of every touched element, those at the edge too",
    );
    Ok(Section::new("The tangent of contact")
        .text(
            "A rope over a sheave with groove, friction and contact damping on a ship that surges and rolls, every coordinate and velocity disturbed. \
             FMI shows no tangents, so this figure alone is computed from the linked library and not from a packed FMU.",
        )
        .rows(vec![row]))
}

fn scene() -> Result<Scene> {
    let rough = sheave(1e6, Some(0.8), "damping = 0.2\nfriction = 0.3");
    let text = format!("[ship]\ninput = \"pose\"\n[anchor]\nposition = [-0.3, 0.01, 0.05]\n{rough}[body]\nmass = 1.0\n");
    Ok(Wire { length: 0.7, ..ROPE }.scene(G, 1, 0, &text)?.with("mesh", regions(&[(0.28, 8), (0.12, 12), (0.3, 4)])))
}

/// Greatest difference over its column's greatest entry, and the number of columns.
fn worst(scene: &Scene) -> Result<(f64, usize)> {
    let failure = |e: &dyn std::fmt::Display| Failure(format!("the tangent's scene: {e}"));
    let file = SceneFile::parse(&scene.files().0, "scene.toml").and_then(|f| f.check(None)).map_err(|e| failure(&e))?;
    let mut system = System::new(&file);
    let mut u = equilibrium::lay_out(&system, 0.0, &-Vector3::z()).map_err(|e| failure(&e))?;
    let weight = (system.cable_mass() + system.end_mass()) * file.gravity;
    equilibrium::solve(&mut system, 0.0, &mut u, weight).map_err(|e| failure(&e))?;
    let n = u.len();
    // The ship moves and the cable slides: every velocity is there.
    let ship = [0.4, -0.2, 0.1, 0.3, -0.5, 0.2].map(|v| Channel { value: 0.0, first: Some(v), second: None });
    system.ship.start(0.0, &ship);
    system.ship.advance(0.0, 1.0, &ship);
    let mut w: Vec<f64> = (0..n).map(|i| 0.3 * (1.7 * i as f64).sin()).collect();
    w[..3].fill(0.0);
    u.iter_mut().enumerate().skip(3).for_each(|(i, x)| *x += 2e-5 * (2.3 * i as f64).cos());

    // Contact alone: the tangent with it less the one without it, and the contact's own forces.
    let still = vec![0.0; n];
    let (mut with, mut without, mut f) = (Matrices::zeros(n / 6), Matrices::zeros(n / 6), vec![0.0; n]);
    system.linearize(0.0, &u, &w, &still, &mut with, &mut f);
    let touched: Vec<usize> = (0..system.contact_forces.len()).filter(|e| system.contact_forces[*e] != [0.0; 12]).collect();
    let mut free = system.clone();
    free.surfaces.clear();
    free.contact_forces.fill([0.0; 12]);
    free.linearize(0.0, &u, &w, &still, &mut without, &mut f);

    let ([_, with_d, with_k], [_, without_d, without_k]) = (with.whole(), without.whole());
    let (mut worst, mut columns) = (0.0f64, 0);
    for k in touched.iter().flat_map(|e| (6 * e).max(3)..6 * e + 12) {
        // Of positions (penetrations are 1e-5 m and more), slopes (over elements of 1e-2 m), velocities.
        let h = if k % 6 < 3 { [1e-9, 1e-5] } else { [1e-7, 1e-3] };
        for (which, h) in h.into_iter().enumerate() {
            let mut shifted = |s: f64| {
                let mut x = [u.clone(), w.clone()];
                x[which][k] += s;
                system.force(0.0, &x[0], &x[1], None, &mut f);
                let mut sum = vec![0.0; n];
                for (e, force) in system.contact_forces.iter().enumerate() {
                    force.iter().enumerate().for_each(|(i, x)| sum[6 * e + i] += x);
                }
                sum
            };
            let (up, down) = (shifted(h), shifted(-h));
            let (mut unit, mut exact) = (vec![0.0; n], vec![0.0; n]);
            unit[k] = 1.0;
            let (a, b) = [(&with_k, &without_k), (&with_d, &without_d)][which];
            a.multiply_add(-1.0, &unit, &mut exact);
            b.multiply_add(1.0, &unit, &mut exact);
            // The pinned node has no rows.
            let rows = 3..n;
            let size = rows.clone().map(|i| exact[i].abs()).fold(0.0, f64::max);
            let error = rows.map(|i| (exact[i] - (up[i] - down[i]) / (2.0 * h)).abs()).fold(0.0, f64::max);
            worst = worst.max(error / size);
            columns += 1;
        }
    }
    if columns == 0 { Err(Failure("the tangent's scene: nothing touches the sheave".into())) } else { Ok((worst, columns)) }
}
