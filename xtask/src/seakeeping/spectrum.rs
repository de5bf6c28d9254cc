//! JONSWAP sea: spectrum and its realisation as a sum of cosines.
//!
//! Shape: K. Hasselmann et al., "Measurements of wind-wave growth and swell decay during the Joint North Sea Wave Project
//! (JONSWAP)", Ergänzungsheft zur Deutschen Hydrographischen Zeitschrift, Reihe A (8°), Nr. 12 (1973).

/// Acceleration of gravity, m/s².
pub const GRAVITY: f64 = 9.81;

/// Lowest and highest frequency of the realised sea, as multiples of the peak frequency. Of a JONSWAP sea's energy with
/// γ = 3.3, all but about 0.4 % lies between.
const BAND: (f64, f64) = (0.4, 4.0);

/// A sea state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeaState {
    /// Significant wave height H_s = 4 √m0, m.
    pub significant_height: f64,
    /// Peak period T_p, s.
    pub peak_period: f64,
    /// Peak enhancement γ (1 is Pierson-Moskowitz).
    pub gamma: f64,
}

impl SeaState {
    /// JONSWAP spectral density at circular frequency `omega`, without its constant factor; [`SeaState::components`] settles that.
    pub fn shape(&self, omega: f64) -> f64 {
        if omega <= 0.0 {
            return 0.0;
        }
        let nu = omega * self.peak_period / std::f64::consts::TAU;
        let sigma: f64 = if nu <= 1.0 { 0.07 } else { 0.09 };
        let r = (-0.5 * ((nu - 1.0) / sigma).powi(2)).exp();
        nu.powi(-5) * (-1.25 * nu.powi(-4)).exp() * self.gamma.powf(r)
    }

    /// The sea as `count` cosines. The band is cut into bins of equal width, and each component's frequency is drawn uniformly
    /// inside its bin, so that no two are commensurable and the sea does not repeat; phases are uniform. Amplitudes are
    /// √(2 S Δω), scaled together so that Σ a²/2 = m0 = H_s²/16 exactly for the components drawn.
    pub fn components(&self, count: usize, seed: u64) -> Vec<WaveComponent> {
        let peak = std::f64::consts::TAU / self.peak_period;
        let width = (BAND.1 - BAND.0) * peak / count as f64;
        let mut random = SplitMix64::new(seed);
        let mut components: Vec<WaveComponent> = (0..count)
            .map(|bin| {
                let omega = BAND.0 * peak + (bin as f64 + random.unit()) * width;
                let phase = std::f64::consts::TAU * random.unit();
                WaveComponent { omega, amplitude: self.shape(omega).sqrt(), phase }
            })
            .collect();
        let drawn: f64 = components.iter().map(|c| 0.5 * c.amplitude * c.amplitude).sum();
        let wanted = self.significant_height * self.significant_height / 16.0;
        let factor = if drawn > 0.0 { (wanted / drawn).sqrt() } else { 0.0 };
        for component in &mut components {
            component.amplitude *= factor;
        }
        components
    }
}

/// One long-crested regular wave of the sea.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WaveComponent {
    /// Circular frequency in the fixed frame, rad/s.
    pub omega: f64,
    /// Amplitude, m.
    pub amplitude: f64,
    /// Phase ε, rad.
    pub phase: f64,
}

/// SplitMix64 (G. L. Steele, D. Lea, C. H. Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014): integer
/// arithmetic only, so a seed gives the same numbers everywhere.
#[derive(Debug, Clone)]
pub struct SplitMix64(u64);

impl SplitMix64 {
    /// A stream that starts from `seed`.
    pub fn new(seed: u64) -> Self {
        SplitMix64(seed)
    }

    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1), 53 bits.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEA: SeaState = SeaState { significant_height: 2.5, peak_period: 8.0, gamma: 3.3 };

    #[test]
    fn exact_variance_of_the_components() {
        for count in [1, 7, 200] {
            let m0: f64 = SEA.components(count, 42).iter().map(|c| 0.5 * c.amplitude * c.amplitude).sum();
            // Rounding of a sum of `count` positive terms.
            assert!((m0 / (2.5 * 2.5 / 16.0) - 1.0).abs() < 1e-13, "{count}: {m0}");
        }
    }

    #[test]
    fn exact_peak_and_enhancement() {
        let peak = std::f64::consts::TAU / 8.0;
        let plain = SeaState { gamma: 1.0, ..SEA };
        assert!((SEA.shape(peak) / plain.shape(peak) - 3.3).abs() < 1e-12);
        assert!(SEA.shape(peak) > SEA.shape(0.97 * peak) && SEA.shape(peak) > SEA.shape(1.03 * peak));
        assert_eq!(SEA.shape(0.0), 0.0);
    }

    #[test]
    fn exact_energy_outside_the_band_is_small() {
        let peak = std::f64::consts::TAU / 8.0;
        let integral = |from: f64, to: f64| -> f64 {
            let n = 20_000;
            let h = (to - from) * peak / n as f64;
            (0..n).map(|i| SEA.shape(from * peak + (i as f64 + 0.5) * h) * h).sum()
        };
        let inside = integral(BAND.0, BAND.1);
        let outside = integral(0.01, BAND.0) + integral(BAND.1, 60.0);
        assert!(outside / inside < 0.004, "{}", outside / inside);
    }

    /// First outputs for seed 1234567, from the reference implementation by S. Vigna (splitmix64.c).
    #[test]
    fn cross_splitmix_reference_values() {
        let mut random = SplitMix64::new(1_234_567);
        assert_eq!(random.bits(), 6_457_827_717_110_365_317);
        assert_eq!(random.bits(), 3_203_168_211_198_807_973);
    }

    #[test]
    fn exact_frequencies_stay_in_their_bins() {
        let components = SEA.components(50, 3);
        assert!(components.windows(2).all(|pair| pair[0].omega < pair[1].omega));
        assert_ne!(SEA.components(50, 4), components);
        assert_eq!(SEA.components(50, 3), components);
    }
}
