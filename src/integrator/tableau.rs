//! Coefficients of the singly diagonally implicit methods with an explicit first stage.

/// A stiffly accurate method: its last stage is the solution.
#[derive(Debug)]
pub struct Tableau {
    /// γ, the diagonal element of all stages but the first, which is explicit.
    pub gamma: f64,
    /// c_i.
    pub nodes: &'static [f64],
    /// a_ij, j < i.
    pub weights: &'static [&'static [f64]],
    /// b_j − b̂_j: weights of the error estimate.
    pub estimate: &'static [f64],
    /// Order of the solution.
    pub order: usize,
    /// Order of the error estimate plus one: error ~ h^this.
    pub estimate_order: usize,
    /// Tolerable velocity error per tension error asked for, see [`Tableau::strictness`].
    pub strictness: f64,
}

impl Tableau {
    /// The same at a relative tolerance: errors of steps, h^estimate_order, add up to one of h^order, so that where these differ the tolerance
    /// of a step has to fall faster than that of the run. The number is the one with which a ringing string (P3 in
    /// fmu-tests/rust/methods.rs) comes out about as accurate as asked.
    pub fn strictness(&self, relative: f64) -> f64 {
        self.strictness * relative.powf(self.estimate_order as f64 / self.order as f64 - 1.0)
    }
}

/// A trapezoidal stage and a backward difference: order 2, L-stable, with an embedded third order (R.E. Bank et al., IEEE Trans. Electron
/// Devices 32 (1985) 1992-2007; M.E. Hosea & L.F. Shampine, Appl. Numer. Math. 20 (1996) 21-37). γ = 1 − √½, a_3j = √2/4.
pub static TR_BDF2: Tableau = Tableau {
    gamma: TR_GAMMA,
    nodes: &[0.0, 2.0 * TR_GAMMA, 1.0],
    weights: &[&[], &[TR_GAMMA], &[TR_W, TR_W]],
    estimate: &[(4.0 * TR_W - 1.0) / 3.0, -1.0 / 3.0, 2.0 * TR_GAMMA / 3.0],
    order: 2,
    estimate_order: 3,
    strictness: 1.5,
};
const TR_GAMMA: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;
const TR_W: f64 = 0.5 * std::f64::consts::FRAC_1_SQRT_2;

const ROOT: f64 = std::f64::consts::SQRT_2;

/// ESDIRK3(2)5L[2]SA: order 3, L-stable, stages of order 2 (C.A. Kennedy & M.H. Carpenter, NASA/TM-2016-219173, section 6.1.3).
pub static ESDIRK3: Tableau = Tableau {
    gamma: 0.225,
    nodes: &[0.0, 0.45, 9.0 * (2.0 + ROOT) / 40.0, 0.6, 1.0],
    weights: &[
        &[],
        &[0.225],
        &[9.0 * (1.0 + ROOT) / 80.0, 9.0 * (1.0 + ROOT) / 80.0],
        &[E3_41, E3_41, -7.0 / (40.0 * (1.0 + ROOT))],
        &[E3_51, E3_51, E3_53, E3_54],
    ],
    estimate: &[
        E3_51 - 4_555_948_517_383.0 / 24_713_416_420_891.0,
        E3_51 - 4_555_948_517_383.0 / 24_713_416_420_891.0,
        E3_53 + 7_107_561_914_881.0 / 25_547_637_784_726.0,
        E3_54 - 30_698_249.0 / 44_052_120.0,
        0.225 - 49_563.0 / 233_080.0,
    ],
    order: 3,
    estimate_order: 3,
    strictness: 0.4,
};
const E3_41: f64 = (22.0 + 15.0 * ROOT) / (80.0 * (1.0 + ROOT));
const E3_51: f64 = (2398.0 + 1205.0 * ROOT) / (2835.0 * (4.0 + 3.0 * ROOT));
const E3_53: f64 = -2374.0 * (1.0 + 2.0 * ROOT) / (2835.0 * (5.0 + 3.0 * ROOT));
const E3_54: f64 = 5827.0 / 7560.0;

/// ESDIRK4(3)6L[2]SA: order 4, L-stable, stages of order 2 (the same report, section 7.1.1).
pub static ESDIRK4: Tableau = Tableau {
    gamma: 0.25,
    nodes: &[0.0, 0.5, (2.0 - ROOT) / 4.0, 0.625, 1.04, 1.0],
    weights: &[
        &[],
        &[0.25],
        &[(1.0 - ROOT) / 8.0, (1.0 - ROOT) / 8.0],
        &[(5.0 - 7.0 * ROOT) / 64.0, (5.0 - 7.0 * ROOT) / 64.0, 7.0 * (1.0 + ROOT) / 32.0],
        &[E4_51, E4_51, (506_605.0 + 132_109.0 * ROOT) / 437_500.0, 166.0 * (-97.0 + 376.0 * ROOT) / 109_375.0],
        &[E4_61, E4_61, E4_63, E4_64, E4_65],
    ],
    estimate: &[
        E4_61 + 480_923_228_411.0 / 4_982_971_448_372.0,
        E4_61 + 480_923_228_411.0 / 4_982_971_448_372.0,
        E4_63 - 6_709_447_293_961.0 / 12_833_189_095_359.0,
        E4_64 - 3_513_175_791_894.0 / 6_748_737_351_361.0,
        E4_65 + 498_863_281_070.0 / 6_042_575_550_617.0,
        0.25 - 2_077_005_547_802.0 / 8_945_017_530_137.0,
    ],
    order: 4,
    estimate_order: 4,
    strictness: 0.1,
};
const E4_51: f64 = (-13_796.0 - 54_539.0 * ROOT) / 125_000.0;
const E4_61: f64 = (1181.0 - 987.0 * ROOT) / 13_782.0;
const E4_63: f64 = 47.0 * (-267.0 + 1783.0 * ROOT) / 273_343.0;
const E4_64: f64 = -16.0 * (-22_922.0 + 3525.0 * ROOT) / 571_953.0;
const E4_65: f64 = -15_625.0 * (97.0 + 376.0 * ROOT) / 90_749_876.0;

#[cfg(test)]
mod tests {
    use super::*;

    /// Σ_i b_i c_i^k = 1/(k+1), Σ a_ij = c_i, Σ a_ij c_j = ½ c_i² (stage order 2, but for the explicit stage), the same one order lower for
    /// b̂; L-stability is that of the sources.
    #[test]
    fn exact_order_conditions() {
        for tableau in [&TR_BDF2, &ESDIRK3, &ESDIRK4] {
            let n = tableau.nodes.len();
            let row = |i: usize| -> Vec<f64> { tableau.weights[i].iter().copied().chain((i > 0).then_some(tableau.gamma)).collect() };
            let sum = |w: &[f64], k: i32| -> f64 { w.iter().zip(tableau.nodes).map(|(w, c)| w * c.powi(k)).sum() };
            for i in 0..n {
                let (w, c) = (row(i), tableau.nodes[i]);
                assert!((sum(&w, 0) - c).abs() < 1e-14, "{tableau:?} row {i}");
                assert!((sum(&w, 1) - 0.5 * c * c).abs() < 1e-14, "{tableau:?} row {i}");
            }
            let solution = row(n - 1);
            let hat: Vec<f64> = solution.iter().zip(tableau.estimate).map(|(b, e)| b - e).collect();
            for k in 0..tableau.order {
                let whole = 1.0 / (k as f64 + 1.0);
                assert!((sum(&solution, k as i32) - whole).abs() < 1e-14, "{tableau:?} c^{k}");
            }
            // TR-BDF2's companion is better than itself, the others' worse; their coefficients are published to 1e-13.
            for k in 0..if tableau.order == 2 { 3 } else { tableau.order - 1 } {
                assert!((sum(&hat, k as i32) - 1.0 / (k as f64 + 1.0)).abs() < 1e-12, "{tableau:?} c^{k} of the companion");
            }
        }
    }
}
