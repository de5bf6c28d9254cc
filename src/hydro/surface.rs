//! How much of a thing lies below the still water surface. No share jumps as the thing dips.

/// Share of a horizontal sliver of height `d` centred at `z` that lies below `level`, and its derivative by z.
#[inline]
pub fn line_share(z: f64, level: f64, d: f64) -> (f64, f64) {
    let s = 0.5 + (level - z) / d;
    if s >= 1.0 {
        (1.0, 0.0)
    } else if s <= 0.0 {
        (0.0, 0.0)
    } else {
        (s, -1.0 / d)
    }
}

/// Share of a sphere of radius `r` centred at `z` that lies below `level` (spherical cap), and its derivative by z.
#[inline]
pub fn sphere_share(z: f64, level: f64, r: f64) -> (f64, f64) {
    let h = level - z + r; // wetted height
    if h >= 2.0 * r || r <= 0.0 && z <= level {
        (1.0, 0.0)
    } else if h <= 0.0 {
        (0.0, 0.0)
    } else {
        let i = 1.0 / (4.0 * r * r * r);
        (h * h * (3.0 * r - h) * i, -3.0 * h * (2.0 * r - h) * i)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_shares_are_continuous_and_match_their_slopes() {
        for share in [(|z| line_share(z, 0.3, 0.1)) as fn(f64) -> (f64, f64), |z| sphere_share(z, 0.3, 0.1)] {
            assert_eq!(share(0.0).0, 1.0);
            assert_eq!(share(0.6).0, 0.0);
            assert!((share(0.3).0 - 0.5).abs() < 1e-15);
            for i in 0..400 {
                let (z, h) = (0.1011 + 0.001 * i as f64, 1e-7);
                let d = (share(z + h).0 - share(z - h).0) / (2.0 * h);
                assert!((d - share(z).1).abs() < 1e-5, "{z}"); // second derivative 300 / m² times h
            }
        }
    }
}
