//! A page for each built-in scene: what its file says in comments, and its start shape, drawn from the packed FMU.

use crate::error::{Failure, Result, at};
use crate::host::Fmu;
use crate::package::{Packer, root};
use crate::plots::{Chart, INK, Mark, PALETTE, Panel, Series, WATER};
use fairlead::scene::Scene;
use fairlead::variables::Model;
use model_description::notes::notes;
use model_description::scenes::{BuiltIn, SCENES};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

/// Points of the cable in a picture: enough that a turn on a drum looks round.
const POINTS: usize = 2001;
/// A wheel smaller than this part of the picture gets a second one, close up.
const SMALL: f64 = 1.0 / 15.0;

/// Where the pages of the built-in scenes lie.
pub fn folder() -> PathBuf {
    root().join("modelDescription").join("pages").join("scenes")
}

/// Writes all pages and pictures and prints their paths.
///
/// # Errors
/// A build or run that fails, a file that cannot be written.
pub fn write_all() -> Result<()> {
    let folder = folder();
    fs::create_dir_all(&folder).map_err(|e| at(&folder, e))?;
    let packer = Packer::new()?;
    for scene in SCENES {
        let shape = Shape::of(scene, &packer)?;
        let write = |file: String, text: String| {
            let path = folder.join(file);
            fs::write(&path, text).map_err(|e| at(&path, e))?;
            println!("{}", path.display());
            Ok::<_, Failure>(())
        };
        write(format!("{}.svg", scene.name), shape.picture(scene.name).svg())?;
        if let Some(close) = shape.close_up(scene.name) {
            write(format!("{}-close.svg", scene.name), close.svg())?;
        }
        write(format!("{}.md", scene.name), page(scene, &folder)?)?;
    }
    Ok(())
}

/// The page of a scene as Markdown; shows the close-up if its picture is in `folder`.
fn page(scene: &BuiltIn, folder: &Path) -> Result<String> {
    let notes = notes(scene.text);
    let name = scene.name;
    let mut p =
        format!("# {name}\n\n{}.\n\n![Start shape from the side]({name}.svg)\n\n", Model::built_in(scene)?.initial_scene.description);
    if folder.join(format!("{name}-close.svg")).is_file() {
        let _ = writeln!(p, "![The same, close up]({name}-close.svg)\n");
    }
    for paragraph in &notes.preface {
        let _ = writeln!(p, "{paragraph}\n");
    }
    for (title, assumed) in [("Assumed, for want of a source", true), ("Other remarks", false)] {
        let mut rows = notes.remarks.iter().filter(|r| r.is_assumed() == assumed).peekable();
        if rows.peek().is_some() {
            let _ = writeln!(p, "## {title}\n\n| key | value | remark |\n|---|---|---|");
            for r in rows {
                let _ = writeln!(p, "| `{}` | `{}` | {} |", r.key, r.value, r.text);
            }
            p.push('\n');
        }
    }
    let _ = writeln!(
        p,
        "The scene file is [{name}.toml](../../scenes/{name}.toml). `cargo xtask package {name}` packs it, \
         `cargo xtask scenes --pages` writes this page."
    );
    Ok(p)
}

/// Everything in a picture, in the x-z plane.
struct Shape {
    cable: Vec<(f64, f64)>,
    /// Centre and radius.
    wheels: Vec<((f64, f64), f64)>,
    end: Option<(f64, f64)>,
    waterline: Option<f64>,
}

impl Shape {
    /// Packs the scene with more output points and starts it.
    fn of(scene: &BuiltIn, packer: &Packer) -> Result<Self> {
        let temporary = tempfile::tempdir().map_err(|e| Failure(format!("no temporary folder: {e}")))?;
        let (file, fmu) = (temporary.path().join("scene.toml"), temporary.path().join("scene.fmu"));
        fs::write(&file, with_points(scene.text)).map_err(|e| at(&file, e))?;
        packer.write(&Model::read(&file)?, &fmu)?;
        let instance = Fmu::open(&fmu)?;
        let instance = instance.instantiate(scene.name)?;
        instance.setup(None, 0.0, None)?;
        instance.enter_initialization()?;
        instance.exit_initialization()?;
        let at = |name: &str| Ok::<_, Failure>((instance.get(&format!("{name}.x"))?, instance.get(&format!("{name}.z"))?));
        let cable = (1..=POINTS).map(|k| at(&format!("cable.point[{k}]"))).collect::<Result<_>>()?;
        let scene = Model::built_in(scene)?.initial_scene;
        let end = match (&scene.body, &scene.load) {
            (Some(_), _) => Some(at("body")?),
            (None, Some(_)) => Some(at("load")?),
            (None, None) => None,
        };
        Ok(Self { cable, wheels: wheels(&scene), end, waterline: scene.fluid.map(|f| f.waterline) })
    }

    fn extent(&self) -> f64 {
        let span = |pick: fn(&(f64, f64)) -> f64| {
            let (low, high) = self.cable.iter().map(pick).fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
            high - low
        };
        span(|p| p.0).max(span(|p| p.1))
    }

    /// Whole, or what lies in a window.
    fn chart(&self, title: String, window: Option<[(f64, f64); 2]>) -> Chart {
        let inside = |p: &(f64, f64)| window.is_none_or(|[a, b]| a.0 <= p.0 && p.0 <= b.0 && a.1 <= p.1 && p.1 <= b.1);
        // A point outside breaks the line.
        let cable = self.cable.iter().map(|p| if inside(p) { *p } else { (f64::NAN, f64::NAN) }).collect();
        let line = |points, colour, width: f64| Series { points, ..Series::new("", &[], &[], colour) }.width(width);
        let mut panel = Panel::new("z, m", vec![line(cable, PALETTE[0], 1.8)]);
        let link = self.cable.last().zip(self.end.as_ref()).filter(|(_, end)| inside(end));
        if let Some((attachment, end)) = link {
            panel.series.push(line(vec![*attachment, *end], INK, 2.5));
            panel.marks.push(Mark::Dot { centre: *end, radius: 5.0, colour: INK });
        }
        if let Some(y) = self.waterline {
            panel.marks.push(Mark::Level { y, label: "water surface".to_owned(), colour: WATER });
        }
        for &(centre, radius) in &self.wheels {
            panel.marks.push(Mark::Circle { centre, radius, colour: PALETTE[1] });
        }
        Chart { equal_aspect: true, width: 560.0, ..Chart::new(&title, "x, m", vec![panel]) }
    }

    fn picture(&self, name: &str) -> Chart {
        self.chart(format!("{name}: start shape"), None)
    }

    /// About drum and sheaves, where they are small beside the whole.
    fn close_up(&self, name: &str) -> Option<Chart> {
        let greatest = self.wheels.iter().map(|w| w.1).fold(0.0, f64::max);
        if greatest == 0.0 || greatest > SMALL * self.extent() {
            return None;
        }
        let reach = |w: &((f64, f64), f64), sign: f64| (w.0.0 + sign * 2.5 * w.1, w.0.1 + sign * 2.5 * w.1);
        let low = self.wheels.iter().map(|w| reach(w, -1.0)).reduce(|a, b| (a.0.min(b.0), a.1.min(b.1)))?;
        let high = self.wheels.iter().map(|w| reach(w, 1.0)).reduce(|a, b| (a.0.max(b.0), a.1.max(b.1)))?;
        Some(self.chart(format!("{name}: start shape, close up"), Some([low, high])))
    }
}

/// Drum and sheaves of a ship at rest whose axes lie across the picture.
fn wheels(scene: &Scene) -> Vec<((f64, f64), f64)> {
    let drum = scene.winch.iter().map(|w| (w.position, w.radius));
    let sheaves = scene.sheaves.iter().map(|s| (s.position, s.radius));
    drum.chain(sheaves).map(|(p, r)| ((p.x, p.z), r)).collect()
}

/// The same scene with [`POINTS`] output points.
fn with_points(text: &str) -> String {
    let line = |l: &str| if l.starts_with("points =") { format!("points = {POINTS}\n") } else { format!("{l}\n") };
    text.lines().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_pages_in_the_repository_are_those_of_the_scene_files() {
        for scene in SCENES {
            let folder = folder();
            let path = folder.join(format!("{}.md", scene.name));
            let found = fs::read_to_string(&path).unwrap_or_default().replace("\r\n", "\n");
            assert!(found == page(scene, &folder).unwrap(), "{}: write it anew by `cargo xtask scenes --pages`", path.display());
            assert!(folder.join(format!("{}.svg", scene.name)).is_file());
            assert!(with_points(scene.text).contains(&format!("points = {POINTS}\n")), "{}", scene.name);
        }
    }
}
