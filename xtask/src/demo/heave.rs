//! The winch controller that a user of the FMU would write: the simplified-sheave heave compensation (Westin 2018, section 3.7).
//!
//! The winch pays out Δl = −u·Δr_s: what the cable's end would be lifted along its own direction is let out again. Δr_s is the
//! displacement of the drum's top from its place in the calm, u the unit vector down the cable at the winch in the calm.

use crate::error::Failure;
use crate::host::Instance;
use crate::seakeeping::motion::State;
use std::f64::consts::FRAC_PI_2;

type Vector = [f64; 3];

/// Points of the cable this much farther from the drum's axis than its surface are beyond the drum.
const BEYOND: f64 = 1.1;

/// Drum and calm cable, as far as the controller needs to know them.
#[derive(Clone, Debug, PartialEq)]
pub struct SimplifiedSheave {
    /// u, inertial frame.
    pub down_cable: Vector,
    /// The drum's top, ship axes, m.
    pub top: Vector,
    /// The drum's top in the calm, inertial frame, m.
    pub mean: Vector,
    /// Drum angle in the calm, rad.
    pub angle: f64,
    /// Drum angle per metre paid out, rad/m.
    pub turn: f64,
}

impl SimplifiedSheave {
    /// Reads the winch's parameters and the start's outputs of an initialized instance, the ship in `calm`.
    ///
    /// # Errors
    /// A variable that the FMU does not have, or a cable that does not leave the drum.
    pub fn of(instance: &Instance, calm: &State) -> Result<Self, Failure> {
        let vector = |name: &dyn Fn(usize) -> String| -> Result<Vector, Failure> {
            Ok([instance.get(&name(1))?, instance.get(&name(2))?, instance.get(&name(3))?])
        };
        let centre = vector(&|i| format!("winch.position[{i}]"))?;
        let axis = vector(&|i| format!("winch.axis[{i}]"))?;
        let axis = scaled(axis, 1.0 / norm(axis));
        let radius = instance.get("winch.radius")? + 0.5 * instance.get("cable.diameter")?;
        let count = (1..).take_while(|k| instance.description.variable(&format!("cable.point[{k}].x")).is_ok()).count();
        let point = |k: usize| vector(&|i| format!("cable.point[{k}].{}", ["x", "y", "z"][i - 1]));
        let points = (1..=count).map(point).collect::<Result<Vec<_>, _>>()?;
        let turn = instance.get("winch.direction")? / radius;
        Self::at(calm, centre, axis, &points, instance.get("winch.angle")?, turn)
    }

    /// For a drum with `centre` (m) and unit `axis` in ship axes, from points of the calm cable (inertial frame, m), the drum's angle there
    /// (rad) and its turn per metre paid out (rad/m).
    fn at(calm: &State, centre: Vector, axis: Vector, points: &[Vector], angle: f64, turn: f64) -> Result<Self, Failure> {
        let radius = 1.0 / turn.abs();
        let top = added(centre, scaled(up(axis), radius));
        let centre = in_world(calm, centre)[0];
        let axis = added(in_world(calm, added(axis, top))[0], scaled(in_world(calm, top)[0], -1.0));
        let down_cable = beyond(points, centre, axis, radius)
            .ok_or_else(|| Failure("cable.point[k]: no two of them lie beyond the drum; expected a cable that leaves it".into()))?;
        Ok(Self { down_cable, top, mean: in_world(calm, top)[0], angle, turn })
    }

    /// Set-point of the drum angle and its rate for a ship's state.
    pub fn setpoint(&self, ship: &State) -> [f64; 2] {
        let [position, velocity] = in_world(ship, self.top);
        let displacement = added(position, scaled(self.mean, -1.0));
        [self.angle - self.turn * dot(self.down_cable, displacement), -self.turn * dot(self.down_cable, velocity)]
    }
}

/// Direction of the first chord that lies beyond the drum.
fn beyond(points: &[Vector], centre: Vector, axis: Vector, radius: f64) -> Option<Vector> {
    let distance = |p: &Vector| {
        let arm = added(*p, scaled(centre, -1.0));
        norm(added(arm, scaled(axis, -dot(arm, axis))))
    };
    let first = points.iter().position(|p| distance(p) > BEYOND * radius)?;
    let chord = added(*points.get(first + 1)?, scaled(points[first], -1.0));
    let length = norm(chord);
    (length > 0.0).then(|| scaled(chord, 1.0 / length))
}

/// The ship's z made normal to the axis; its x where the axis is along z.
fn up(axis: Vector) -> Vector {
    let along = |v: Vector| added(v, scaled(axis, -dot(v, axis)));
    let z = along([0.0, 0.0, 1.0]);
    let up = if norm(z) > 1e-9 { z } else { along([1.0, 0.0, 0.0]) };
    scaled(up, 1.0 / norm(up))
}

/// Inertial position and velocity of a point `s` in ship axes, r + R_z(yaw) R_y(pitch) R_x(roll) s.
fn in_world(ship: &State, s: Vector) -> [Vector; 2] {
    let mut position = s;
    let mut velocity = [0.0; 3];
    // Roll turns y to z, pitch z to x, yaw x to y.
    for (k, from, to) in [(3, 1, 2), (4, 2, 0), (5, 0, 1)] {
        let (angle, rate) = (ship.pose[k], ship.velocity[k]);
        let turned = |v: Vector, angle: f64| {
            let mut w = v;
            w[from] = angle.cos() * v[from] - angle.sin() * v[to];
            w[to] = angle.sin() * v[from] + angle.cos() * v[to];
            w
        };
        // d/dt of the turned vector: the turned derivative, and the vector turned a quarter further times the rate.
        let mut quarter = turned(position, angle + FRAC_PI_2);
        quarter[3 - from - to] = 0.0;
        velocity = added(turned(velocity, angle), scaled(quarter, rate));
        position = turned(position, angle);
    }
    let [x, y, z] = [0, 1, 2].map(|i| ship.pose[i]);
    let [vx, vy, vz] = [0, 1, 2].map(|i| ship.velocity[i]);
    [added(position, [x, y, z]), added(velocity, [vx, vy, vz])]
}

fn added(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn scaled(a: Vector, factor: f64) -> Vector {
    a.map(|x| factor * x)
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn norm(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ship_motion::Options;
    use fairlead::scene::file::SceneFile;
    use fairlead::sim::{Channel, Inputs, Simulation};

    fn controller(direction: f64) -> SimplifiedSheave {
        let down_cable = [-0.6, 0.0, -0.8];
        SimplifiedSheave { down_cable, top: [0.0; 3], mean: [0.0; 3], angle: 1.5, turn: direction / 0.02 }
    }

    #[test]
    fn exact_a_rising_ship_pays_out_and_a_sinking_one_reels_in() {
        let ship = State { pose: [0.0, 0.0, 0.01, 0.0, 0.0, 0.0], velocity: [0.0, 0.0, 0.1, 0.0, 0.0, 0.0], ..State::default() };
        // 8 mm to be paid out over a radius of 20 mm; with direction −1 by decreasing the angle.
        let [angle, rate] = controller(-1.0).setpoint(&ship);
        assert!((angle - (1.5 - 0.4)).abs() < 1e-15 && (rate + 4.0).abs() < 1e-15, "{angle} {rate}");
        let [angle, rate] = controller(1.0).setpoint(&ship);
        assert!((angle - (1.5 + 0.4)).abs() < 1e-15 && (rate - 4.0).abs() < 1e-15);
        // Forward motion drags the cable's end along: that is let out, too.
        let forward = State { pose: [0.01, 0.0, 0.0, 0.0, 0.0, 0.0], ..State::default() };
        assert!((controller(-1.0).setpoint(&forward)[0] - (1.5 - 0.3)).abs() < 1e-15);
        assert_eq!(controller(-1.0).setpoint(&State::default()), [1.5, 0.0]);
    }

    /// The controller outside of the FMU, and the one that is built in, on the demo's scene in the demo's sea.
    #[test]
    fn cross_the_built_in_simplified_sheave_tells_the_winch_the_same() {
        let text = model_description::scenes::SCENES[0].text;
        let scene = |text: &str| SceneFile::parse(text, "flume").and_then(|file| file.check(None)).unwrap();
        let outside = scene(text);
        let inside = scene(&text.replace("setpoint = \"external\"", "setpoint = \"simplified_sheave\""));
        let winch = outside.winch.clone().unwrap();
        let motion = crate::ship_motion::generate(&super::super::sea()).unwrap();
        let inputs = |row: usize| {
            let State { pose, velocity, acceleration } = motion.states[row];
            let channel = |i: usize| Channel { value: pose[i], first: Some(velocity[i]), second: Some(acceleration[i]) };
            Inputs { ship: std::array::from_fn(channel), ..Inputs::default() }
        };
        let [mut outside, mut inside] = [outside, inside].map(|scene| {
            let mut simulation = Simulation::new(&scene).unwrap();
            simulation.initialize(0.0, &inputs(0)).unwrap();
            simulation
        });
        let points: Vec<Vector> = outside.outputs().cable.points.iter().map(|&p| p.into()).collect();
        let turn = winch.direction / (winch.radius + 0.5 * 0.45e-3);
        let calm = &motion.states[0];
        // The FMU takes the direction beyond the bend, which is as long as the drum's radius; the demo from the first chord off the drum, a
        // tenth of a radian steeper. Not from there, then: from the third, which lies where the FMU looks.
        let at =
            |points: &[Vector]| SimplifiedSheave::at(calm, winch.position.into(), winch.axis.into(), points, winch.angle, turn).unwrap();
        let controller = at(&points[2..]);
        let (mut told, mut height, mut heave) = (0.0_f64, 0.0_f64, 0.0_f64);
        for row in 0..1500 {
            let [angle, rate] = controller.setpoint(&motion.states[row]);
            let told_inside = inside.outputs().winch.target;
            told = told.max((told_inside - angle).abs() / turn.abs());
            let commanded = Inputs { winch: Channel { value: angle, first: Some(rate), second: None }, ..inputs(row) };
            outside.step_to(motion.times[row + 1], &commanded).unwrap();
            inside.step_to(motion.times[row + 1], &inputs(row)).unwrap();
            height = height.max((outside.outputs().body.position.z - inside.outputs().body.position.z).abs());
            heave = heave.max(motion.states[row].pose[2].abs());
        }
        println!(
            "heave up to {:.1} mm; set-points differ by {:.3} mm, the bodies' heights by {:.3} mm",
            1e3 * heave,
            1e3 * told,
            1e3 * height
        );
        // A chord of 43 mm against a tangent within it, on a cable that turns by a tenth of a radian a decimetre: half a hundredth of a radian,
        // times displacements of up to 70 mm.
        assert!(heave > 0.015 && told < 0.03 * heave && height < 0.03 * heave, "{heave} {told} {height}");
    }

    #[test]
    fn exact_rotation_is_right_handed_in_the_order_yaw_pitch_roll() {
        let turned = |pose: [f64; 6], s: Vector| in_world(&State { pose, ..State::default() }, s)[0];
        let near = |a: Vector, b: Vector| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-15);
        let q = FRAC_PI_2;
        assert!(near(turned([0.0, 0.0, 0.0, q, 0.0, 0.0], [0.0, 1.0, 0.0]), [0.0, 0.0, 1.0]));
        assert!(near(turned([0.0, 0.0, 0.0, 0.0, q, 0.0], [1.0, 0.0, 0.0]), [0.0, 0.0, -1.0]), "positive pitch is bow down");
        assert!(near(turned([0.0, 0.0, 0.0, 0.0, 0.0, q], [1.0, 0.0, 0.0]), [0.0, 1.0, 0.0]));
        // Roll first: y goes up, then pitch takes up forward, then yaw takes forward to port.
        assert!(near(turned([1.0, 2.0, 3.0, q, q, q], [0.0, 1.0, 0.0]), [1.0, 3.0, 3.0]));
    }

    #[test]
    fn exact_the_rate_is_the_angle_s_derivative() {
        let motion = Options { scale: 40.0, heading: 150.0, ..Options::default() }.motion().unwrap();
        // A winch far from the ship's origin, so that rotations count.
        let controller = SimplifiedSheave { top: [-0.6, 0.1, 0.2], ..controller(-1.0) };
        let h = 1e-4;
        for i in 0..50 {
            let t = 6.0 + 0.37 * i as f64;
            let [before, after] = [t - h, t + h].map(|t| controller.setpoint(&motion.state(t))[0]);
            let rate = controller.setpoint(&motion.state(t))[1];
            // Central difference: h²/6 of the third derivative, and rounding.
            assert!(((after - before) / (2.0 * h) - rate).abs() < 1e-5, "{t}");
        }
    }

    #[test]
    fn exact_the_chord_beyond_the_drum_is_taken() {
        let points = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.05], [-1.0, 0.3, 1.0], [-4.0, 0.3, -3.0], [-4.0, 0.3, -9.0]];
        let u = beyond(&points, [0.0; 3], [0.0, 1.0, 0.0], 1.0).unwrap();
        assert!(norm(added(u, [0.6, 0.0, 0.8])) < 1e-15, "{u:?}");
        assert_eq!(beyond(&points[..3], [0.0; 3], [0.0, 1.0, 0.0], 1.0), None);
        assert_eq!(up([0.0, 1.0, 0.0]), [0.0, 0.0, 1.0]);
        assert_eq!(up([0.0, 0.0, 1.0]), [1.0, 0.0, 0.0]);
    }
}
