//! Cables that the Rust tests and `cargo xtask report`, which includes this file by its path, both compute. SI units.

use nalgebra::Vector3;

/// On earth, m/s².
pub const G: f64 = 9.81;

/// A cable; the rest of a scene is written as TOML.
#[derive(Clone, Copy, Debug)]
pub struct Wire {
    /// Unstretched length.
    pub length: f64,
    /// Diameter.
    pub diameter: f64,
    /// Mass per unstretched length.
    pub mass_per_length: f64,
    /// Axial stiffness.
    pub ea: f64,
    /// Bending stiffness.
    pub ei: f64,
    /// Further lines of the table `[cable]`.
    pub laws: &'static str,
}

/// The flume's nylon, as in P2, P3 and P5 of the comparison with other programs.
pub const NYLON: Wire = Wire { length: 1.0, diameter: 4.5e-4, mass_per_length: 2e-4, ea: 222.0, ei: 2.82e-6, laws: "" };

impl Wire {
    /// A scene file: this cable with an equal mesh, and `rest`, the other tables.
    pub fn text(&self, gravity: f64, elements: usize, rest: &str) -> String {
        let Self { length, diameter, mass_per_length, ea, ei, laws } = self;
        format!(
            "name = \"bench\"\ngravity = {gravity:?}\n[cable]\nlength = {length:?}\ndiameter = {diameter:?}\n\
             mass_per_length = {mass_per_length:?}\nEA = {ea:?}\nEI = {ei:?}\n{laws}\n[mesh]\nelements = {elements}\n{rest}\n"
        )
    }
}

/// A row of a start shape: (s, position, tangent, velocity).
pub type Row = (f64, [f64; 3], [f64; 3], [f64; 3]);

/// The text of a start shape.
pub fn shape_csv(rows: &[Row]) -> String {
    let mut text = String::from("s,x,y,z,tx,ty,tz,vx,vy,vz\n");
    for (s, r, t, v) in rows {
        let cells: Vec<String> = std::iter::once(s).chain(r).chain(t).chain(v).map(|x| format!("{x:?}")).collect();
        text += &(cells.join(",") + "\n");
    }
    text
}

/// r(L) of an elastic catenary with a force `f` on its far end, and the force on its first: r = ∫ (T/‖T‖ + T/EA) ds, T(s) = f − w (L − s) k.
pub fn catenary(wire: &Wire, f: Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
    let (l, w, ea) = (wire.length, wire.mass_per_length * G, wire.ea);
    let h = f.xy().norm();
    let first = f - Vector3::z() * w * l;
    let reach = ((f.z / h).asinh() - (first.z / h).asinh()) / w + l / ea;
    let z = (f.norm() - first.norm()) / w + (f.z * l - 0.5 * w * l * l) / ea;
    (Vector3::new(f.x * reach, f.y * reach, z), first)
}

/// P1, a pendulum over a pulley: the rope, its tables (pulley, load) and its start, uniformly stretched on a circle that the first tension
/// presses in.
pub fn pulley_pendulum() -> (Wire, String, Vec<Row>) {
    let rope = Wire { length: 0.44, diameter: 0.00884, mass_per_length: 0.059, ea: 1.2276e5, ei: 8e-5, laws: "damping.axial = 20.0" };
    let (contact, stiffness, mass, wrap) = (0.05062f64, 1e8, 9.43, 34.9f64.to_radians());
    let tension = mass * G * wrap.sin();
    let (radius, stretch) = (contact - tension / (contact * stiffness), 1.0 + tension / rope.ea);
    let row = |i: u32| {
        let s = rope.length * f64::from(i) / 880.0;
        let along = s * stretch;
        let angle = (along / radius).min(wrap);
        let free = along - radius * angle;
        let (sine, cosine) = angle.sin_cos();
        let place = [radius * sine + free * cosine, 0.0, radius * cosine - free * sine];
        (s, place, [stretch * cosine, 0.0, -stretch * sine], [0.0; 3])
    };
    let rest = format!(
        "[anchor]\nposition = [0, 0, {contact}]\n[[sheave]]\nposition = [0, 0, 0]\naxis = [0, 1, 0]\nradius = {}\nstiffness = {stiffness:?}\n\
         exponent = 1.0\n[load]\nmass = {mass}\nlength_inertia = 0.269\nlength_gravity = 0.258\n[solver]\ntolerance = 1e-5\n",
        contact - 0.5 * rope.diameter
    );
    (rope, rest, (0..=880).map(row).collect())
}
