//! The report's small numerics: those it shares with the Rust tests, searches, logarithmic decrement, periods, the ellipsoid of a cloud of points.

pub use super::shared_numerics::{elliptic_k, relative_rms, rms, root, table};
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::PI;

/// The place of the least value of a function with one valley in [a, b], to `width`, and every place tried with its value, by golden-section
/// search (J. Kiefer, Proc. Amer. Math. Soc. 4 (1953) 502-506).
///
/// # Errors
/// The function's.
pub fn golden_section<E>(
    mut f: impl FnMut(f64) -> Result<f64, E>,
    (mut a, mut b): (f64, f64),
    width: f64,
) -> Result<(f64, Vec<(f64, f64)>), E> {
    let ratio = 0.5 * (5f64.sqrt() - 1.0);
    let mut tried = Vec::new();
    let mut value = |x: f64| {
        let y = f(x)?;
        tried.push((x, y));
        Ok(y)
    };
    let (mut c, mut d) = (b - ratio * (b - a), a + ratio * (b - a));
    let (mut fc, mut fd) = (value(c)?, value(d)?);
    while b - a > width {
        if fc < fd {
            (b, d, fd) = (d, c, fc);
            c = b - ratio * (b - a);
            fc = value(c)?;
        } else {
            (a, c, fc) = (c, d, fd);
            d = a + ratio * (b - a);
            fd = value(d)?;
        }
    }
    Ok((0.5 * (a + b), tried))
}

/// Two columns as pairs, as far as both go.
pub fn pairs(a: &[f64], b: &[f64]) -> Vec<(f64, f64)> {
    a.iter().copied().zip(b.iter().copied()).collect()
}

/// Least and greatest value.
pub fn extremes(values: &[f64]) -> [f64; 2] {
    values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(*v), high.max(*v)])
}

/// Damping ratio from the decay of a swing about zero: the logarithmic decrement over its maxima on the positive side, each found by the
/// parabola through three samples. None with fewer than two maxima.
pub fn damping_ratio(x: &[f64]) -> Option<f64> {
    let peaks: Vec<f64> = (1..x.len().saturating_sub(1))
        .filter(|i| x[*i] > x[i - 1] && x[*i] >= x[i + 1] && x[*i] > 0.0)
        .map(|i| x[i] + (x[i + 1] - x[i - 1]).powi(2) / (16.0 * (x[i] - 0.5 * (x[i + 1] + x[i - 1]))))
        .collect();
    let (first, last) = (peaks.first()?, peaks.last()?);
    let decrement = (first / last).ln() / peaks.len().checked_sub(1).filter(|n| *n > 0)? as f64;
    Some(decrement / (4.0 * PI * PI + decrement * decrement).sqrt())
}

/// Mean period of a swing about zero, from its zero crossings, each the root of the cubic through the four samples around it. None with
/// fewer than two crossings.
pub fn period(times: &[f64], x: &[f64]) -> Option<f64> {
    let mut crossings = Vec::new();
    for i in 1..x.len().saturating_sub(2) {
        if x[i] * x[i + 1] < 0.0 || x[i] == 0.0 {
            let lagrange = |t: f64| {
                let basis = |j: usize| (i - 1..i + 3).filter(|k| *k != j).map(|k| (t - times[k]) / (times[j] - times[k])).product::<f64>();
                (i - 1..i + 3).map(|j| x[j] * basis(j)).sum::<f64>()
            };
            crossings.push(root(lagrange, times[i], times[i + 1]));
        }
    }
    let swings = crossings.len().checked_sub(1).filter(|n| *n > 0)?;
    Some(2.0 * (crossings[swings] - crossings[0]) / swings as f64)
}

/// J₀ and J₁ by their series, good to rounding for arguments up to about 12.
pub fn bessel(x: f64) -> [f64; 2] {
    let q = -0.25 * x * x;
    let (mut term, mut j0, mut j1) = (1.0, 0.0, 0.0);
    for k in 0..60 {
        let k = f64::from(k);
        j0 += term;
        j1 += 0.5 * x * term / (k + 1.0);
        term *= q / ((k + 1.0) * (k + 1.0));
    }
    [j0, j1]
}

/// The ellipsoid of a cloud of points: its centre, and per principal axis the standard deviation (longest first) and the direction.
#[derive(Clone, Copy, Debug)]
pub struct Ellipsoid {
    /// Mean.
    pub centre: Vector3<f64>,
    /// Standard deviations along the axes, descending.
    pub deviations: [f64; 3],
    /// Unit vectors, each with its largest component positive.
    pub axes: [Vector3<f64>; 3],
}

impl Ellipsoid {
    /// From the eigenvectors of the covariance.
    pub fn of(points: &[Vector3<f64>]) -> Self {
        let n = points.len() as f64;
        let centre = points.iter().sum::<Vector3<f64>>() / n;
        let covariance = points.iter().map(|p| (p - centre) * (p - centre).transpose()).sum::<Matrix3<f64>>() / n;
        let eigen = covariance.symmetric_eigen();
        let mut order = [0, 1, 2];
        order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
        let axis = |i: usize| {
            let v = eigen.eigenvectors.column(i).into_owned();
            v * v[v.iamax()].signum()
        };
        Self { centre, deviations: order.map(|i| eigen.eigenvalues[i].max(0.0).sqrt()), axes: order.map(axis) }
    }

    /// Outline in the plane of two coordinates of the ellipsoid of `sigma` standard deviations, as a closed curve.
    pub fn outline(&self, sigma: f64, plane: [usize; 2]) -> Vec<(f64, f64)> {
        // A projection of an ellipsoid is the image of the unit circle under the Cholesky factor of the covariance's block.
        let c = |i: usize, j: usize| (0..3).map(|k| self.deviations[k].powi(2) * self.axes[k][i] * self.axes[k][j]).sum::<f64>();
        let [i, j] = plane;
        let a = c(i, i).sqrt();
        let b = if a > 0.0 { c(i, j) / a } else { 0.0 };
        let d = (c(j, j) - b * b).max(0.0).sqrt();
        (0..=120)
            .map(|k| {
                let (s, o) = (2.0 * PI * f64::from(k) / 120.0).sin_cos();
                (self.centre[i] + sigma * a * o, self.centre[j] + sigma * (b * o + d * s))
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Rotation3;

    #[test]
    fn exact_golden_section_finds_the_valley() {
        let (x, tried) = golden_section(|x: f64| Ok::<_, ()>((x - 1.2345).powi(2)), (1.0, 2.0), 1e-6).unwrap();
        // A parabola's value near its foot is lost to rounding only below 1e-8.
        assert!((x - 1.2345).abs() < 1e-6, "{x}");
        // Each try shortens the interval by 0.618: ln 1e-6/ln 0.618 = 28.7, and one to begin with.
        assert!(tried.len() <= 31, "{}", tried.len());
        assert_eq!(golden_section(|_| Err::<f64, _>("no"), (0.0, 1.0), 0.1), Err("no"));
    }

    #[test]
    fn exact_decrement_and_period_of_a_damped_swing() {
        let (zeta, w) = (0.061, 3.1);
        let damped = w * f64::sqrt(1.0 - zeta * zeta);
        let t: Vec<f64> = (0..1200).map(|i| 0.01 * f64::from(i)).collect();
        let x: Vec<f64> = t.iter().map(|t| (-zeta * w * t).exp() * (damped * t).cos()).collect();
        // Peaks by parabola: the fourth power of ω h = 0.03.
        assert!((damping_ratio(&x).unwrap() / zeta - 1.0).abs() < 1e-5, "{}", damping_ratio(&x).unwrap());
        // Crossings by cubics: (ω h)⁴/24.
        assert!((period(&t, &x).unwrap() * damped / (2.0 * PI) - 1.0).abs() < 1e-8, "{}", period(&t, &x).unwrap());
        assert_eq!((damping_ratio(&[0.0, 1.0, 0.0]), period(&t[..3], &x[..3])), (None, None));
    }

    #[test]
    fn exact_ellipsoid_of_a_turned_cloud() {
        // A product grid with known deviations, turned and moved.
        let turn = Rotation3::from_euler_angles(0.4, -0.7, 1.1);
        let centre = Vector3::new(-0.7, 0.01, -0.68);
        let grid = [-1.5f64, -0.5, 0.5, 1.5];
        let unit = f64::sqrt(1.25); // deviation of that grid
        let sizes = Vector3::new(0.03, 0.02, 0.004);
        let mut points = vec![];
        for x in grid {
            for y in grid {
                for z in grid {
                    points.push(centre + turn * Vector3::new(x, y, z).component_mul(&sizes));
                }
            }
        }
        let e = Ellipsoid::of(&points);
        assert!((e.centre - centre).norm() < 1e-15);
        for k in 0..3 {
            assert!((e.deviations[k] / (unit * sizes[k]) - 1.0).abs() < 1e-12, "{e:?}"); // rounding
            let axis = turn * Vector3::ith(k, 1.0);
            assert!((e.axes[k].dot(&axis).abs() - 1.0).abs() < 1e-12);
        }
        // The outline's extent along x is the deviation of x itself.
        let outline = e.outline(2.0, [0, 2]);
        let widest = outline.iter().fold(0.0f64, |m, p| m.max((p.0 - centre.x).abs()));
        let deviation = f64::sqrt(points.iter().map(|p| (p.x - centre.x).powi(2)).sum::<f64>() / points.len() as f64);
        assert!((widest / (2.0 * deviation) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn exact_special_functions() {
        // Abramowitz & Stegun, tables 9.1 and 17.1.
        assert!(bessel(2.404_825_557_695_773)[0].abs() < 1e-14);
        assert!((bessel(2.404_825_557_695_773)[1] - 0.519_147_497_289_467).abs() < 1e-13);
        assert!((elliptic_k(f64::sqrt(0.5)) - 1.854_074_677_301_372).abs() < 1e-13);
    }
}
