//! Scene files: text in, checked [`Scene`] out.

use super::leaves::{self, Leaf};
use super::model::*;
use super::problem::{Problems, SceneErrors};
use super::{rules, schema, start_shape};
use model_description::Value;
use nalgebra::Vector3;
use serde::Deserialize;
use std::f64::consts::PI;
use toml::Table;

/// A scene file that obeys the table of scene keys and the rules among them, with all defaults filled in.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneFile {
    /// The file, for messages.
    source: String,
    /// The normalized tree.
    tree: Table,
}

impl SceneFile {
    /// Reads the text of a scene file; `source` names it in messages.
    ///
    /// # Errors
    /// The place of the first syntax error; or every unknown or missing key, wrong type, value out of range and inconsistency.
    pub fn parse(text: &str, source: &str) -> Result<Self, SceneErrors> {
        let tree = text.parse::<Table>().map_err(|e| {
            let line = e.span().map_or(1, |span| text[..span.start.min(text.len())].matches('\n').count() + 1);
            let mut problems = Problems::default();
            problems.add("", format!("line {line}: not TOML: {}", e.message().replace('\n', "; ")));
            problems.into_errors(source)
        })?;
        Self::normalized(tree, source)
    }

    fn normalized(mut tree: Table, source: &str) -> Result<Self, SceneErrors> {
        let mut problems = schema::normalize(&mut tree);
        rules::check(&tree, &mut problems);
        problems.into_result(source, Self { source: source.to_owned(), tree })
    }

    /// Every number of the file and of the defaults, except those that decide which variables there are.
    pub fn leaves(&self) -> Vec<Leaf> {
        leaves::leaves(&self.tree)
    }

    /// The same scene with other numbers: (index into the leaves, value).
    ///
    /// # Errors
    /// As in [`Self::parse`]; also an index that is no leaf's and a value of another kind than the leaf's.
    pub fn with(&self, changes: &[(usize, Value)]) -> Result<Self, SceneErrors> {
        let leaves = self.leaves();
        let mut tree = self.tree.clone();
        let mut problems = Problems::default();
        for (index, value) in changes {
            match leaves.get(*index) {
                Some(leaf) if leaf.put(&mut tree, value) => {}
                Some(leaf) => problems.add(&leaf.name, format!("found {value:?}; expected a value like {:?}", leaf.value)),
                None => problems.add("", format!("there is no parameter number {index}; expected less than {}", leaves.len())),
            }
        }
        problems.into_result(&self.source, ())?;
        Self::normalized(tree, &self.source)
    }

    /// The path of the start shape relative to the scene file, if the scene has one.
    pub fn start_shape(&self) -> Option<&str> {
        schema::get(&self.tree, "initial.file")?.as_str()
    }

    /// The scene; `start_shape` is the text of [`Self::start_shape`]'s file.
    ///
    /// # Errors
    /// Every problem of the start shape.
    pub fn check(&self, start_shape: Option<&str>) -> Result<Scene, SceneErrors> {
        let mut problems = Problems::default();
        let root: Root = match toml::Value::Table(self.tree.clone()).try_into() {
            Ok(root) => root,
            Err(e) => {
                // The table of keys and the structs below disagree; a test makes sure that they do not.
                problems.add("", e.message());
                return Err(problems.into_errors(&self.source));
            }
        };
        let file = self.start_shape();
        let points = match (file, start_shape) {
            (Some(file), Some(text)) => start_shape::parse(file, text, root.cable.length, &mut problems),
            (Some(file), None) => {
                problems.add("initial.file", format!("{file} was not read"));
                vec![]
            }
            _ => vec![],
        };
        let (error, travel) = (root.mesh.error, root.mesh.travel);
        let mut scene = root.scene(points);
        super::wheels::check(&scene, &mut problems);
        if let Some(error) = error {
            scene.elements = crate::mesh::graded(&scene, error, travel);
        }
        problems.into_result(&self.source, scene)
    }
}

/// The file's frame, and the way from it to z up.
#[derive(Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Frame {
    ZUp,
    Ned,
}

impl Frame {
    fn vector(self, v: [f64; 3]) -> Vector3<f64> {
        let v = Vector3::from(v);
        match self {
            Self::ZUp => v,
            Self::Ned => z_flipped(v),
        }
    }

    fn direction(self, v: [f64; 3]) -> Vector3<f64> {
        // Scaled first, so that the length of huge or tiny vectors neither overflows nor vanishes.
        let v = self.vector(v);
        (v / v.amax()).normalize()
    }
}

/// C v with C = diag(1, -1, -1): from z down to z up and back.
pub(crate) fn z_flipped(v: Vector3<f64>) -> Vector3<f64> {
    Vector3::new(v.x, -v.y, -v.z)
}

#[derive(Deserialize)]
struct Root {
    name: String,
    description: String,
    gravity: f64,
    cable: CableTable,
    mesh: MeshTable,
    fluid: Option<FluidTable>,
    ship: Option<ShipTable>,
    winch: Option<WinchTable>,
    anchor: Option<PointTable>,
    #[serde(default)]
    sheave: Vec<SheaveTable>,
    body: Option<Body>,
    load: Option<Load>,
    far_end: Option<PointTable>,
    initial: InitialTable,
    solver: Solver,
    outputs: OutputsTable,
}

#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
struct CableTable {
    length: f64,
    diameter: f64,
    mass_per_length: f64,
    #[serde(rename = "EA")]
    ea: Option<f64>,
    #[serde(rename = "EI")]
    ei: Option<f64>,
    #[serde(rename = "E")]
    e: Option<f64>,
    #[serde(rename = "I")]
    i: Option<f64>,
    compression: Compression,
    strain: Strain,
    damping: Damping,
}

#[derive(Deserialize)]
struct MeshTable {
    elements: Option<usize>,
    error: Option<f64>,
    travel: Option<f64>,
    #[serde(default)]
    regions: Vec<Region>,
}

#[derive(Deserialize)]
struct Region {
    length: f64,
    elements: usize,
}

#[derive(Deserialize)]
struct FluidTable {
    density: f64,
    viscosity: Option<f64>,
    waterline: f64,
    drag: Drag,
    added_mass: f64,
    #[serde(default)]
    current: CurrentTable,
}

#[derive(Default, Deserialize)]
struct CurrentTable {
    #[serde(default)]
    profile: Vec<[f64; 3]>,
    noise: Option<Noise>,
}

#[derive(Deserialize)]
struct ShipTable {
    input: ShipInput,
    frame: Frame,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum ShipInput {
    Pose,
    PoseVelocity,
    PoseVelocityAcceleration,
}

#[derive(Deserialize)]
struct WinchTable {
    position: [f64; 3],
    axis: [f64; 3],
    radius: f64,
    angle: f64,
    gain_position: f64,
    gain_rate: f64,
    max_rate: Option<f64>,
    max_acceleration: Option<f64>,
    #[serde(flatten)]
    contact: Option<Contact>,
    command: Command,
    end: End,
    direction: i32,
    setpoint: Setpoint,
}

#[derive(PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Command {
    Angle,
    Payout,
}

#[derive(PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum End {
    Pinned,
    Tangent,
}

#[derive(Deserialize)]
struct PointTable {
    position: [f64; 3],
}

#[derive(Deserialize)]
struct SheaveTable {
    name: String,
    position: [f64; 3],
    axis: [f64; 3],
    radius: f64,
    side: Side,
    groove_angle: Option<f64>,
    groove_depth: Option<f64>,
    #[serde(flatten)]
    contact: Contact,
    friction: f64,
    inertia: Option<f64>,
    #[serde(default)]
    bearing_friction: f64,
    #[serde(default)]
    bearing_damping: f64,
}

#[derive(PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Side {
    Over,
    Under,
}

#[derive(Deserialize)]
#[serde(tag = "state", rename_all = "snake_case")]
enum InitialTable {
    Equilibrium,
    Released { direction: [f64; 3] },
    Straight { direction: [f64; 3] },
    Shape,
}

#[derive(Deserialize)]
struct OutputsTable {
    points: usize,
}

impl Root {
    fn scene(self, start_shape: Vec<ShapePoint>) -> Scene {
        let frame = self.ship.as_ref().map_or(Frame::ZUp, |s| s.frame);
        Scene {
            name: self.name,
            description: self.description,
            gravity: self.gravity,
            elements: self.mesh.elements(self.cable.length),
            cable: self.cable.checked(),
            fluid: self.fluid.map(|f| f.checked(frame)),
            ship: self.ship.map(|s| Ship { derivatives: s.input as usize, ned: s.frame == Frame::Ned }),
            winch: self.winch.map(|w| w.checked(frame)),
            anchor: self.anchor.map(|a| frame.vector(a.position)),
            sheaves: self.sheave.into_iter().enumerate().map(|(i, s)| s.checked(i, frame)).collect(),
            body: self.body,
            load: self.load,
            far_end: self.far_end.map(|e| frame.vector(e.position)),
            initial: self.initial.checked(start_shape, frame),
            solver: self.solver,
            points: self.outputs.points,
        }
    }
}

impl CableTable {
    fn checked(self) -> Cable {
        let area = PI / 4.0 * self.diameter.powi(2);
        let modulus = self.e.unwrap_or(0.0);
        Cable {
            length: self.length,
            diameter: self.diameter,
            mass_per_length: self.mass_per_length,
            ea: self.ea.unwrap_or(modulus * area),
            ei: self.ei.unwrap_or(modulus * self.i.unwrap_or(0.0)),
            compression: self.compression,
            strain: self.strain,
            damping: self.damping,
        }
    }
}

impl MeshTable {
    fn elements(&self, length: f64) -> Vec<f64> {
        let whole = self.elements.map(|elements| Region { length, elements });
        let regions = whole.iter().chain(&self.regions);
        regions.flat_map(|r| std::iter::repeat_n(r.length / r.elements as f64, r.elements)).collect()
    }
}

impl FluidTable {
    fn checked(self, frame: Frame) -> Fluid {
        let CurrentTable { profile: mut current, noise } = self.current;
        let height = |z: f64| if frame == Frame::Ned { -z } else { z };
        if frame == Frame::Ned {
            current.iter_mut().for_each(|[z, _, vy]| (*z, *vy) = (-*z, -*vy));
        }
        current.sort_by(|a, b| a[0].total_cmp(&b[0]));
        Fluid {
            density: self.density,
            viscosity: self.viscosity,
            waterline: height(self.waterline),
            drag: self.drag,
            added_mass: self.added_mass,
            current,
            noise,
        }
    }
}

impl WinchTable {
    fn checked(self, frame: Frame) -> Winch {
        Winch {
            position: frame.vector(self.position),
            axis: frame.direction(self.axis),
            radius: self.radius,
            angle: self.angle,
            gain_position: self.gain_position,
            gain_rate: self.gain_rate,
            max_rate: self.max_rate.unwrap_or(f64::INFINITY),
            max_acceleration: self.max_acceleration.unwrap_or(f64::INFINITY),
            contact: self.contact,
            payout_command: self.command == Command::Payout,
            tangent_end: self.end == End::Tangent,
            direction: f64::from(self.direction),
            setpoint: self.setpoint,
        }
    }
}

impl SheaveTable {
    fn checked(self, index: usize, frame: Frame) -> Sheave {
        Sheave {
            name: if self.name.is_empty() { format!("sheave[{}]", index + 1) } else { self.name },
            position: frame.vector(self.position),
            axis: frame.direction(self.axis),
            radius: self.radius,
            over: self.side == Side::Over,
            groove_angle: self.groove_angle,
            groove_depth: self.groove_depth.unwrap_or(f64::INFINITY),
            contact: self.contact,
            friction: self.friction,
            inertia: self.inertia,
            bearing_friction: self.bearing_friction,
            bearing_damping: self.bearing_damping,
        }
    }
}

impl InitialTable {
    fn checked(self, start_shape: Vec<ShapePoint>, frame: Frame) -> Initial {
        let turned = |v: Vector3<f64>| frame.vector(v.into());
        match self {
            Self::Equilibrium => Initial::Equilibrium,
            Self::Released { direction } => Initial::Released(frame.direction(direction)),
            Self::Straight { direction } => Initial::Straight(frame.direction(direction)),
            Self::Shape => Initial::Shape(
                start_shape
                    .into_iter()
                    .map(|p| ShapePoint {
                        s: p.s,
                        position: turned(p.position),
                        tangent: p.tangent.map(turned),
                        velocity: turned(p.velocity),
                    })
                    .collect(),
            ),
        }
    }
}
