//! What issue 3 asks to hold, line by line, each with the worst figure of the report that belongs to it.

use super::row::{Row, Verdict};

/// A line of the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Must {
    /// Extremes of 4.1 within the thesis's own greatest errors of the measured ranges.
    Extremes,
    /// Half the elements change them by less than half a percent.
    Halved,
    /// P1: wrap.
    P1Wrap,
    /// P1: tension.
    P1Tension,
    /// Static hang over a sheave.
    Hang,
    /// Flanks under a fleet angle.
    Fleet,
    /// Rotating scene and ship together.
    Turned,
    /// Slow sweep over the edge of contact.
    Sweep,
    /// Tangent against differences.
    Tangent,
    /// Sliding friction.
    Capstan,
    /// A sheave that turns without bearing friction.
    Turning,
    /// Errors that name the sheave and the numbers.
    Refusals,
}

/// All lines, in the order, in its words.
pub const LINES: [(Must, &str); 12] = [
    (Must::Extremes, "4.1: extremes of the rope's angle and of the tension within the thesis's own greatest errors of the measured ranges"),
    (Must::Halved, "... at a mesh where half the elements change the extremes by less than 0.5 %"),
    (Must::P1Wrap, "P1, at most 40 elements: wrap rms below 1e-4 rad"),
    (Must::P1Tension, "P1, at most 40 elements: tension rms below 0.2 %"),
    (
        Must::Hang,
        "Static hang over a sheave, wrap 90°, several groove angles: resultant, line load, penetration, flank forces within 0.5 % of closed form",
    ),
    (Must::Fleet, "With a fleet angle the two flanks differ as statics says (0.5 %)"),
    (Must::Turned, "Rotating scene and ship together changes nothing (1e-9)"),
    (Must::Sweep, "The contact force along a slow sweep over the sheave's edge has no jump"),
    (Must::Tangent, "Tangent against differences to 1e-6 in and at the edge of contact"),
    (Must::Capstan, "Capstan T2/T1 = exp(μθ) within 1 % when sliding"),
    (Must::Turning, "A turning sheave with no bearing friction has equal tensions at rest"),
    (Must::Refusals, "Impossible sheaves and starts: clear errors that name the sheave and the numbers"),
];

/// The figure that uses most of its bound, with how many there are.
pub fn worst<'a>(must: Must, rows: impl Iterator<Item = &'a Row>) -> Option<(&'a Row, usize)> {
    let all: Vec<&Row> = rows.filter(|row| row.must == Some(must)).collect();
    // What is absent counts as much as a miss: it must not hide behind a figure that holds.
    let weight = |row: &Row| if row.verdict() == Verdict::Absent { f64::MAX } else { row.share() };
    let worst = all.iter().copied().max_by(|a, b| weight(a).total_cmp(&weight(b)))?;
    Some((worst, all.len()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::row::Truth;

    #[test]
    fn exact_the_worst_figure_speaks_for_the_line() {
        let row = |error: f64| Row::error(Truth::Exact, "x", error, "m").within(1.0).must(Must::Hang);
        let rows = [row(0.2), row(0.7), row(0.1), row(5.0).must(Must::Fleet)];
        let (worst_row, count) = worst(Must::Hang, rows.iter()).unwrap();
        assert_eq!((worst_row.error, count), (0.7, 3));
        let with_absent = [row(0.2), Row::absent(Truth::Exact, "y", "not yet").must(Must::Hang)];
        assert_eq!(worst(Must::Hang, with_absent.iter()).unwrap().0.verdict(), Verdict::Absent);
        assert!(worst(Must::P1Wrap, rows.iter()).is_none());
    }
}
