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

/// The same of as many nodes as there are, at most eight; the lanes beyond hold the last of them again.
#[inline(always)]
pub fn some_to_rows(x: &[f64], nodes: usize) -> [Row; 6] {
    assert!((1..=LANES).contains(&nodes) && x.len() >= 6 * nodes, "{nodes} nodes of {} numbers", x.len());
    #[cfg(target_arch = "x86_64")]
    if super::dispatch::has_avx512() {
        // SAFETY: the processor has the registers, and so many numbers are there.
        #[allow(unsafe_code)]
        return unsafe { avx512::some_to_rows(x, nodes) };
    }
    let mut out = [Row::ZERO; 6];
    for k in 0..6 {
        for l in 0..LANES {
            out[k].0[l] = x[6 * l.min(nodes - 1) + k];
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
    use std::arch::x86_64::{
        __m512d, __m512i, _mm512_loadu_pd, _mm512_mask_blend_pd, _mm512_maskz_loadu_pd, _mm512_permutex2var_pd, _mm512_permutexvar_pd,
        _mm512_setzero_pd, _mm512_storeu_pd,
    };

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
    unsafe fn load(from: *const f64) -> [__m512d; 6] {
        let mut x = [_mm512_setzero_pd(); 6];
        for j in 0..6 {
            // SAFETY: the caller has six times eight numbers there.
            x[j] = unsafe { _mm512_loadu_pd(from.add(LANES * j)) };
        }
        x
    }

    /// # Safety
    /// The processor must have AVX-512F, and six times eight numbers must have room at `to`.
    #[inline]
    #[target_feature(enable = "avx512f")]
    unsafe fn store(x: &[__m512d; 6], to: *mut f64) {
        for j in 0..6 {
            // SAFETY: the caller has the room.
            unsafe { _mm512_storeu_pd(to.add(LANES * j), x[j]) };
        }
    }

    /// # Safety
    /// The processor must have AVX-512F.
    #[inline]
    #[target_feature(enable = "avx512f")]
    unsafe fn choose(x: &[__m512d; 6], choices: &[Choice; 6]) -> [__m512d; 6] {
        let mut out = *x;
        for j in 0..6 {
            let c = &choices[j];
            let place = integers(c.place);
            let a = _mm512_permutex2var_pd(x[0], place, x[1]);
            let b = _mm512_permutex2var_pd(x[2], place, x[3]);
            let d = _mm512_permutex2var_pd(x[4], place, x[5]);
            out[j] = _mm512_mask_blend_pd(c.third, _mm512_mask_blend_pd(c.second, a, b), d);
        }
        out
    }

    #[inline(always)]
    fn integers(x: [i64; LANES]) -> __m512i {
        // SAFETY: both are 64 bytes of integers.
        unsafe { std::mem::transmute(x) }
    }

    /// # Safety
    /// The processor must have AVX-512F.
    #[inline]
    #[target_feature(enable = "avx512f")]
    pub unsafe fn to_rows(x: &[f64; BLOCK]) -> [Row; 6] {
        let mut out = [Row::ZERO; 6];
        // SAFETY: six rows of eight numbers lie one after the other.
        unsafe { store(&choose(&load(x.as_ptr()), &TO), out.as_mut_ptr().cast()) };
        out
    }

    /// # Safety
    /// The processor must have AVX-512F, and `x` so many nodes, one to eight.
    #[inline]
    #[target_feature(enable = "avx512f")]
    pub unsafe fn some_to_rows(x: &[f64], nodes: usize) -> [Row; 6] {
        let mut known = [_mm512_setzero_pd(); 6];
        for j in 0..6 {
            let left = (6 * nodes).saturating_sub(LANES * j).min(LANES);
            // SAFETY: what is masked is not read, and where nothing is left not even the address is used.
            known[j] = unsafe { _mm512_maskz_loadu_pd(((1_u16 << left) - 1) as u8, x.as_ptr().wrapping_add(LANES * j)) };
        }
        let last = nodes as i64 - 1;
        let clamped = integers([0, 1, 2, 3, 4, 5, 6, 7].map(|l: i64| l.min(last)));
        let mut out = [Row::ZERO; 6];
        // SAFETY: six rows of eight numbers lie one after the other.
        unsafe {
            let mut rows = choose(&known, &TO);
            for k in 0..6 {
                rows[k] = _mm512_permutexvar_pd(clamped, rows[k]);
            }
            store(&rows, out.as_mut_ptr().cast());
        }
        out
    }

    /// # Safety
    /// The processor must have AVX-512F.
    #[inline]
    #[target_feature(enable = "avx512f")]
    pub unsafe fn from_rows(rows: &[Row; 6]) -> [f64; BLOCK] {
        let mut out = [0.0; BLOCK];
        // SAFETY: as above.
        unsafe { store(&choose(&load(rows.as_ptr().cast()), &FROM), out.as_mut_ptr()) };
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
        for nodes in 1..=LANES {
            let some = some_to_rows(&x[..6 * nodes], nodes);
            for k in 0..6 {
                for l in 0..LANES {
                    assert_eq!(some[k].0[l], (6 * l.min(nodes - 1) + k) as f64, "{nodes} nodes, row {k}, lane {l}");
                }
            }
        }
        assert_eq!(previous(&rows[2], -1.0).0, [-1.0, 2.0, 8.0, 14.0, 20.0, 26.0, 32.0, 38.0]);
    }
}
