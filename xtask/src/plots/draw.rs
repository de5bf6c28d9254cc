//! A chart drawn as SVG text.

use super::layout::{bounds, legend_layout, padded, simplified, ticks, widened};
use super::pen::{Face, Pen, canvas};
use super::{Chart, INK, Mark, Series};
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{Color as _, RGBColor};

const SOFT_INK: RGBColor = RGBColor(0x5B, 0x67, 0x73);
const GRID: RGBColor = RGBColor(0xE3, 0xE7, 0xEB);
const FRAME: RGBColor = RGBColor(0xA9, 0xB3, 0xBD);
const ZERO: RGBColor = RGBColor(0xC3, 0xCA, 0xD1);

impl Chart {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plots::{PALETTE, Panel, wave};

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
