//! The scenes of the report: built-in ones with keys changed, and small ones written here.

pub use super::wire::{G, NYLON, Row, Wire, shape_csv};
use crate::error::{Failure, Result};
use model_description::scenes::named;
use std::f64::consts::PI;
use toml::{Table, Value};

/// A scene file in memory, and the start shape that lies beside it as [`SHAPE`].
#[derive(Clone, Debug)]
pub struct Scene {
    table: Table,
    shape: Option<String>,
}

/// Name of the start shape's file: what `initial.file` says.
pub const SHAPE: &str = "shape.csv";

impl Scene {
    /// From the text of a scene file.
    ///
    /// # Errors
    /// No TOML.
    pub fn parse(text: &str) -> Result<Self> {
        let table = text.parse().map_err(|e| Failure(format!("a scene of the report: {e}\nin\n{text}")))?;
        Ok(Self { table, shape: None })
    }

    /// A built-in scene, if there is one of that name.
    ///
    /// # Errors
    /// As [`Self::parse`].
    pub fn built_in(name: &str) -> Result<Option<Self>> {
        named(name).map(|scene| Self::parse(scene.text)).transpose()
    }

    /// The scene with another value of a key, which may be a whole table; the key's tables are made if they are not there.
    pub fn with(mut self, key: &str, value: impl Into<Value>) -> Self {
        let (path, name) = key.rsplit_once('.').unwrap_or(("", key));
        let mut table = &mut self.table;
        for part in path.split('.').filter(|part| !part.is_empty()) {
            let inner = table.entry(part).or_insert_with(|| Value::Table(Table::new()));
            if !inner.is_table() {
                *inner = Value::Table(Table::new());
            }
            let Value::Table(inner) = inner else { return self };
            table = inner;
        }
        table.insert(name.to_owned(), value.into());
        self
    }

    /// The scene with a mesh of equal elements.
    pub fn elements(self, count: usize) -> Self {
        self.with("mesh", Table::from_iter([("elements".to_owned(), Value::Integer(count as i64))]))
    }

    /// The scene with every region's elements multiplied by `factor`, rounded, at least one.
    pub fn refined(mut self, factor: f64) -> Self {
        let regions = self.table.get_mut("mesh").and_then(|mesh| mesh.get_mut("regions")).and_then(Value::as_array_mut);
        for count in regions.into_iter().flatten().filter_map(|region| region.get_mut("elements")) {
            let old = count.as_integer().unwrap_or(1) as f64;
            *count = Value::Integer((factor * old).round().max(1.0) as i64);
        }
        self
    }

    /// The scene with a start shape.
    pub fn start_shape(mut self, rows: &[Row]) -> Self {
        self.shape = Some(shape_csv(rows));
        self.with("initial", Table::from_iter([("state".into(), "shape".into()), ("file".into(), SHAPE.into())]))
    }

    /// A number of the scene by its dotted key.
    pub fn number(&self, key: &str) -> Option<f64> {
        let value = key.split('.').try_fold(None::<&Value>, |at, part| Some(Some(at.map_or(self.table.get(part), |v| v.get(part))?)))??;
        value.as_float().or_else(|| value.as_integer().map(|n| n as f64))
    }

    /// Number of elements.
    pub fn element_count(&self) -> usize {
        let mesh = self.table.get("mesh");
        let regions = mesh.and_then(|m| m.get("regions")).and_then(Value::as_array).into_iter().flatten();
        let sum: i64 = regions.filter_map(|r| r.get("elements")?.as_integer()).sum();
        (sum + mesh.and_then(|m| m.get("elements")).and_then(Value::as_integer).unwrap_or(0)) as usize
    }

    /// The files: the scene's text, and the start shape's.
    pub fn files(&self) -> (String, Option<&str>) {
        (self.table.to_string(), self.shape.as_deref())
    }
}

impl Wire {
    /// The scene with `rest`, the other tables' text, an equal mesh, this gravity and so many points of the cable as outputs.
    ///
    /// # Errors
    /// `rest` is no TOML.
    pub fn scene(&self, gravity: f64, elements: usize, points: usize, rest: &str) -> Result<Scene> {
        Scene::parse(&self.text(gravity, elements, &format!("[outputs]\npoints = {points}\n{rest}")))
    }
}

/// P4's wire.
pub const HEAVY_WIRE: Wire =
    Wire { length: 200.0, diameter: 0.02, mass_per_length: 1.0, ea: 1e7, ei: 20.0, laws: "compression = \"none\"\ndamping.axial = 4e4" };
/// P4's other tables.
pub const HEAVED: &str = "[anchor]\nposition = [0, 0, 0]\n[body]\nmass = 500\n[ship]\ninput = \"pose_velocity_acceleration\"\n";

/// P5's tables: held above the water, a sphere in the flume's shear flow.
pub const SHEAR_FLOW: &str = "[anchor]\nposition = [0, 0, 0.46]\n\
    [fluid]\ndensity = 1026\nwaterline = 0\nadded_mass = 1\ncurrent.profile = [[0, 0.3302, 0], [-0.5, 0.03655, 0]]\n\
    drag = { law = \"cross_flow\", cd_normal = 2.30, cd_tangential = 0.05 }\n\
    [body]\nmass = 1.33e-3\nvolume = 5.235987755982989e-7\ndrag_area = 7.853981633974483e-5\ndrag_coefficient = 0.45\n";

/// P4's ship heave s(t) A sin(2πt/T), s a half-cosine ramp over two periods: z, its rate and acceleration.
pub fn heave(t: f64, amplitude: f64, period: f64) -> Vec<f64> {
    let (ramp, w) = (2.0 * period, 2.0 * PI / period);
    let k = PI / ramp;
    let s = if t < ramp { [0.5 * (1.0 - (k * t).cos()), 0.5 * k * (k * t).sin(), 0.5 * k * k * (k * t).cos()] } else { [1.0, 0.0, 0.0] };
    let h = [(w * t).sin(), w * (w * t).cos(), -w * w * (w * t).sin()].map(|x| amplitude * x);
    vec![s[0] * h[0], s[1] * h[0] + s[0] * h[1], s[2] * h[0] + 2.0 * s[1] * h[1] + s[0] * h[2]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_keys_are_set_and_read() {
        let scene = Scene::parse("[mesh]\nregions = [{ length = 1.0, elements = 5 }, { length = 2, elements = 3 }]\n").unwrap();
        assert_eq!(scene.element_count(), 8);
        assert_eq!(scene.clone().refined(0.5).element_count(), 5);
        let scene = scene.elements(7).with("solver.tolerance", 1e-3).with("gravity", 2.0);
        assert_eq!(scene.element_count(), 7);
        assert_eq!((scene.number("solver.tolerance"), scene.number("gravity"), scene.number("a.b")), (Some(1e-3), Some(2.0), None));
        let again = Scene::parse(&scene.files().0).unwrap();
        assert_eq!(again.table, scene.table);
    }

    #[test]
    fn exact_every_built_in_scene_survives_being_written_again() {
        for scene in model_description::scenes::SCENES {
            let text = Scene::built_in(scene.name).unwrap().unwrap().files().0;
            assert_eq!(text.parse::<Table>().unwrap(), scene.text.parse::<Table>().unwrap());
        }
    }
}
