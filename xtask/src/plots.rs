//! Line charts as SVG text, drawn with plotters' SVG backend.
//!
//! Text stays text in the SVG (the viewer's sans-serif), so no font is needed to write it. The backend takes whole pixels only;
//! everything is therefore drawn on a canvas [`FINENESS`] times as fine as the displayed size, and the header is rewritten to
//! display it at that size.

use plotters::backend::{DrawingBackend, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color as _, FontStyle, FontTransform, IntoFont, RGBAColor, RGBColor, ShapeStyle, TextStyle};

/// Canvas units per displayed pixel.
const FINENESS: f64 = 16.0;
/// Points that lie closer than this to the line without them are left out, px.
const TOLERANCE: f64 = 0.12;

/// The colour of text.
pub const INK: Colour = RGBColor(0x22, 0x2B, 0x36);
const SOFT_INK: RGBColor = RGBColor(0x5B, 0x67, 0x73);
const GRID: RGBColor = RGBColor(0xE3, 0xE7, 0xEB);
const FRAME: RGBColor = RGBColor(0xA9, 0xB3, 0xBD);
const ZERO: RGBColor = RGBColor(0xC3, 0xCA, 0xD1);

/// Colour of a mark or series.
pub type Colour = RGBColor;

/// Distinct colours that the colour-blind can tell apart (M. Okabe & K. Ito, "Color universal design", 2008), darkest first.
pub const PALETTE: [Colour; 6] = [
    RGBColor(0x00, 0x72, 0xB2),
    RGBColor(0xD5, 0x5E, 0x00),
    RGBColor(0x00, 0x9E, 0x73),
    RGBColor(0xCC, 0x79, 0xA7),
    RGBColor(0xE6, 0x9F, 0x00),
    RGBColor(0x56, 0xB4, 0xE9),
];

/// A colour for what is only there to compare with.
pub const SOFT: Colour = RGBColor(0xA9, 0xB3, 0xBD);

/// The colour of water.
pub const WATER: Colour = RGBColor(0x3B, 0x8E, 0xC2);

/// Colour at `fraction` (0 to 1) of a scale from dark violet to light green, ordered in lightness (after viridis, without its yellow end).
pub fn sequential(fraction: f64) -> Colour {
    const STOPS: [(f64, f64, f64); 5] =
        [(68.0, 1.0, 84.0), (62.0, 74.0, 137.0), (38.0, 130.0, 142.0), (53.0, 183.0, 121.0), (145.0, 208.0, 60.0)];
    let at = fraction.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let i = (at as usize).min(STOPS.len() - 2);
    let t = at - i as f64;
    let mix = |a: f64, b: f64| (a + t * (b - a)).round() as u8;
    let (a, b) = (STOPS[i], STOPS[i + 1]);
    RGBColor(mix(a.0, b.0), mix(a.1, b.1), mix(a.2, b.2))
}

/// A line through points, with an entry in the legend unless its label is empty.
#[derive(Debug, Clone)]
pub struct Series {
    /// Legend text.
    pub label: String,
    /// Points in data units. A point that is not finite breaks the line.
    pub points: Vec<(f64, f64)>,
    /// Line colour.
    pub colour: Colour,
    /// Line width, px.
    pub width: f64,
    /// Draw dashes.
    pub dashed: bool,
}

impl Series {
    /// A solid line of `y` over `x`.
    pub fn new(label: &str, x: &[f64], y: &[f64], colour: Colour) -> Series {
        Series { label: label.to_owned(), points: x.iter().copied().zip(y.iter().copied()).collect(), colour, width: 1.6, dashed: false }
    }

    /// The same line, dashed.
    pub fn dashed(mut self) -> Series {
        self.dashed = true;
        self
    }

    /// The same line, `width` pixels wide.
    pub fn width(mut self, width: f64) -> Series {
        self.width = width;
        self
    }
}

/// Something besides lines to draw in a panel, in data units.
#[derive(Debug, Clone)]
pub enum Mark {
    /// A circle outline of this radius along x, faintly filled. It counts for the range of the axes.
    Circle {
        /// Centre.
        centre: (f64, f64),
        /// Radius, data units.
        radius: f64,
        /// Colour.
        colour: Colour,
    },
    /// A dot of this radius in pixels.
    Dot {
        /// Centre.
        centre: (f64, f64),
        /// Radius, px.
        radius: f64,
        /// Colour.
        colour: Colour,
    },
    /// A horizontal line across the panel with everything below it tinted, and a label at its right end.
    Level {
        /// Height.
        y: f64,
        /// Label.
        label: String,
        /// Colour.
        colour: Colour,
    },
}

/// One coordinate system of a [`Chart`].
#[derive(Debug, Clone)]
pub struct Panel {
    /// Label of the vertical axis, with its unit.
    pub y_label: String,
    /// Lines, drawn in this order.
    pub series: Vec<Series>,
    /// Marks: dots are drawn over the lines, the others under them.
    pub marks: Vec<Mark>,
    /// Height, px (ignored with equal aspect).
    pub height: f64,
}

impl Panel {
    /// A panel of 190 px with these lines.
    pub fn new(y_label: &str, series: Vec<Series>) -> Panel {
        Panel { y_label: y_label.to_owned(), series, marks: Vec::new(), height: 190.0 }
    }

    /// The same panel with another height, px.
    pub fn height(mut self, height: f64) -> Panel {
        self.height = height;
        self
    }

    fn points(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        let lines = self.series.iter().flat_map(|s| s.points.iter().copied());
        let marks = self.marks.iter().flat_map(|mark| match mark {
            Mark::Circle { centre: (x, y), radius, .. } => vec![(x - radius, y - radius), (x + radius, y + radius)],
            Mark::Dot { centre, .. } => vec![*centre],
            Mark::Level { .. } => Vec::new(),
        });
        lines.chain(marks).filter(|(x, y)| x.is_finite() && y.is_finite())
    }
}

/// A titled column of panels over one horizontal axis.
#[derive(Debug, Clone)]
pub struct Chart {
    /// Title.
    pub title: String,
    /// Label of the horizontal axis, with its unit.
    pub x_label: String,
    /// Panels from the top.
    pub panels: Vec<Panel>,
    /// One unit is as long vertically as horizontally.
    pub equal_aspect: bool,
    /// Whole width, px.
    pub width: f64,
}

impl Chart {
    /// A chart of 880 px.
    pub fn new(title: &str, x_label: &str, panels: Vec<Panel>) -> Chart {
        Chart { title: title.to_owned(), x_label: x_label.to_owned(), panels, equal_aspect: false, width: 880.0 }
    }

    /// The chart as an SVG document. Panels without a finite point are drawn empty.
    pub fn svg(&self) -> String {
        const LEFT: f64 = 78.0;
        const RIGHT: f64 = 18.0;
        let plot_width = self.width - LEFT - RIGHT;
        let mut x_range = match bounds(self.panels.iter().flat_map(|p| p.points().map(|(x, _)| x))) {
            Some((low, high)) if self.equal_aspect => padded(low, high),
            Some((low, high)) if high > low => (low, high),
            Some((low, high)) => padded(low, high),
            None => (0.0, 1.0),
        };

        // Vertical layout: title, then for each panel its legend and its frame.
        struct Place {
            legend: Vec<(usize, f64, f64)>,
            top: f64,
            height: f64,
            y_range: (f64, f64),
        }
        let mut cursor = 38.0;
        let mut places = Vec::new();
        for panel in &self.panels {
            let mut y_range = bounds(panel.points().map(|(_, y)| y)).map_or((0.0, 1.0), |(low, high)| padded(low, high));
            let mut height = panel.height;
            if self.equal_aspect {
                let (dx, dy) = (x_range.1 - x_range.0, y_range.1 - y_range.0);
                height = (plot_width * dy / dx).clamp(260.0, 640.0);
                let scale = (dx / plot_width).max(dy / height);
                x_range = widened(x_range, scale * plot_width);
                y_range = widened(y_range, scale * height);
            }
            let (legend, rows) = legend_layout(&panel.series, plot_width);
            let top = cursor + 22.0 * rows as f64 + 6.0;
            places.push(Place {
                legend: legend.into_iter().map(|(i, x, row)| (i, LEFT + x, cursor + 22.0 * row as f64 + 10.0)).collect(),
                top,
                height,
                y_range,
            });
            cursor = top + height + 14.0;
        }
        let height = cursor + 40.0;

        let mut text = String::new();
        let mut pen = Pen::new(&mut text, self.width, height);
        pen.rect((0.0, 0.0), (self.width, height), RGBColor(255, 255, 255).to_rgba());
        pen.text(&self.title, (LEFT, 20.0), 15.5, INK, HPos::Left, VPos::Center, Face::Bold);

        for (index, (panel, place)) in self.panels.iter().zip(&places).enumerate() {
            let (top, bottom, right) = (place.top, place.top + place.height, LEFT + plot_width);
            let to_x = |x: f64| LEFT + (x - x_range.0) / (x_range.1 - x_range.0) * plot_width;
            let to_y = |y: f64| bottom - (y - place.y_range.0) / (place.y_range.1 - place.y_range.0) * place.height;
            let last = index + 1 == self.panels.len();

            for mark in &panel.marks {
                if let Mark::Level { y, colour, .. } = mark {
                    let level = to_y(*y).clamp(top, bottom);
                    pen.rect((LEFT, level), (right, bottom), colour.mix(0.10));
                }
            }
            // To scale, both axes get the same step.
            let spacing = if self.equal_aspect { (78.0, 78.0) } else { (85.0, (place.height / 8.0).max(22.0)) };
            let x_ticks = ticks(x_range, plot_width / spacing.0);
            for tick in &x_ticks.values {
                pen.line(&[(to_x(*tick), top), (to_x(*tick), bottom)], GRID.to_rgba(), 1.0);
                if last {
                    pen.text(&x_ticks.label(*tick), (to_x(*tick), bottom + 8.0), 12.0, SOFT_INK, HPos::Center, VPos::Top, Face::Plain);
                }
            }
            let y_ticks = ticks(place.y_range, place.height / spacing.1);
            for tick in &y_ticks.values {
                let colour = if *tick == 0.0 && !self.equal_aspect { ZERO } else { GRID };
                pen.line(&[(LEFT, to_y(*tick)), (right, to_y(*tick))], colour.to_rgba(), 1.0);
                pen.text(&y_ticks.label(*tick), (LEFT - 8.0, to_y(*tick)), 12.0, SOFT_INK, HPos::Right, VPos::Center, Face::Plain);
            }
            for mark in &panel.marks {
                match mark {
                    Mark::Level { y, label, colour } if to_y(*y) >= top && to_y(*y) <= bottom => {
                        pen.line(&[(LEFT, to_y(*y)), (right, to_y(*y))], colour.to_rgba(), 1.4);
                        pen.text(label, (right - 8.0, to_y(*y) - 9.0), 12.0, *colour, HPos::Right, VPos::Center, Face::Plain);
                    }
                    Mark::Level { .. } => {}
                    Mark::Circle { centre, radius, colour } => {
                        let r = radius / (x_range.1 - x_range.0) * plot_width;
                        pen.circle((to_x(centre.0), to_y(centre.1)), r, colour.mix(0.12), true);
                        pen.circle((to_x(centre.0), to_y(centre.1)), r, colour.to_rgba(), false);
                    }
                    Mark::Dot { .. } => {}
                }
            }
            for series in &panel.series {
                for run in series.points.split(|(x, y)| !x.is_finite() || !y.is_finite()) {
                    let path: Vec<(f64, f64)> = run.iter().map(|(x, y)| (to_x(*x), to_y(*y))).collect();
                    pen.stroke(&simplified(&path), series);
                }
            }
            for mark in &panel.marks {
                if let Mark::Dot { centre, radius, colour } = mark {
                    pen.circle((to_x(centre.0), to_y(centre.1)), *radius, colour.to_rgba(), true);
                }
            }
            let corners = [(LEFT, top), (right, top), (right, bottom), (LEFT, bottom), (LEFT, top)];
            pen.line(&corners, FRAME.to_rgba(), 1.0);
            pen.text(&panel.y_label, (18.0, 0.5 * (top + bottom)), 13.0, INK, HPos::Center, VPos::Center, Face::Upright);
            for &(i, x, y) in &place.legend {
                let series = &panel.series[i];
                pen.stroke(&[(x, y), (x + 24.0, y)], &Series { width: series.width.max(2.0), ..series.clone() });
                pen.text(&series.label, (x + 31.0, y), 12.5, INK, HPos::Left, VPos::Center, Face::Plain);
            }
            if last {
                pen.text(&self.x_label, (LEFT + 0.5 * plot_width, bottom + 30.0), 13.0, INK, HPos::Center, VPos::Top, Face::Plain);
            }
        }
        pen.finish();
        let canvas = (canvas(self.width), canvas(height));
        let drawn = format!("<svg width=\"{}\" height=\"{}\" ", canvas.0, canvas.1);
        let shown = format!("<svg width=\"{}\" height=\"{}\" stroke-linejoin=\"round\" ", self.width, height.round());
        text.replacen(&drawn, &shown, 1)
    }
}

/// Canvas coordinate of a displayed length.
fn canvas(length: f64) -> i32 {
    (length * FINENESS).round() as i32
}

/// Style of a text.
#[derive(Clone, Copy, PartialEq)]
enum Face {
    Plain,
    Bold,
    /// Reads upwards.
    Upright,
}

/// plotters' SVG backend in displayed pixels.
struct Pen<'a>(SVGBackend<'a>);

impl<'a> Pen<'a> {
    fn new(text: &'a mut String, width: f64, height: f64) -> Pen<'a> {
        Pen(SVGBackend::with_string(text, (canvas(width) as u32, canvas(height) as u32)))
    }

    fn point(p: (f64, f64)) -> (i32, i32) {
        (canvas(p.0), canvas(p.1))
    }

    fn style(colour: RGBAColor, width: f64) -> ShapeStyle {
        ShapeStyle { color: colour, filled: false, stroke_width: canvas(width) as u32 }
    }

    // Writing to a String does not fail, so the results of the backend's functions carry no news.

    fn line(&mut self, path: &[(f64, f64)], colour: RGBAColor, width: f64) {
        let _ = self.0.draw_path(path.iter().copied().map(Self::point), &Self::style(colour, width));
    }

    fn stroke(&mut self, path: &[(f64, f64)], series: &Series) {
        let pieces = if series.dashed { dashes(path, 6.0, 4.0) } else { vec![path.to_vec()] };
        for piece in pieces.iter().filter(|piece| piece.len() > 1) {
            self.line(piece, series.colour.to_rgba(), series.width);
        }
    }

    fn rect(&mut self, from: (f64, f64), to: (f64, f64), colour: RGBAColor) {
        let _ = self.0.draw_rect(Self::point(from), Self::point(to), &Self::style(colour, 0.0), true);
    }

    fn circle(&mut self, centre: (f64, f64), radius: f64, colour: RGBAColor, fill: bool) {
        let _ = self.0.draw_circle(Self::point(centre), canvas(radius) as u32, &Self::style(colour, 1.5), fill);
    }

    fn text(&mut self, text: &str, at: (f64, f64), size: f64, colour: RGBColor, h: HPos, v: VPos, face: Face) {
        // The backend divides the size by 1.24.
        let mut font = ("sans-serif", size * 1.24 * FINENESS).into_font();
        if face == Face::Bold {
            font = font.style(FontStyle::Bold);
        }
        if face == Face::Upright {
            font = font.transform(FontTransform::Rotate270);
        }
        let style = TextStyle::from(font).color(&colour).pos(Pos::new(h, v));
        let _ = self.0.draw_text(text, &style, Self::point(at));
    }

    fn finish(mut self) {
        let _ = self.0.present();
    }
}

/// Smallest and largest of the values.
fn bounds(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.fold(None, |range, value| match range {
        None => Some((value, value)),
        Some((low, high)) => Some((f64::min(low, value), f64::max(high, value))),
    })
}

/// The range with 6 % of air on either side; a range of no extent (or of rounding noise) gets a sensible one.
fn padded(low: f64, high: f64) -> (f64, f64) {
    let size = low.abs().max(high.abs());
    let extent = high - low;
    if extent <= 1e-9 * size || extent == 0.0 {
        let air = if size > 0.0 { 0.1 * size } else { 1.0 };
        return (low - air, high + air);
    }
    (low - 0.06 * extent, high + 0.06 * extent)
}

/// The range widened about its middle to the given extent.
fn widened(range: (f64, f64), extent: f64) -> (f64, f64) {
    let (middle, half) = (0.5 * (range.0 + range.1), 0.5 * extent.max(range.1 - range.0));
    (middle - half, middle + half)
}

/// Round numbers in a range and how to write them.
struct Ticks {
    values: Vec<f64>,
    decimals: usize,
    exponent: bool,
}

impl Ticks {
    fn label(&self, value: f64) -> String {
        let plain = if self.exponent && value != 0.0 { format!("{value:.1e}") } else { format!("{value:.*}", self.decimals) };
        plain.replace('-', "\u{2212}")
    }
}

/// At most about `count` multiples of 1, 2 or 5 times a power of ten.
fn ticks(range: (f64, f64), count: f64) -> Ticks {
    let raw = (range.1 - range.0) / count.max(1.0);
    let power = 10f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * power).find(|step| *step >= raw * (1.0 - 1e-9)).unwrap_or(10.0 * power);
    let slack = 1e-6 * step;
    let (first, last) = (((range.0 - slack) / step).ceil() as i64, ((range.1 + slack) / step).floor() as i64);
    let size = range.0.abs().max(range.1.abs());
    Ticks {
        values: (first..=last).map(|i| i as f64 * step).collect(),
        decimals: (-(step * (1.0 + 1e-9)).log10().floor()).clamp(0.0, 12.0) as usize,
        exponent: !(1e-4..1e6).contains(&size),
    }
}

/// Where the legend's entries go: (series, x, row), and the number of rows. Text widths are estimates.
fn legend_layout(series: &[Series], width: f64) -> (Vec<(usize, f64, usize)>, usize) {
    let (mut x, mut row) = (0.0, 0);
    let mut places = Vec::new();
    for (i, entry) in series.iter().enumerate().filter(|(_, entry)| !entry.label.is_empty()) {
        let needed = 31.0 + text_width(&entry.label, 12.5) + 22.0;
        if x > 0.0 && x + needed > width {
            (x, row) = (0.0, row + 1);
        }
        places.push((i, x, row));
        x += needed;
    }
    let rows = if places.is_empty() { 0 } else { row + 1 };
    (places, rows)
}

/// Estimated width of a sans-serif text, px; rather too wide than too narrow.
fn text_width(text: &str, size: f64) -> f64 {
    let em = |c: char| match c {
        'i' | 'j' | 'l' | '.' | ',' | ' ' | '\'' | '|' | ':' => 0.33,
        'f' | 't' | 'r' | '(' | ')' | '-' => 0.42,
        'm' | 'w' | 'M' | 'W' => 0.95,
        c if c.is_uppercase() => 0.72,
        _ => 0.62,
    };
    text.chars().map(em).sum::<f64>() * size
}

/// The path without points that lie within [`TOLERANCE`] of the chord that replaces them (Ramer-Douglas-Peucker).
fn simplified(path: &[(f64, f64)]) -> Vec<(f64, f64)> {
    if path.len() < 3 {
        return path.to_vec();
    }
    let mut keep = vec![false; path.len()];
    keep[0] = true;
    keep[path.len() - 1] = true;
    let mut open = vec![(0, path.len() - 1)];
    while let Some((from, to)) = open.pop() {
        let (a, b) = (path[from], path[to]);
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let length_squared = dx * dx + dy * dy;
        let distance_squared = |p: (f64, f64)| {
            let t = if length_squared > 0.0 { (((p.0 - a.0) * dx + (p.1 - a.1) * dy) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
            (p.0 - a.0 - t * dx).powi(2) + (p.1 - a.1 - t * dy).powi(2)
        };
        let farthest = (from + 1..to).map(|i| (i, distance_squared(path[i]))).max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((i, _)) = farthest.filter(|(_, d)| *d > TOLERANCE * TOLERANCE) {
            keep[i] = true;
            open.push((from, i));
            open.push((i, to));
        }
    }
    path.iter().zip(keep).filter(|(_, kept)| *kept).map(|(p, _)| *p).collect()
}

/// The path cut into dashes of `on` pixels with gaps of `off`.
fn dashes(path: &[(f64, f64)], on: f64, off: f64) -> Vec<Vec<(f64, f64)>> {
    let mut pieces: Vec<Vec<(f64, f64)>> = Vec::new();
    let Some(&first) = path.first() else { return pieces };
    let (mut drawing, mut left) = (true, on);
    let mut current = vec![first];
    for pair in path.windows(2) {
        let (mut a, b) = (pair[0], pair[1]);
        let mut length = (b.0 - a.0).hypot(b.1 - a.1);
        while length > left {
            let t = left / length;
            a = (a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1));
            length -= left;
            if drawing {
                current.push(a);
                pieces.push(std::mem::take(&mut current));
            } else {
                current = vec![a];
            }
            drawing = !drawing;
            left = if drawing { on } else { off };
        }
        left -= length;
        if drawing {
            current.push(b);
        }
    }
    if current.len() > 1 {
        pieces.push(current);
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave() -> (Vec<f64>, Vec<f64>) {
        let x: Vec<f64> = (0..6001).map(|i| 0.01 * i as f64).collect();
        let y = x.iter().map(|t| (1.3 * t).sin()).collect();
        (x, y)
    }

    #[test]
    fn exact_round_ticks() {
        let t = ticks((0.0, 60.0), 9.0);
        assert_eq!(t.values, [0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0]);
        assert_eq!(t.label(-10.0), "\u{2212}10");
        let fine = ticks((-0.0123, 0.031), 5.0);
        assert_eq!(fine.values.iter().map(|v| fine.label(*v)).collect::<Vec<_>>(), ["\u{2212}0.01", "0.00", "0.01", "0.02", "0.03"]);
        assert_eq!(ticks((0.0, 1.0), 5.0).label(0.2), "0.2");
        assert!(ticks((0.0, 3e7), 5.0).label(1e7).contains('e'));
    }

    #[test]
    fn exact_simplification_stays_within_tolerance_and_is_short() {
        let (x, y) = wave();
        let path: Vec<(f64, f64)> = x.iter().zip(&y).map(|(x, y)| (12.0 * x, 80.0 * y)).collect();
        let short = simplified(&path);
        assert!(short.len() < 900, "{}", short.len());
        let at = |t: f64| {
            let i = short.partition_point(|p| p.0 < t).clamp(1, short.len() - 1);
            let (a, b) = (short[i - 1], short[i]);
            (a.1 + (b.1 - a.1) * (t - a.0) / (b.0 - a.0), (b.1 - a.1) / (b.0 - a.0))
        };
        for p in &path {
            let (value, slope) = at(p.0);
            // Vertical distance of a point whose distance to the line is the tolerance.
            assert!((value - p.1).abs() <= TOLERANCE * slope.hypot(1.0) * 1.0001);
        }
    }

    #[test]
    fn exact_dashes_cover_their_share() {
        let pieces = dashes(&[(0.0, 0.0), (35.0, 0.0), (100.0, 0.0)], 6.0, 4.0);
        let drawn: f64 = pieces.iter().map(|p| p.last().unwrap().0 - p[0].0).sum();
        assert!((drawn - 60.0).abs() < 1e-9 && pieces.len() == 10, "{drawn} {}", pieces.len());
    }

    #[test]
    fn exact_gaps_and_odd_data_draw_something() {
        let (x, mut y) = wave();
        y[100] = f64::NAN;
        let svg = Chart::new("a < b & c", "Time, s", vec![Panel::new("y", vec![Series::new("s", &x, &y, PALETTE[0])])]).svg();
        // Two runs, the legend's sample, the frame and the grid.
        assert_eq!(svg.matches("#0072B2").count(), 3);
        assert!(svg.contains("a &lt; b &amp; c") && !svg.contains("NaN"));
        assert!(svg.starts_with("<svg width=\"880\" height=\"") && svg.trim_end().ends_with("</svg>"));
        for points in [vec![], vec![(1.0, 2.0)], vec![(0.0, 0.0), (1.0, 0.0)], vec![(f64::NAN, 1.0)], vec![(0.0, 5.0), (1.0, 5.0 + 1e-13)]]
        {
            let series = Series { points, ..Series::new("s", &[], &[], PALETTE[0]) };
            for equal_aspect in [false, true] {
                let chart = Chart { equal_aspect, ..Chart::new("t", "x", vec![Panel::new("y", vec![series.clone()])]) };
                let svg = chart.svg();
                assert!(!svg.contains("NaN") && svg.len() < 20_000);
            }
        }
    }

    #[test]
    fn exact_equal_aspect_has_round_circles() {
        let (x, y) = wave();
        let mut panel = Panel::new("z", vec![Series::new("", &x, &y, PALETTE[0])]);
        panel.marks.push(Mark::Circle { centre: (0.0, 0.0), radius: 1.0, colour: PALETTE[1] });
        let svg = Chart { equal_aspect: true, ..Chart::new("t", "x", vec![panel]) }.svg();
        assert!(svg.contains("<circle"));
    }
}
