//! Line charts as SVG text, drawn with plotters' SVG backend.

mod draw;
mod layout;
mod pen;

use plotters::style::RGBColor;

/// The colour of text.
pub const INK: Colour = RGBColor(0x22, 0x2B, 0x36);
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
}

/// Sixty seconds of a wave, for the tests.
#[cfg(test)]
fn wave() -> (Vec<f64>, Vec<f64>) {
    let x: Vec<f64> = (0..6001).map(|i| 0.01 * i as f64).collect();
    let y = x.iter().map(|t| (1.3 * t).sin()).collect();
    (x, y)
}
