//! The rigid load of the thesis's pendulum, hung from a thread that weighs nothing beside it.

use super::{G, Wire};
use fairlead::outputs::Outputs;
use nalgebra::{Matrix2, Vector2};

/// The load: mass, kg; radius of gyration about the attachment and distance from there to the centre of mass, m.
#[derive(Clone, Copy)]
pub struct Hung {
    pub mass: f64,
    pub inertia: f64,
    pub gravity: f64,
}

/// Configuration 1 of the thesis's section 4.1.
pub const THESIS: Hung = Hung { mass: 9.43, inertia: 0.269, gravity: 0.258 };

/// Light and stiff: 1e-9 of the load's mass, 1e-8 of stretch.
pub const THREAD: Wire = Wire { length: 0.5, diameter: 1e-3, mass_per_length: 1e-8, ea: 1e9, ei: 0.0, laws: "" };

impl Hung {
    pub fn table(&self) -> String {
        format!("[load]\nmass = {:?}\nlength_inertia = {:?}\nlength_gravity = {:?}\n", self.mass, self.inertia, self.gravity)
    }

    /// Kinetic and potential energy; the attachment is where the body would be.
    pub fn energy(&self, o: &Outputs) -> f64 {
        let turning = (o.load.velocity - o.body.velocity) / self.gravity;
        let about_g = self.mass * (self.inertia.powi(2) - self.gravity.powi(2));
        0.5 * self.mass * o.load.velocity.norm_squared() + 0.5 * about_g * turning.norm_squared() + self.mass * G * o.load.position.z
    }

    pub fn stretch(&self, o: &Outputs) -> f64 {
        ((o.load.position - o.body.position).norm() / self.gravity - 1.0).abs()
    }

    /// θ̈ of cable (massless, rigid, length `l`) and link, angles from the vertical: M(θ) θ̈ = forces, by Lagrange.
    pub fn accelerations(&self, l: f64, x: &[f64; 4]) -> Vector2<f64> {
        let (c, s) = ((x[0] - x[1]).cos(), (x[0] - x[1]).sin());
        let m = Matrix2::new(l * l, l * self.gravity * c, l * self.gravity * c, self.inertia.powi(2));
        let f = Vector2::new(
            -l * self.gravity * s * x[3] * x[3] - G * l * x[0].sin(),
            l * self.gravity * s * x[2] * x[2] - G * self.gravity * x[1].sin(),
        );
        m.lu().solve(&f).expect("regular")
    }
}

/// The table of a start by release at an angle from the vertical, towards x.
pub fn down(angle: f64) -> String {
    format!("[initial]\nstate = \"released\"\ndirection = [{:?}, 0, {:?}]\n", angle.sin(), -angle.cos())
}
