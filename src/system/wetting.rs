//! Where along an element the water's surface lies.

/// Most pieces that a cubic can be cut into by two levels.
pub const PIECES: usize = 7;

/// Least and greatest Bézier control value, bounds of the cubic with end values z0, z1 and end slopes a, b by ξ.
#[inline(always)]
pub fn bounds(z0: f64, a: f64, z1: f64, b: f64) -> (f64, f64) {
    let (near, far) = (z0 + a / 3.0, z1 - b / 3.0);
    (z0.min(z1).min(near.min(far)), z0.max(z1).max(near.max(far)))
}

/// The element's height as a cubic in ξ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Height {
    c: [f64; 4],
    /// Bounds of the cubic.
    pub bounds: (f64, f64),
}

impl Height {
    /// From end heights and end slopes dz/dp of an element of length `l`.
    pub fn new(z0: f64, s0: f64, z1: f64, s1: f64, l: f64) -> Self {
        let (a, b) = (s0 * l, s1 * l);
        Self { c: [z0, a, 3.0 * (z1 - z0) - 2.0 * a - b, 2.0 * (z0 - z1) + a + b], bounds: bounds(z0, a, z1, b) }
    }

    fn at(&self, x: f64) -> f64 {
        self.c[0] + x * (self.c[1] + x * (self.c[2] + x * self.c[3]))
    }

    /// Cuts [0, 1] where the height passes `low` and `high`; calls `piece` with each part that dips below `high`.
    pub fn wet_pieces(&self, low: f64, high: f64, mut piece: impl FnMut(f64, f64)) {
        let mut cuts = [0.0; PIECES + 1];
        let mut n = 1;
        for level in [low, high] {
            self.crossings(level, |x| {
                cuts[n] = x;
                n += 1;
            });
        }
        cuts[n] = 1.0;
        cuts[1..n].sort_unstable_by(f64::total_cmp);
        for i in 0..n {
            let (a, b) = (cuts[i], cuts[i + 1]);
            if b > a && self.at(0.5 * (a + b)) < high {
                piece(a, b);
            }
        }
    }

    /// Interior ξ where the height equals `level`, at most three.
    fn crossings(&self, level: f64, mut found: impl FnMut(f64)) {
        if level <= self.bounds.0 || level >= self.bounds.1 {
            return;
        }
        // Monotone pieces between the extrema.
        let mut ends = [0.0; 4];
        let mut n = 1;
        let (a, b, c) = (3.0 * self.c[3], 2.0 * self.c[2], self.c[1]);
        let disc = b * b - 4.0 * a * c;
        if disc > 0.0 {
            let q = -0.5 * (b + disc.sqrt().copysign(b));
            let mut roots = [q / a, c / q];
            roots.sort_unstable_by(f64::total_cmp);
            for x in roots {
                if x > 0.0 && x < 1.0 {
                    ends[n] = x;
                    n += 1;
                }
            }
        }
        ends[n] = 1.0;
        for i in 0..n {
            let (mut lo, mut hi) = (ends[i], ends[i + 1]);
            let (flo, fhi) = (self.at(lo) - level, self.at(hi) - level);
            if flo * fhi >= 0.0 {
                continue;
            }
            // Newton inside a shrinking bracket, from the chord's root: elements are nearly straight.
            let mut x = lo + (hi - lo) * (flo / (flo - fhi));
            for _ in 0..80 {
                let f = self.at(x) - level;
                if f * flo > 0.0 {
                    lo = x
                } else {
                    hi = x
                }
                let d = self.c[1] + x * (2.0 * self.c[2] + x * 3.0 * self.c[3]);
                let newton = x - f / d;
                // The error after a step goes with the step's square.
                if (newton - x).abs() < 1e-11 {
                    x = newton.clamp(lo, hi);
                    break;
                }
                x = if newton > lo && newton < hi { newton } else { 0.5 * (lo + hi) };
            }
            found(x);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_pieces_are_where_the_cubic_is_low() {
        // z(ξ) = 16 (ξ − 0.2)(ξ − 0.5)(ξ − 0.9), slopes by differentiation.
        let z = |x: f64| 16.0 * (x - 0.2) * (x - 0.5) * (x - 0.9);
        let d = |x: f64| 16.0 * ((x - 0.5) * (x - 0.9) + (x - 0.2) * (x - 0.9) + (x - 0.2) * (x - 0.5));
        let l = 2.0;
        let h = Height::new(z(0.0), d(0.0) / l, z(1.0), d(1.0) / l, l);
        let mut pieces = vec![];
        h.wet_pieces(-1e-9, 1e-9, |a, b| pieces.push((a, b)));
        // Below zero on (0, 0.2) and (0.5, 0.9), each ending in a sliver of ramp.
        let wet: f64 = pieces.iter().map(|(a, b)| b - a).sum();
        assert!((wet - 0.6).abs() < 1e-8, "{pieces:?}");
        let mut all = 0.0;
        h.wet_pieces(50.0, 60.0, |a, b| all += b - a);
        assert_eq!(all, 1.0);
        h.wet_pieces(-60.0, -50.0, |_, _| panic!("dry"));
    }

    #[test]
    fn exact_cuts_lie_on_the_levels() {
        let mut seed = 1u64;
        let mut random = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        for _ in 0..20_000 {
            let h = Height::new(random(), random() * 4.0, random(), random() * 4.0, 1.0);
            let (low, high) = (random() * 0.4, random() * 0.1 + 0.25);
            let mut cuts = vec![];
            for level in [low, high] {
                h.crossings(level, |x| cuts.push((x, level)));
            }
            for (x, level) in cuts {
                assert!((h.at(x) - level).abs() < 2e-15, "{h:?} at {x} is {} from {level}", h.at(x) - level);
            }
        }
    }

    #[test]
    fn exact_straight_elements_are_cut_once() {
        let h = Height::new(1.0, -0.5, 0.0, -0.5, 2.0);
        let mut pieces = vec![];
        h.wet_pieces(0.2, 0.4, |a, b| pieces.push((a, b)));
        assert_eq!(pieces.len(), 2);
        assert!((pieces[0].0 - 0.6).abs() < 1e-15 && (pieces[1].0 - 0.8).abs() < 1e-15, "{pieces:?}");
    }
}
