//! `fmi2FMUstate`: everything that the future of an instance depends on, in memory and as bytes.
//!
//! Serialized, little-endian: magic, format version, GUID (length and bytes), payload length, payload, and the FNV-1a 64
//! checksum of all that came before it.

use super::function::Phase;
use super::table::{Derivatives, Settings};
use model_description::Value;

const MAGIC: &[u8; 8] = b"FAIRLEAD";
const VERSION: u32 = 1;
/// magic, version, length of the GUID; payload length; checksum.
const FRAME: usize = 8 + 4 + 8 + 8 + 8;

/// A saved instance.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Snapshot {
    /// Of the FMU it is from.
    pub guid: String,
    /// Where the instance was in its life.
    pub phase: Phase,
    /// s.
    pub time: f64,
    /// s, where the importer gave one.
    pub stop: Option<f64>,
    /// What the importer had set.
    pub settings: Settings,
    /// The parameter changes that the simulation had: (leaf of the scene, value).
    pub applied: Vec<(usize, Value)>,
    /// The status code that the importer knew of.
    pub told: i32,
    /// The simulation's own bytes, once there was a start state.
    pub simulation: Option<Vec<u8>>,
}

impl Snapshot {
    /// As bytes that [`Self::from_bytes`] reads on any machine.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut payload = Writer::default();
        payload.0.push(self.phase as u8);
        payload.f64(self.time);
        payload.option(self.stop.as_ref(), |w, &stop| w.f64(stop));
        payload.list(&self.settings.values, Writer::value);
        payload.list(&self.settings.derivatives, |w, orders| {
            orders.iter().for_each(|order| w.option(order.as_ref(), |w, &derivative| w.f64(derivative)));
        });
        payload.list(&self.applied, |w, (leaf, value)| {
            w.length(*leaf);
            w.value(value);
        });
        payload.i32(self.told);
        payload.option(self.simulation.as_ref(), |w, bytes| w.bytes(bytes));

        let mut whole = Writer(Vec::with_capacity(FRAME + self.guid.len() + payload.0.len()));
        whole.0.extend_from_slice(MAGIC);
        whole.0.extend_from_slice(&VERSION.to_le_bytes());
        whole.bytes(self.guid.as_bytes());
        whole.bytes(&payload.0);
        let checksum = fnv1a(&whole.0);
        whole.0.extend_from_slice(&checksum.to_le_bytes());
        whole.0
    }

    /// Reads what [`Self::to_bytes`] wrote for the FMU with this GUID.
    ///
    /// # Errors
    /// Says how the bytes differ from such a state.
    pub fn from_bytes(bytes: &[u8], guid: &str) -> Result<Self, String> {
        let (content, checksum) = bytes.split_last_chunk::<8>().ok_or("the state is truncated")?;
        let mut frame = Reader(content);
        if frame.take(MAGIC.len()) != Some(MAGIC) {
            return Err("the bytes are no state of a fairlead FMU".into());
        }
        let version = frame.array().map(u32::from_le_bytes).ok_or("the state is truncated")?;
        if version != VERSION {
            return Err(format!("the state has format version {version}; expected {VERSION}"));
        }
        let origin = frame.bytes().ok_or("the state is truncated")?;
        let payload = frame.bytes().ok_or("the state is truncated")?;
        if !frame.0.is_empty() || fnv1a(content) != u64::from_le_bytes(*checksum) {
            return Err("the state is damaged: its length or checksum does not fit".into());
        }
        if origin != guid.as_bytes() {
            return Err(format!("the state is of the FMU {}; expected {guid}", String::from_utf8_lossy(origin)));
        }
        Reader(payload).snapshot(guid).ok_or_else(|| "the state is damaged: its content makes no sense".into())
    }
}

fn fnv1a(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

#[derive(Default)]
struct Writer(Vec<u8>);

impl Writer {
    fn f64(&mut self, x: f64) {
        self.0.extend_from_slice(&x.to_le_bytes());
    }

    fn i32(&mut self, n: i32) {
        self.0.extend_from_slice(&n.to_le_bytes());
    }

    fn length(&mut self, n: usize) {
        self.0.extend_from_slice(&(n as u64).to_le_bytes());
    }

    fn bytes(&mut self, bytes: &[u8]) {
        self.length(bytes.len());
        self.0.extend_from_slice(bytes);
    }

    fn value(&mut self, value: &Value) {
        match value {
            Value::Real(x) => {
                self.0.push(0);
                self.f64(*x);
            }
            Value::Integer(n) => {
                self.0.push(1);
                self.i32(*n);
            }
            Value::Boolean(b) => self.0.extend([2, u8::from(*b)]),
            Value::String(text) => {
                self.0.push(3);
                self.bytes(text.as_bytes());
            }
        }
    }

    fn option<T>(&mut self, item: Option<&T>, write: impl Fn(&mut Self, &T)) {
        self.0.push(u8::from(item.is_some()));
        if let Some(item) = item {
            write(self, item);
        }
    }

    fn list<T>(&mut self, items: &[T], write: impl Fn(&mut Self, &T)) {
        self.length(items.len());
        items.iter().for_each(|item| write(self, item));
    }
}

/// Every method gives `None` for bytes that no [`Writer`] wrote.
struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    fn snapshot(mut self, guid: &str) -> Option<Snapshot> {
        let snapshot = Snapshot {
            guid: guid.to_owned(),
            phase: Phase::from_number(self.byte()?)?,
            time: self.finite()?,
            stop: self.option(Self::f64)?,
            settings: Settings {
                values: self.list(Self::value)?,
                derivatives: self.list(|r| {
                    let mut orders = Derivatives::default();
                    for order in &mut orders {
                        *order = r.option(Self::finite)?;
                    }
                    Some(orders)
                })?,
            },
            applied: self.list(|r| Some((r.length()?, r.value()?)))?,
            told: self.i32()?,
            simulation: self.option(|r| Some(r.bytes()?.to_vec()))?,
        };
        self.0.is_empty().then_some(snapshot)
    }

    fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (head, tail) = self.0.split_at_checked(count)?;
        self.0 = tail;
        Some(head)
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        self.take(N)?.try_into().ok()
    }

    fn byte(&mut self) -> Option<u8> {
        self.array().map(|[byte]| byte)
    }

    fn bool(&mut self) -> Option<bool> {
        match self.byte()? {
            0 => Some(false),
            1 => Some(true),
            _ => None,
        }
    }

    fn f64(&mut self) -> Option<f64> {
        self.array().map(f64::from_le_bytes)
    }

    fn finite(&mut self) -> Option<f64> {
        self.f64().filter(|x| x.is_finite())
    }

    fn i32(&mut self) -> Option<i32> {
        self.array().map(i32::from_le_bytes)
    }

    fn length(&mut self) -> Option<usize> {
        usize::try_from(u64::from_le_bytes(self.array()?)).ok()
    }

    fn bytes(&mut self) -> Option<&'a [u8]> {
        let count = self.length()?;
        self.take(count)
    }

    fn text(&mut self) -> Option<String> {
        String::from_utf8(self.bytes()?.to_vec()).ok()
    }

    fn value(&mut self) -> Option<Value> {
        match self.byte()? {
            0 => self.f64().map(Value::Real),
            1 => self.i32().map(Value::Integer),
            2 => self.bool().map(Value::Boolean),
            3 => self.text().map(Value::String),
            _ => None,
        }
    }

    fn option<T>(&mut self, read: impl Fn(&mut Self) -> Option<T>) -> Option<Option<T>> {
        if self.bool()? { read(self).map(Some) } else { Some(None) }
    }

    /// Grows as it reads, so that a wrong length costs no memory.
    fn list<T>(&mut self, read: impl Fn(&mut Self) -> Option<T>) -> Option<Vec<T>> {
        let count = self.length()?;
        // No item is written in less than a byte.
        if count > self.0.len() {
            return None;
        }
        (0..count).map(|_| read(self)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Snapshot {
        Snapshot {
            guid: "{abc}".into(),
            phase: Phase::Stepping,
            time: -0.1,
            stop: Some(f64::INFINITY),
            settings: Settings {
                values: vec![Value::Real(1.5), Value::Integer(-3), Value::Boolean(true), Value::String("Tauwerk ü".into())],
                derivatives: vec![[Some(0.25), None], [None, None], [Some(1.0), Some(-2.0)]],
            },
            applied: vec![(17, Value::Real(2.0))],
            told: 1,
            simulation: Some((0..200).collect()),
        }
    }

    #[test]
    fn bytes_come_back_as_the_same_state() {
        let without = Snapshot { simulation: None, stop: None, phase: Phase::Instantiated, ..sample() };
        for snapshot in [sample(), without] {
            assert_eq!(Snapshot::from_bytes(&snapshot.to_bytes(), "{abc}"), Ok(snapshot));
        }
    }

    /// The frame that other machines rely on: magic, version, GUID, length, checksum, in these places.
    #[test]
    fn frozen_the_frame_is_as_documented() {
        let bytes = sample().to_bytes();
        let word = |at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap());
        assert_eq!(&bytes[..8], b"FAIRLEAD");
        assert_eq!(bytes[8..12], 1_u32.to_le_bytes());
        assert_eq!((word(12), &bytes[20..25]), (5, &b"{abc}"[..]));
        assert_eq!(word(25) as usize, bytes.len() - 25 - 8 - 8);
        assert_eq!(word(bytes.len() - 8), fnv1a(&bytes[..bytes.len() - 8]));
        // A later version of the format, itself undamaged.
        let mut later = bytes[..bytes.len() - 8].to_vec();
        later[8] = 2;
        let checksum = fnv1a(&later).to_le_bytes();
        later.extend(checksum);
        assert!(Snapshot::from_bytes(&later, "{abc}").unwrap_err().contains("version 2; expected 1"));
    }

    #[test]
    fn truncated_bytes_are_refused() {
        let bytes = sample().to_bytes();
        for length in 0..bytes.len() {
            assert!(Snapshot::from_bytes(&bytes[..length], "{abc}").is_err(), "{length} of {}", bytes.len());
        }
        let mut longer = bytes;
        longer.push(0);
        assert!(Snapshot::from_bytes(&longer, "{abc}").is_err());
    }

    #[test]
    fn every_flipped_bit_is_seen() {
        let bytes = sample().to_bytes();
        for bit in 0..8 * bytes.len() {
            let mut damaged = bytes.clone();
            damaged[bit / 8] ^= 1 << (bit % 8);
            assert!(Snapshot::from_bytes(&damaged, "{abc}").is_err(), "bit {bit}");
        }
    }

    #[test]
    fn foreign_bytes_are_named() {
        assert!(Snapshot::from_bytes(&sample().to_bytes(), "{abd}").unwrap_err().contains("{abc}"));
        assert!(Snapshot::from_bytes(&[7; 500], "{abc}").unwrap_err().contains("no state"));
    }

    /// Bytes that were written on purpose: the checksum fits, the content does not.
    #[test]
    fn forged_bytes_are_refused_without_a_crash() {
        let bytes = sample().to_bytes();
        let (content, _) = bytes.split_last_chunk::<8>().unwrap();
        for at in 0..content.len() {
            for value in [0, 1, 2, 3, 4, 0x7f, 0xff] {
                let mut forged = content.to_vec();
                forged[at] = value;
                let checksum = fnv1a(&forged).to_le_bytes();
                forged.extend_from_slice(&checksum);
                // Some forgeries are states; none may panic or ask for absurd memory.
                drop(Snapshot::from_bytes(&forged, "{abc}"));
            }
        }
    }
}
