//! The winch drum: an infinite frictionless cylinder (model.md 4; thesis eqs. 94-99).

use super::hunt_crossley;
use crate::math::lanes::{Mat3, Vec3, add_identity, add_outer, dot, scale};
use crate::scene::Contact;

/// A cylinder in its own frame: ship axes, origin at its centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drum {
    /// Unit axis.
    pub axis: Vec3<f64>,
    /// To the cable's centreline, R + d/2, m.
    pub radius: f64,
    /// Contact law.
    pub law: Contact,
}

/// Force per length and its derivatives, ship axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactLoad {
    /// On the cable, N/m.
    pub f: Vec3<f64>,
    /// ∂f/∂s at fixed ship-frame velocity.
    pub ds: Mat3<f64>,
    /// ∂f/∂ṡ.
    pub dv: Mat3<f64>,
}

impl Drum {
    /// Distance from the axis less the radius, m; negative when penetrating.
    #[inline]
    pub fn gap(&self, s: &Vec3<f64>) -> f64 {
        let y = dot(s, &self.axis);
        (dot(s, s) - y * y).max(0.0).sqrt() - self.radius
    }

    /// Load on a point at `s` from the centre that moves with `v` in the ship's frame; `None` without contact.
    #[inline]
    pub fn load(&self, s: &Vec3<f64>, v: &Vec3<f64>) -> Option<ContactLoad> {
        let y = dot(s, &self.axis);
        let radial: Vec3<f64> = std::array::from_fn(|c| s[c] - y * self.axis[c]);
        let rho = dot(&radial, &radial).sqrt();
        let depth = self.radius - rho;
        if depth <= 0.0 || rho == 0.0 {
            return None;
        }
        let e = scale(1.0 / rho, &radial);
        let rate = -dot(v, &e);
        let (f, by_depth, by_rate) = hunt_crossley::force(&self.law, depth, rate);
        let mut load = ContactLoad { f: scale(f, &e), ..ContactLoad::default() };
        // ∂e/∂s = (I − aaᵀ − eeᵀ)/ρ; δδ̇ = −v·∂e/∂s δs.
        let hoop: Vec3<f64> = std::array::from_fn(|c| v[c] - dot(v, &self.axis) * self.axis[c] + rate * e[c]);
        add_identity(&mut load.ds, f / rho);
        add_outer(&mut load.ds, -f / rho, &self.axis, &self.axis);
        add_outer(&mut load.ds, -f / rho - by_depth, &e, &e);
        add_outer(&mut load.ds, -by_rate / rho, &e, &hoop);
        add_outer(&mut load.dv, -by_rate, &e, &e);
        Some(load)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_tangent_matches_central_differences() {
        let drum = Drum { axis: [0.6, 0.8, 0.0], radius: 0.5, law: Contact { stiffness: 1e5, damping: 0.3, exponent: 1.5 } };
        let x = [0.3, -0.2, 0.31, 0.4, -0.7, 0.2];
        let f = |x: &[f64; 6]| drum.load(&[x[0], x[1], x[2]], &[x[3], x[4], x[5]]).unwrap();
        let l = f(&x);
        for j in 0..6 {
            let h = 1e-7;
            let (mut up, mut down) = (x, x);
            up[j] += h;
            down[j] -= h;
            for i in 0..3 {
                let d = (f(&up).f[i] - f(&down).f[i]) / (2.0 * h);
                let exact = if j < 3 { l.ds[i][j] } else { l.dv[i][j - 3] };
                assert!((d - exact).abs() < 1e-6 * 1e5, "({i}, {j}): {d} against {exact}"); // 1e-6 of k
            }
        }
        assert!(drum.load(&[0.0, 0.0, 0.51], &[0.0; 3]).is_none());
    }
}
