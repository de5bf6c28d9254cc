//! Fingerprints: 128-bit FNV-1a.

/// An FNV-1a hash in the making.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fnv(u128);

impl Default for Fnv {
    fn default() -> Self {
        Self(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d)
    }
}

impl Fnv {
    /// Takes in bytes.
    pub fn bytes(mut self, bytes: &[u8]) -> Self {
        for &byte in bytes {
            self.0 = (self.0 ^ u128::from(byte)).wrapping_mul(0x0000_0000_0100_0000_0000_0000_0000_013b);
        }
        self
    }

    /// Takes in one of several parts, such that no two lists of parts look alike: its length goes first.
    pub fn part(self, bytes: &[u8]) -> Self {
        self.bytes(&(bytes.len() as u64).to_le_bytes()).bytes(bytes)
    }

    /// 32 hexadecimal digits.
    pub fn hex(self) -> String {
        format!("{:032x}", self.0)
    }
}

/// A GUID in braces that fingerprints the parts.
pub fn guid(parts: &[&[u8]]) -> String {
    let h = parts.iter().fold(Fnv::default(), |h, part| h.part(part)).hex();
    format!("{{{}-{}-{}-{}-{}}}", &h[0..8], &h[8..12], &h[12..16], &h[16..20], &h[20..32])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_published_hashes() {
        // The empty string gives the offset basis; "a" and "foobar" as in the FNV authors' test suite.
        assert_eq!(Fnv::default().hex(), "6c62272e07bb014262b821756295c58d");
        assert_eq!(Fnv::default().bytes(b"a").hex(), "d228cb696f1a8caf78912b704e4a8964");
        assert_eq!(Fnv::default().bytes(b"foobar").hex(), "343e1662793c64bf6f0d3597ba446f18");
    }

    #[test]
    fn exact_parts_are_kept_apart() {
        assert_ne!(guid(&[b"ab", b"c"]), guid(&[b"a", b"bc"]));
        let g = guid(&[b"ab"]);
        assert_eq!((g.len(), g.starts_with('{'), g.matches('-').count()), (38, true, 4));
    }
}
