//! Numbers as the report writes them: in a unit that suits their size, to three figures.

/// A unit and its smaller or larger relatives: (symbol, how many of it make one SI unit), smallest first.
pub struct Unit(&'static [(&'static str, f64)]);

pub const LENGTH: Unit = Unit(&[("mm", 1e3), ("m", 1.0)]);
/// For positions of which the change counts.
pub const MILLIMETRES: Unit = Unit(&[("mm", 1e3)]);
pub const FORCE: Unit = Unit(&[("mN", 1e3), ("N", 1.0), ("kN", 1e-3)]);
pub const LINE_LOAD: Unit = Unit(&[("mN/m", 1e3), ("N/m", 1.0), ("kN/m", 1e-3)]);
pub const ANGLE: Unit = Unit(&[("°", 180.0 / std::f64::consts::PI)]);
pub const TORQUE: Unit = Unit(&[("mN·m", 1e3), ("N·m", 1.0), ("kN·m", 1e-3)]);

impl Unit {
    /// The smallest unit in which the values stay below 300.
    pub fn fitting(&self, values: impl Iterator<Item = f64>) -> (&'static str, f64) {
        let largest = values.filter(|v| v.is_finite()).fold(0.0, |m: f64, v| m.max(v.abs()));
        *self.0.iter().find(|(_, factor)| largest * factor < 300.0).unwrap_or(&self.0[self.0.len() - 1])
    }
}

/// All values times `factor`.
pub fn times(values: &[f64], factor: f64) -> Vec<f64> {
    values.iter().map(|v| v * factor).collect()
}

/// Three significant figures, without an exponent.
pub fn rounded(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let decimals = (2 - value.abs().log10().floor() as i32).max(0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// A whole number with narrow spaces between thousands.
pub fn grouped(count: f64) -> String {
    let digits = format!("{count:.0}");
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) && digits.as_bytes()[i - 1].is_ascii_digit() {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_numbers_read_well() {
        assert_eq!(rounded(48.6224), "48.6");
        assert_eq!(rounded(60.0), "60");
        assert_eq!(rounded(1234.5), "1234");
        assert_eq!(rounded(0.012345), "0.0123");
        assert_eq!(grouped(1_234_567.0), "1\u{202f}234\u{202f}567");
        assert_eq!(grouped(999.0), "999");
    }
}
