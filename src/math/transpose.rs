//! From numbers node by node, six a node, to rows side by side and back.
//!
//! Moves numbers only, so every way of doing it gives the same. Element by element it costs as much as the kernels that it feeds, so the widest
//! registers have a way of their own.

use super::lanes::Lanes;

/// Nodes, or elements, side by side.
const LANES: usize = 8;
/// A number of each.
type Row = Lanes<LANES>;
/// Numbers of so many nodes.
pub const BLOCK: usize = 6 * LANES;

/// out[k][l] = x[6 l + k].
#[inline(always)]
pub fn to_rows(x: &[f64; BLOCK]) -> [Row; 6] {
    #[cfg(target_arch = "x86_64")]
    if super::dispatch::has_avx512() {
        // SAFETY: the processor has the registers.
        #[allow(unsafe_code)]
        return unsafe { avx512::to_rows(x) };
    }
    let mut out = [Row::ZERO; 6];
    for k in 0..6 {
        for l in 0..LANES {
            out[k].0[l] = x[6 * l + k];
        }
    }
    out
}

/// The way back.
#[inline(always)]
pub fn from_rows(rows: &[Row; 6]) -> [f64; BLOCK] {
    #[cfg(target_arch = "x86_64")]
    if super::dispatch::has_avx512() {
        // SAFETY: the processor has the registers.
        #[allow(unsafe_code)]
        return unsafe { avx512::from_rows(rows) };
    }
    let mut out = [0.0; BLOCK];
    for k in 0..6 {
        for l in 0..LANES {
            out[6 * l + k] = rows[k].0[l];
        }
    }
    out
}

/// A row moved up by one lane, with a number in the first.
#[inline(always)]
pub fn previous(row: &Row, first: f64) -> Row {
    let mut out = Row::ZERO;
    for l in 1..LANES {
        out.0[l] = row.0[l - 1];
    }
    out.0[0] = first;
    out
}

/// Sixteen numbers of two registers at a time: a number's place in all of them, modulo 16, says which of the two and where.
#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code)]
mod avx512 {
    use super::{BLOCK, LANES, Row};
    use std::arch::x86_64::{__m512i, _mm512_loadu_pd, _mm512_mask_blend_pd, _mm512_permutex2var_pd, _mm512_setzero_pd, _mm512_storeu_pd};

    /// Where lane l of an output finds its number among sixteen, and which lanes of it lie in the second and in the third pair of registers.
    #[derive(Clone, Copy)]
    struct Choice {
        place: [i64; LANES],
        second: u8,
        third: u8,
    }

    const fn choice(places: [usize; LANES]) -> Choice {
        let mut out = Choice { place: [0; LANES], second: 0, third: 0 };
        let mut l = 0;
        while l < LANES {
            out.place[l] = (places[l] % 16) as i64;
            match places[l] / 16 {
                1 => out.second |= 1 << l,
                2 => out.third |= 1 << l,
                _ => {}
            }
            l += 1;
        }
        out
    }

    /// Row k has lane l at 6 l + k.
    const TO: [Choice; 6] = {
        let mut out = [choice([0; LANES]); 6];
        let mut k = 0;
        while k < 6 {
            let mut places = [0; LANES];
            let mut l = 0;
            while l < LANES {
                places[l] = 6 * l + k;
                l += 1;
            }
            out[k] = choice(places);
            k += 1;
        }
        out
    };

    /// Number i = 6 l + k is lane l of row k, at 8 k + l.
    const FROM: [Choice; 6] = {
        let mut out = [choice([0; LANES]); 6];
        let mut j = 0;
        while j < 6 {
            let mut places = [0; LANES];
            let mut l = 0;
            while l < LANES {
                let i = LANES * j + l;
                places[l] = LANES * (i % 6) + i / 6;
                l += 1;
            }
            out[j] = choice(places);
            j += 1;
        }
        out
    };

    /// # Safety
    /// The processor must have AVX-512F.
    #[inline]
    #[target_feature(enable = "avx512f")]
    unsafe fn choose(from: *const f64, to: *mut f64, choices: &[Choice; 6]) {
        // SAFETY: both hold six times eight numbers.
        unsafe {
            let mut x = [_mm512_setzero_pd(); 6];
            for j in 0..6 {
                x[j] = _mm512_loadu_pd(from.add(LANES * j));
            }
            for j in 0..6 {
                let c = &choices[j];
                let place: __m512i = std::mem::transmute(c.place);
                let [a, b, d] = [0, 2, 4].map(|i| _mm512_permutex2var_pd(x[i], place, x[i + 1]));
                _mm512_storeu_pd(to.add(LANES * j), _mm512_mask_blend_pd(c.third, _mm512_mask_blend_pd(c.second, a, b), d));
            }
        }
    }

    /// # Safety
    /// The processor must have AVX-512F.
    #[inline]
    #[target_feature(enable = "avx512f")]
    pub unsafe fn to_rows(x: &[f64; BLOCK]) -> [Row; 6] {
        let mut out = [Row::ZERO; 6];
        // SAFETY: six rows of eight numbers lie one after the other.
        unsafe { choose(x.as_ptr(), out.as_mut_ptr().cast(), &TO) };
        out
    }

    /// # Safety
    /// The processor must have AVX-512F.
    #[inline]
    #[target_feature(enable = "avx512f")]
    pub unsafe fn from_rows(rows: &[Row; 6]) -> [f64; BLOCK] {
        let mut out = [0.0; BLOCK];
        // SAFETY: as above.
        unsafe { choose(rows.as_ptr().cast(), out.as_mut_ptr(), &FROM) };
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_there_and_back() {
        let x: [f64; BLOCK] = std::array::from_fn(|i| i as f64);
        let rows = to_rows(&x);
        for k in 0..6 {
            for l in 0..LANES {
                assert_eq!(rows[k].0[l], (6 * l + k) as f64);
            }
        }
        assert_eq!(from_rows(&rows), x);
        assert_eq!(previous(&rows[2], -1.0).0, [-1.0, 2.0, 8.0, 14.0, 20.0, 26.0, 32.0, 38.0]);
    }
}
