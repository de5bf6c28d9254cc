//! Arithmetic on one number or on several side by side.
//!
//! Kernels are written once over [`Real`] and instantiated for `f64` (single points) and for [`Lanes`] (batches of elements, which the
//! compiler turns into SIMD). No fused multiply-add is asked for: without the CPU feature it would call a library routine.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// What a kernel needs of a number.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + Mul<f64, Output = Self>
{
    /// The same value in every lane.
    fn splat(x: f64) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// Lane-wise maximum with a constant.
    fn at_least(self, x: f64) -> Self;
    /// 1 where positive, else 0.
    fn step(self) -> Self;
    /// −1 where negative, else 1.
    fn sign(self) -> Self;
    /// A scalar function in every lane.
    fn map(self, f: impl Fn(f64) -> f64) -> Self;
    /// A scalar function with two results in every lane.
    fn map2(self, f: impl Fn(f64) -> (f64, f64)) -> (Self, Self);
    /// A scalar function of two numbers with two results in every lane.
    fn zip2(self, o: Self, f: impl Fn(f64, f64) -> (f64, f64)) -> (Self, Self);
    /// Sum over the lanes.
    fn sum(self) -> f64;
}

impl Real for f64 {
    #[inline(always)]
    fn splat(x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn at_least(self, x: f64) -> Self {
        self.max(x)
    }
    #[inline(always)]
    fn step(self) -> Self {
        if self > 0.0 { 1.0 } else { 0.0 }
    }
    #[inline(always)]
    fn sign(self) -> Self {
        if self < 0.0 { -1.0 } else { 1.0 }
    }
    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        f(self)
    }
    #[inline(always)]
    fn map2(self, f: impl Fn(f64) -> (f64, f64)) -> (Self, Self) {
        f(self)
    }
    #[inline(always)]
    fn zip2(self, o: Self, f: impl Fn(f64, f64) -> (f64, f64)) -> (Self, Self) {
        f(self, o)
    }
    #[inline(always)]
    fn sum(self) -> f64 {
        self
    }
}

/// `W` numbers side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(32))]
pub struct Lanes<const W: usize>(pub [f64; W]);

macro_rules! lanewise {
    ($trait:ident, $method:ident, $op:tt) => {
        impl<const W: usize> $trait for Lanes<W> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, o: Self) -> Self {
                let mut r = self;
                for l in 0..W {
                    r.0[l] = self.0[l] $op o.0[l];
                }
                r
            }
        }
    };
}
lanewise!(Add, add, +);
lanewise!(Sub, sub, -);
lanewise!(Mul, mul, *);
lanewise!(Div, div, /);

impl<const W: usize> Neg for Lanes<W> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.lane(|x| -x)
    }
}
impl<const W: usize> Mul<f64> for Lanes<W> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: f64) -> Self {
        self.lane(|x| x * s)
    }
}
impl<const W: usize> AddAssign for Lanes<W> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}
impl<const W: usize> SubAssign for Lanes<W> {
    #[inline(always)]
    fn sub_assign(&mut self, o: Self) {
        *self = *self - o;
    }
}

impl<const W: usize> Lanes<W> {
    #[inline(always)]
    fn lane(self, f: impl Fn(f64) -> f64) -> Self {
        let mut r = self;
        for l in 0..W {
            r.0[l] = f(self.0[l]);
        }
        r
    }
}

impl<const W: usize> Real for Lanes<W> {
    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self([x; W])
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.lane(f64::sqrt)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.lane(f64::abs)
    }
    #[inline(always)]
    fn at_least(self, x: f64) -> Self {
        self.lane(|v| v.max(x))
    }
    #[inline(always)]
    fn step(self) -> Self {
        self.lane(|v| if v > 0.0 { 1.0 } else { 0.0 })
    }
    #[inline(always)]
    fn sign(self) -> Self {
        self.lane(|v| if v < 0.0 { -1.0 } else { 1.0 })
    }
    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        self.lane(f)
    }
    #[inline(always)]
    fn map2(self, f: impl Fn(f64) -> (f64, f64)) -> (Self, Self) {
        let (mut a, mut b) = (self, self);
        for l in 0..W {
            (a.0[l], b.0[l]) = f(self.0[l]);
        }
        (a, b)
    }
    #[inline(always)]
    fn zip2(self, o: Self, f: impl Fn(f64, f64) -> (f64, f64)) -> (Self, Self) {
        let (mut a, mut b) = (self, self);
        for l in 0..W {
            (a.0[l], b.0[l]) = f(self.0[l], o.0[l]);
        }
        (a, b)
    }
    #[inline(always)]
    fn sum(self) -> f64 {
        self.0.iter().sum()
    }
}

/// A 3-vector of [`Real`]s.
pub type Vec3<T> = [T; 3];
/// A 3×3 matrix, row major.
pub type Mat3<T> = [[T; 3]; 3];

/// a·b.
#[inline(always)]
pub fn dot<T: Real>(a: &Vec3<T>, b: &Vec3<T>) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// s a.
#[inline(always)]
pub fn scale<T: Real>(s: T, a: &Vec3<T>) -> Vec3<T> {
    [s * a[0], s * a[1], s * a[2]]
}

/// a + s b.
#[inline(always)]
pub fn axpy<T: Real>(a: &Vec3<T>, s: T, b: &Vec3<T>) -> Vec3<T> {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

/// m += s a bᵀ.
#[inline(always)]
pub fn add_outer<T: Real>(m: &mut Mat3<T>, s: T, a: &Vec3<T>, b: &Vec3<T>) {
    for i in 0..3 {
        let sa = s * a[i];
        for j in 0..3 {
            m[i][j] += sa * b[j];
        }
    }
}

/// m += s I.
#[inline(always)]
pub fn add_identity<T: Real>(m: &mut Mat3<T>, s: T) {
    for i in 0..3 {
        m[i][i] += s;
    }
}

/// m a.
#[inline(always)]
pub fn mat_vec<T: Real>(m: &Mat3<T>, a: &Vec3<T>) -> Vec3<T> {
    [dot(&m[0], a), dot(&m[1], a), dot(&m[2], a)]
}

/// The zero matrix.
#[inline(always)]
pub fn zero_mat<T: Real>() -> Mat3<T> {
    [[T::splat(0.0); 3]; 3]
}
