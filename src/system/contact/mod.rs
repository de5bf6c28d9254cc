//! Contact of the elements with drum and sheaves.
//!
//! Within an element the arcs in contact are found first, face by face, and each is integrated by its own Gauss points. So the force changes
//! smoothly as the cable is laid on or lifted off, whatever the mesh. The arcs' ends move with the shape; their part of the tangent is exact
//! too. Elements near a surface, and then the arcs found, go side by side.

mod group;
mod press;

use super::System;
use super::environment::Environment;
use super::matrices::Matrices;
use crate::contact::arcs::{Arc, Cubic, MOST_ARCS, Samples, Touch};
use crate::contact::surface::{Face, Surface};
use crate::math::lanes::{Kernel, Mat3, Vec3, axpy, dot, mat_vec, widest};
use group::{Group, LANES, Search};
use press::{Arcs, Pressed, Twist, flat, press};
use std::ops::Range;

/// Where the search begins in the first element. Where its node lies on the surface whatever the shape, ξ = 0 is a root of the gap that says
/// nothing, of a sign that is rounding.
const BEYOND_PIN: f64 = 1e-3;

/// What the cable does to a surface, in the surface's axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfaceLoad {
    /// Force on the cable, N.
    pub force: Vec3<f64>,
    /// Its moment about the centre, N·m.
    pub moment: Vec3<f64>,
    /// Force normal to each face, N.
    pub faces: [f64; 2],
}

/// How a surface's axes move against the world and the first node.
#[derive(Clone, Copy)]
pub struct SurfaceFrame {
    /// World components into the surface's axes.
    pub rotation: Mat3<f64>,
    /// The first node's position.
    pub base: Vec3<f64>,
    /// Its velocity.
    base_velocity: Vec3<f64>,
    /// ∂(relative velocity)/∂(position) at fixed world velocity, −[ω]×; zero in a static evaluation.
    turn: Mat3<f64>,
    frozen: bool,
}

impl SurfaceFrame {
    /// Of `surface` at one instant.
    pub fn new(surface: &Surface, env: &Environment, frozen: bool) -> Self {
        let frame = &env.frame;
        let b = &surface.basis;
        let rotation = std::array::from_fn(|i| frame.to_world(&b[i]));
        let place = env.base.map(|j| j.0[0]);
        let at = frame.locate(&place);
        let base = mat_vec(b, &axpy(&at, -1.0, &surface.centre));
        let (mut base_velocity, mut turn) = ([0.0; 3], [[0.0; 3]; 3]);
        if !frozen {
            base_velocity = mat_vec(b, &frame.relative_velocity(&place, &env.base.map(|j| j.0[1])));
            let rate: Mat3<f64> = std::array::from_fn(|i| {
                std::array::from_fn(|j| (0..3).map(|k| frame.rotation[k][i].0[1] * frame.rotation[k][j].0[0]).sum())
            });
            turn = std::array::from_fn(|i| std::array::from_fn(|j| dot(&b[i], &mat_vec(&rate, &b[j]))));
        }
        Self { rotation, base, base_velocity, turn, frozen }
    }

    /// A point relative to the first node, world axes, in the surface's axes.
    pub fn place(&self, point: &Vec3<f64>) -> Vec3<f64> {
        axpy(&mat_vec(&self.rotation, point), 1.0, &self.base)
    }

    /// An element's shape from its slots (relative to the first node, world axes).
    #[inline(always)]
    pub fn shape(&self, u: &[Vec3<f64>; 4], l: f64) -> ([Vec3<f64>; 4], Cubic) {
        let mut q = u.map(|x| mat_vec(&self.rotation, &x));
        let relative = q;
        for i in [0, 2] {
            q[i] = axpy(&q[i], 1.0, &self.base);
        }
        (relative, Cubic::hermite(&q, l))
    }

    /// The element's velocity relative to the ship, from its relative slots in the surface's axes.
    #[inline(always)]
    fn velocity(&self, relative: &[Vec3<f64>; 4], w: &[Vec3<f64>; 4], l: f64) -> Cubic {
        let mut q: [Vec3<f64>; 4] = std::array::from_fn(|i| axpy(&mat_vec(&self.rotation, &w[i]), 1.0, &mat_vec(&self.turn, &relative[i])));
        for i in [0, 2] {
            q[i] = axpy(&q[i], 1.0, &self.base_velocity);
        }
        Cubic::hermite(&q, l)
    }
}

/// Centre and radius of a ball around an element's Bézier polygon, and so around the element.
#[inline]
pub fn ball(u: &[Vec3<f64>; 4], l: f64) -> (Vec3<f64>, f64) {
    let third = l / 3.0;
    let middle: Vec3<f64> = std::array::from_fn(|c| 0.5 * (u[0][c] + u[2][c]));
    let reach = [u[0], axpy(&u[0], third, &u[1]), axpy(&u[2], -third, &u[3])]
        .iter()
        .map(|p| (0..3).map(|c| (p[c] - middle[c]).powi(2)).sum::<f64>())
        .fold(0.0, f64::max)
        .sqrt();
    (middle, reach)
}

/// Whether an element can touch the surface: the gaps are 1-Lipschitz, so a ball around it decides.
#[inline]
pub fn near(surface: &Surface, frame: &SurfaceFrame, u: &[Vec3<f64>; 4], l: f64) -> bool {
    let (middle, reach) = ball(u, l);
    surface.within(&frame.place(&middle), reach)
}

/// Where in element `e` the search begins.
fn start_of(e: usize) -> f64 {
    if e == 0 { BEYOND_PIN } else { 0.0 }
}

/// Calls `found` with every arc of element `e` in contact with a face (its index first).
pub fn touching(surface: &Surface, curve: &Cubic, e: usize, mut found: impl FnMut(usize, Face, Arc)) {
    let (faces, count) = surface.faces();
    let samples = Samples::new(surface, curve, start_of(e));
    for (i, &face) in faces[..count].iter().enumerate() {
        Touch { surface, face, curve }.arcs(&samples, |arc| found(i, face, arc));
    }
}

/// What is near and what is pressed, of one surface at a time.
#[derive(Clone, Debug, Default)]
pub struct Near {
    elements: Vec<usize>,
    /// Where elements have contact forces.
    pressed: Range<usize>,
}

impl Near {
    /// Room for `elements`.
    pub fn new(elements: usize) -> Self {
        Self { elements: Vec::with_capacity(elements), pressed: 0..0 }
    }
}

impl System {
    /// Overwrites the contact forces and adds them to the nodes'; with `TANGENT` adds to the matrices.
    pub(super) fn contact<const TANGENT: bool>(&mut self, env: &Environment, u: &[f64], w: &[f64], f: &mut [f64], m: &mut Matrices) {
        let pressed = std::mem::take(&mut self.near.pressed);
        self.contact_forces[pressed].fill([0.0; 12]);
        for index in 0..self.surfaces.len() {
            let spin = self.spin(index, w);
            let coupling = if self.frozen { None } else { self.turning.iter().position(|s| s.surface == index) };
            let surface = &self.surfaces[index];
            let frame = SurfaceFrame::new(surface, env, self.frozen);
            let (lengths, Near { elements: near, pressed }) = (&self.chain.lengths, &mut self.near);
            let (forces, total) = (&mut self.contact_forces, &mut self.surface_loads[index]);
            *total = SurfaceLoad::default();
            Search { surface, frame: &frame, u, lengths, found: near }.run();
            if near.is_empty() {
                continue;
            }
            let on = Pressed { surface, rotation: frame.rotation, turn: frame.turn, spin };
            let side_by_side = SideBySide { on, frame: &frame, near, lengths, u, w, f: &mut *f, forces, pressed, total, m, coupling };
            match coupling {
                Some(_) => widest(Contact::<TANGENT, true>(side_by_side)),
                None => widest(Contact::<TANGENT, false>(side_by_side)),
            }
        }
    }
}

/// All that contact with one surface takes and gives.
struct SideBySide<'a> {
    on: Pressed<'a>,
    frame: &'a SurfaceFrame,
    near: &'a [usize],
    lengths: &'a [f64],
    u: &'a [f64],
    w: &'a [f64],
    /// On the nodes.
    f: &'a mut [f64],
    /// On the elements' slots.
    forces: &'a mut [[f64; 12]],
    pressed: &'a mut Range<usize>,
    total: &'a mut SurfaceLoad,
    m: &'a mut Matrices,
    /// Which of the couplings, of a surface that turns.
    coupling: Option<usize>,
}

struct Contact<'a, const TANGENT: bool, const TURNS: bool>(SideBySide<'a>);

impl<const TANGENT: bool, const TURNS: bool> Kernel for Contact<'_, TANGENT, TURNS> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let mut all = self.0;
        let surface = all.on.surface;
        let (faces, count) = surface.faces();
        let moving = surface.is_damped() && !all.frame.frozen;
        let (mut group, mut arcs) = (Group::EMPTY, Arcs::NONE);
        for elements in all.near.chunks(LANES) {
            group.fill(surface, all.frame, elements, moving, all.u, all.w, all.lengths);
            for (side, &face) in faces[..count].iter().enumerate() {
                let candidates = group.candidates(face);
                for l in 0..=elements.len() {
                    let mut found = [Arc::default(); MOST_ARCS];
                    let mut n = 0;
                    if l < elements.len() && candidates.0[l] != 0.0 {
                        let curve = group::cubic(&group.shape, l);
                        Touch { surface, face, curve: &curve }.arcs(&group.samples(l), |arc| {
                            found[n] = arc;
                            n += 1;
                        });
                    }
                    if arcs.count > 0 && (l == elements.len() || arcs.count + n > LANES) {
                        all.flush::<TANGENT, TURNS>(side, face, &mut arcs);
                    }
                    for arc in &found[..n] {
                        arcs.push(&group, l, elements[l], *arc);
                    }
                }
            }
        }
    }
}

impl SideBySide<'_> {
    /// Presses the arcs and adds what comes of it to forces and matrices.
    #[inline(always)]
    fn flush<const TANGENT: bool, const TURNS: bool>(&mut self, side: usize, face: Face, arcs: &mut Arcs) {
        let sums = press::<TANGENT, TURNS>(&self.on, side, face, arcs, self.total);
        for (l, &e) in arcs.element[..arcs.count].iter().enumerate() {
            let slots = self.forces[e].iter_mut().zip(&mut self.f[6 * e..6 * e + 12]);
            for ((slot, node), f) in slots.zip(flat(&sums.forces, l)) {
                *slot += f;
                *node += f;
            }
            let before = if self.pressed.start == self.pressed.end { e..e + 1 } else { self.pressed.clone() };
            *self.pressed = before.start.min(e)..before.end.max(e + 1);
        }
        if let Some((slopes, twist)) = &sums.slopes {
            slopes.add_stiffness(arcs, &mut self.m.stiffness);
            if self.on.surface.is_damped() {
                slopes.add_damping(arcs, &mut self.m.damping);
            }
            self.couple(arcs, twist);
        }
        arcs.count = 0;
    }

    /// Adds what couples the arcs' elements with the surface's rotation.
    fn couple(&mut self, arcs: &Arcs, twist: &Twist) {
        let Some(coupling) = self.coupling.map(|k| &mut self.m.couplings[k]) else { return };
        let (block, at) = (coupling.at / 6, coupling.at % 6);
        for (l, &e) in arcs.element[..arcs.count].iter().enumerate() {
            self.m.damping.add(block, block, at, at, twist.spin_corner.0[l]);
            for (to, from) in [
                (&mut coupling.damping_column, &twist.spin_column),
                (&mut coupling.damping_row, &twist.damping),
                (&mut coupling.stiffness_row, &twist.stiffness),
            ] {
                for (to, x) in to[6 * e..6 * e + 12].iter_mut().zip(flat(from, l)) {
                    *to += x;
                }
            }
        }
    }
}
