//! Block-tridiagonal matrices of 6×6 blocks; knows no cable.

mod block_tridiagonal;
mod bordered;
mod complex;
mod patches;

pub use block_tridiagonal::{BLOCK, Block, BlockTridiagonal, SingularBlock};
pub use bordered::Bordered;
pub use complex::ComplexBordered;
pub use patches::Patches;
