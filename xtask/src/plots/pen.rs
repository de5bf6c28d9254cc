//! plotters' SVG backend in displayed pixels.
//!
//! Text stays text in the SVG (the viewer's sans-serif), so no font is needed to write it. The backend takes whole pixels only;
//! everything is therefore drawn on a canvas [`FINENESS`] times as fine as the displayed size, and the header is rewritten to
//! display it at that size.

use super::Series;
use super::layout::dashes;
use plotters::backend::{DrawingBackend, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color as _, FontStyle, FontTransform, IntoFont, RGBAColor, RGBColor, ShapeStyle, TextStyle};

/// Canvas units per displayed pixel.
const FINENESS: f64 = 16.0;

/// Canvas coordinate of a displayed length.
pub(super) fn canvas(length: f64) -> i32 {
    (length * FINENESS).round() as i32
}

/// Style of a text.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Face {
    Plain,
    Bold,
    /// Reads upwards.
    Upright,
}

/// plotters' SVG backend in displayed pixels.
pub(super) struct Pen<'a>(SVGBackend<'a>);

impl<'a> Pen<'a> {
    pub(super) fn new(text: &'a mut String, width: f64, height: f64) -> Pen<'a> {
        Pen(SVGBackend::with_string(text, (canvas(width) as u32, canvas(height) as u32)))
    }

    fn point(p: (f64, f64)) -> (i32, i32) {
        (canvas(p.0), canvas(p.1))
    }

    fn style(colour: RGBAColor, width: f64) -> ShapeStyle {
        ShapeStyle { color: colour, filled: false, stroke_width: canvas(width) as u32 }
    }

    // Writing to a String does not fail, so the results of the backend's functions carry no news.

    pub(super) fn line(&mut self, path: &[(f64, f64)], colour: RGBAColor, width: f64) {
        let _ = self.0.draw_path(path.iter().copied().map(Self::point), &Self::style(colour, width));
    }

    pub(super) fn stroke(&mut self, path: &[(f64, f64)], series: &Series) {
        let pieces = if series.dashed { dashes(path, 6.0, 4.0) } else { vec![path.to_vec()] };
        for piece in pieces.iter().filter(|piece| piece.len() > 1) {
            self.line(piece, series.colour.to_rgba(), series.width);
        }
    }

    pub(super) fn rect(&mut self, from: (f64, f64), to: (f64, f64), colour: RGBAColor) {
        let _ = self.0.draw_rect(Self::point(from), Self::point(to), &Self::style(colour, 0.0), true);
    }

    pub(super) fn circle(&mut self, centre: (f64, f64), radius: f64, colour: RGBAColor, fill: bool) {
        let _ = self.0.draw_circle(Self::point(centre), canvas(radius) as u32, &Self::style(colour, 1.5), fill);
    }

    pub(super) fn text(&mut self, text: &str, at: (f64, f64), size: f64, colour: RGBColor, h: HPos, v: VPos, face: Face) {
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

    pub(super) fn finish(mut self) {
        let _ = self.0.present();
    }
}
