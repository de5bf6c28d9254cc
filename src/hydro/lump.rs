//! Fluid force on a compact body: drag ½ρ C A ‖v‖ v, added mass C_m ρV, buoyancy ρV g, all times the submerged share of a sphere of its volume.

use super::curve::Curve;
use super::surface::sphere_share;
use crate::math::lanes::{Mat3, Vec3, add_identity, add_outer, dot, scale};
use crate::scene::{Body, Fluid};

/// Constants of a body in water.
#[derive(Clone, Debug, PartialEq)]
pub struct LumpInWater {
    waterline: f64,
    /// Of a sphere of the body's volume, m.
    radius: f64,
    buoyancy: f64,
    displaced: f64,
    added_mass: f64,
    /// ½ρA.
    c0: f64,
    /// Diameter (of a circle of the drag area) times ρ/μ.
    reynolds: f64,
    cd: Curve,
}

/// Force and its derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LumpLoad {
    /// N.
    pub f: Vec3<f64>,
    /// ∂f/∂z.
    pub dz: Vec3<f64>,
    /// ∂f/∂ṙ.
    pub dv: Mat3<f64>,
    /// Added mass, kg.
    pub mass: f64,
    /// Its derivative by z, kg/m.
    pub mass_dz: f64,
}

impl LumpInWater {
    /// From a checked scene.
    pub fn new(fluid: &Fluid, body: &Body, gravity: f64) -> Self {
        let displaced = fluid.density * body.volume;
        let pi = std::f64::consts::PI;
        Self {
            waterline: fluid.waterline,
            radius: (0.75 * body.volume / pi).cbrt(),
            buoyancy: displaced * gravity,
            displaced,
            added_mass: displaced * body.added_mass,
            c0: 0.5 * fluid.density * body.drag_area,
            reynolds: fluid.viscosity.map_or(0.0, |mu| (4.0 * body.drag_area / pi).sqrt() * fluid.density / mu),
            cd: Curve::new(&body.drag_coefficient),
        }
    }

    /// Force at height `z` with velocity `v` and acceleration `a` of the body in a flow (`vf`, its derivative by z `dvf`, acceleration `af`).
    pub fn load(&self, z: f64, v: &Vec3<f64>, a: &Vec3<f64>, vf: &Vec3<f64>, dvf: &Vec3<f64>, af: &Vec3<f64>) -> LumpLoad {
        let (share, dshare) = sphere_share(z, self.waterline, self.radius);
        if share == 0.0 && dshare == 0.0 {
            return LumpLoad::default();
        }
        let rel: Vec3<f64> = std::array::from_fn(|c| vf[c] - v[c]);
        let speed = dot(&rel, &rel).sqrt();
        let (cd, dcd) = self.cd.at(speed * self.reynolds);
        let mut full: Vec3<f64> =
            std::array::from_fn(|c| self.c0 * cd * speed * rel[c] + self.displaced * af[c] - self.added_mass * (a[c] - af[c]));
        full[2] += self.buoyancy;
        let mut by_rel = [[0.0; 3]; 3];
        add_identity(&mut by_rel, self.c0 * cd * speed);
        if speed > 0.0 {
            add_outer(&mut by_rel, self.c0 * (cd / speed + dcd * self.reynolds), &rel, &rel);
        }
        let mut out = LumpLoad {
            f: scale(share, &full),
            dz: scale(dshare, &full),
            dv: [[0.0; 3]; 3],
            mass: share * self.added_mass,
            mass_dz: dshare * self.added_mass,
        };
        for r in 0..3 {
            for c in 0..3 {
                out.dv[r][c] = -share * by_rel[r][c];
            }
            out.dz[r] += share * dot(&by_rel[r], dvf);
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Coefficient, Drag};

    #[test]
    fn exact_tangent_and_terminal_velocity() {
        let fluid = Fluid {
            density: 1026.0,
            viscosity: Some(1.2e-3),
            waterline: 0.0,
            drag: Drag::CrossFlow { normal: Coefficient::Constant(1.0), tangential: 0.0, amplification: 1.0 },
            added_mass: 1.0,
            current: vec![],
            noise: None,
        };
        let body = Body {
            mass: 1.33e-3,
            volume: 5.236e-7,
            drag_area: 7.854e-5,
            drag_coefficient: Coefficient::Sphere,
            added_mass: 0.5,
            force_input: false,
        };
        let lump = LumpInWater::new(&fluid, &body, 9.81);
        let f = |x: &[f64; 4]| {
            lump.load(x[0], &[x[1], x[2], x[3]], &[0.3, 0.1, -0.2], &[0.2, x[0] * 3.0, 0.0], &[0.0, 3.0, 0.0], &[0.1, 0.0, 0.2])
        };
        for x in [[-1.0, 0.4, -0.3, 0.2], [0.002, 0.4, -0.3, 0.2], [-0.004, 0.0, 0.1, -0.5]] {
            let l = f(&x);
            for j in 0..4 {
                let h = 1e-7;
                let (mut up, mut down) = (x, x);
                up[j] += h;
                down[j] -= h;
                for i in 0..3 {
                    let d = (f(&up).f[i] - f(&down).f[i]) / (2.0 * h);
                    let exact = if j == 0 { l.dz[i] } else { l.dv[i][j - 1] };
                    assert!((d - exact).abs() < 1e-5 * (1e-3 + exact.abs()), "({i}, {j}): {d} against {exact}"); // rounding 1e-16·f/h
                }
            }
        }
        // Terminal velocity: weight − buoyancy = ½ρ C A v², by fixed-point iteration.
        let weight = (body.mass - 1026.0 * body.volume) * 9.81;
        let mut v = 0.5;
        for _ in 0..60 {
            v = (weight / (lump.c0 * crate::hydro::curve::sphere(v * lump.reynolds))).sqrt();
        }
        let net = lump.load(-1.0, &[0.0, 0.0, -v], &[0.0; 3], &[0.0; 3], &[0.0; 3], &[0.0; 3]).f[2] - body.mass * 9.81;
        assert!(net.abs() < 1e-4 * weight, "{net}"); // the tabulated curve is within 1e-5
    }
}
