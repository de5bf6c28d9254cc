//! A figure that is held against a truth.

/// Which truth a figure is held against.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Truth {
    /// A closed form or a conservation law.
    Exact,
    /// A published measurement or result.
    Paper,
    /// Another program.
    Cross,
    /// Our own run, refined.
    Own,
}

impl Truth {
    /// The word that tests use too.
    pub fn word(self) -> &'static str {
        match self {
            Truth::Exact => "exact",
            Truth::Paper => "paper",
            Truth::Cross => "cross",
            Truth::Own => "own",
        }
    }
}

/// Whether a bound holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Within the bound.
    Holds,
    /// Outside, or the run failed.
    Missed,
    /// Shown beside a reference, nothing asked.
    Shown,
    /// This version cannot do it yet, or the scene is not there.
    Absent,
}

impl Verdict {
    /// For tables.
    pub fn word(self) -> &'static str {
        match self {
            Verdict::Holds => "holds",
            Verdict::Missed => "MISSED",
            Verdict::Shown => "shown",
            Verdict::Absent => "absent",
        }
    }
}

/// One figure, its reference and the verdict.
#[derive(Clone, Debug)]
pub struct Row {
    /// What was measured.
    pub what: String,
    /// Held against what kind of truth.
    pub truth: Truth,
    /// Ours; NaN where the run failed or is absent.
    pub measured: f64,
    /// What it should be.
    pub reference: f64,
    /// Of both.
    pub unit: &'static str,
    /// How far off: see [`Self::relative`].
    pub error: f64,
    /// The error is a share of the reference's size, not an amount in its unit.
    pub relative: bool,
    /// Greatest error allowed, if anything is asked.
    pub bound: Option<f64>,
    /// Where the reference comes from and why the bound is what it is; or why there is no figure.
    pub source: String,
    /// The line of the list that it belongs to.
    pub must: Option<super::must_hold::Must>,
    absent: bool,
}

impl Row {
    fn new(truth: Truth, what: impl Into<String>, measured: f64, reference: f64, unit: &'static str, error: f64, relative: bool) -> Self {
        let (what, source) = (what.into(), String::new());
        Self { what, truth, measured, reference, unit, error, relative, bound: None, source, must: None, absent: false }
    }

    /// Off by a share of the reference.
    pub fn relative(truth: Truth, what: impl Into<String>, measured: f64, reference: f64, unit: &'static str) -> Self {
        Self::new(truth, what, measured, reference, unit, (measured / reference - 1.0).abs(), true)
    }

    /// Off by an amount in the reference's unit.
    pub fn absolute(truth: Truth, what: impl Into<String>, measured: f64, reference: f64, unit: &'static str) -> Self {
        Self::new(truth, what, measured, reference, unit, (measured - reference).abs(), false)
    }

    /// An error itself: a distance, an rms, a share (unit "").
    pub fn error(truth: Truth, what: impl Into<String>, error: f64, unit: &'static str) -> Self {
        Self::new(truth, what, error, 0.0, unit, error.abs(), false)
    }

    /// What this version cannot do yet.
    pub fn absent(truth: Truth, what: impl Into<String>, why: impl Into<String>) -> Self {
        let row = Self::new(truth, what, f64::NAN, f64::NAN, "", f64::NAN, false);
        Self { absent: true, source: why.into(), ..row }
    }

    /// A run that failed: a miss.
    pub fn failed(truth: Truth, what: impl Into<String>, why: impl std::fmt::Display) -> Self {
        let row = Self::new(truth, what, f64::NAN, f64::NAN, "", f64::NAN, false);
        Self { bound: Some(0.0), source: format!("did not run: {why}"), ..row }
    }

    /// With the greatest error allowed.
    pub fn within(self, bound: f64) -> Self {
        Self { bound: Some(bound), ..self }
    }

    /// With where it comes from and why the bound is what it is.
    pub fn because(self, source: impl Into<String>) -> Self {
        Self { source: source.into(), ..self }
    }

    /// Belongs to this line of the list.
    pub fn must(self, must: super::must_hold::Must) -> Self {
        Self { must: Some(must), ..self }
    }

    /// Whether the bound holds. A NaN never does.
    pub fn verdict(&self) -> Verdict {
        match self.bound {
            _ if self.absent => Verdict::Absent,
            None => Verdict::Shown,
            Some(bound) if self.error <= bound => Verdict::Holds,
            Some(_) => Verdict::Missed,
        }
    }

    /// How much of the bound is used, for finding the worst; a miss without a figure counts most.
    pub fn share(&self) -> f64 {
        match self.bound {
            Some(_) if self.error.is_nan() => f64::INFINITY,
            Some(bound) if self.error == 0.0 && bound == 0.0 => 0.0,
            Some(bound) => self.error / bound,
            None => 0.0,
        }
    }

    /// The cells: measured, reference, off by, bound.
    pub fn cells(&self) -> [String; 4] {
        let with = |x: f64, unit: &str| match x {
            _ if x.is_nan() => String::new(),
            _ if unit.is_empty() => figure(x),
            _ => format!("{} {unit}", figure(x)),
        };
        let off = |x: f64| match (self.relative, x.is_nan()) {
            (_, true) => String::new(),
            (true, false) => share(x),
            (false, false) => with(brief(x), self.unit),
        };
        // An error itself is not written twice.
        let pure = self.reference == 0.0 && !self.relative;
        let error = off(self.error);
        let (measured, reference) =
            if pure { (String::new(), String::new()) } else { (with(self.measured, self.unit), with(self.reference, self.unit)) };
        [measured, reference, error, self.bound.map_or(String::new(), off)]
    }
}

/// Six significant digits, without trailing zeros; an exponent where the number is tiny or huge.
pub fn figure(x: f64) -> String {
    if x == 0.0 {
        return "0".into();
    }
    if !x.is_finite() {
        return x.to_string();
    }
    let size = x.abs();
    if !(1e-3..1e7).contains(&size) {
        let text = format!("{x:.3e}");
        let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        return format!("{}e{exponent}", trimmed(digits));
    }
    let decimals = (5 - size.log10().floor() as i32).clamp(0, 9) as usize;
    trimmed(&format!("{x:.decimals$}"))
}

fn trimmed(text: &str) -> String {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text.to_owned() }
}

/// Three significant digits: nobody needs more of an error.
fn brief(x: f64) -> f64 {
    format!("{x:.2e}").parse().unwrap_or(x)
}

/// A share of one: percent with two digits, or an exponent where that is tiny.
pub fn share(x: f64) -> String {
    let percent = 100.0 * x;
    match percent.abs() {
        0.0 => "0 %".into(),
        p if p < 1e-3 => format!("{x:.1e}"),
        p => {
            let decimals = (1 - p.log10().floor() as i32).clamp(0, 5) as usize;
            format!("{percent:.decimals$} %")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_figures_have_six_digits() {
        for (x, text) in [(0.0, "0"), (1.5, "1.5"), (123456.789, "123457"), (-0.0123456789, "-0.0123457"), (2.82e-6, "2.82e-6"), (9.0, "9")]
        {
            assert_eq!(figure(x), text);
        }
        assert_eq!((share(0.0123), share(1e-7), share(0.5)), ("1.2 %".into(), "1.0e-7".into(), "50 %".into()));
    }

    #[test]
    fn exact_verdicts_of_rows() {
        let row = Row::relative(Truth::Exact, "x", 1.01, 1.0, "m");
        assert_eq!(row.verdict(), Verdict::Shown);
        assert_eq!(row.clone().within(0.02).verdict(), Verdict::Holds);
        assert_eq!(row.within(0.005).verdict(), Verdict::Missed);
        assert_eq!(Row::failed(Truth::Exact, "x", "no").verdict(), Verdict::Missed);
        assert_eq!(Row::error(Truth::Exact, "x", f64::NAN, "").within(1.0).verdict(), Verdict::Missed);
        assert_eq!(Row::absent(Truth::Exact, "x", "no").verdict(), Verdict::Absent);
    }
}
