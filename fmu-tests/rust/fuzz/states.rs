//! Saved states whose bytes were changed on purpose, with a checksum that fits.

use super::harness::random::{Random, rounds};
use super::harness::{Fmu, Request};
use super::{sane, small_scene};
use fairlead::fmi::abi::Status;

/// FNV-1a 64, as the format has it.
fn checksum(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// A few changes in the content, with the checksum made good again.
fn forge(good: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = good[..good.len() - 8].to_vec();
    for _ in 0..1 + random.below(4) {
        let at = random.below(bytes.len() - 8);
        match random.below(4) {
            0 => bytes[at] = random.next() as u8,
            1 => bytes[at] ^= 1 << random.below(8),
            2 => {
                let nasty = random.nasty();
                bytes[at..at + 8].copy_from_slice(&nasty.to_le_bytes());
            }
            _ => {
                let lengths = [0, 1, 255, u64::from(u32::MAX), u64::MAX, 1 << 40];
                let length = *random.pick(&lengths);
                bytes[at..at + 8].copy_from_slice(&length.to_le_bytes());
            }
        }
    }
    let sum = checksum(&bytes).to_le_bytes();
    bytes.extend(sum);
    bytes
}

/// Forged states are refused, or taken and then simulated from; the instance survives, and its own saved state brings it back to the
/// bit.
#[test]
fn exact_forged_states_do_no_lasting_harm() {
    let fmu = Fmu::in_folder(&small_scene(), &Request::good());
    fmu.start(0.0);
    fmu.sail(0, 3, 0.01);
    let state = fmu.save();
    let good = fmu.serialize(state);
    let expected = fmu.sail(3, 5, 0.01);
    let (mut refused, mut taken) = (0, 0);
    for seed in 0..rounds(600) {
        let mut random = Random::new(seed);
        let bytes = forge(&good, &mut random);
        let what = || format!("forgery number {seed}");
        if let Ok(forged) = fmu.deserialize(&bytes) {
            match fmu.restore(forged) {
                Status::Ok => {
                    taken += 1;
                    // Whatever time the forged state stands at.
                    let mut time = 0.0;
                    let status =
                        unsafe { fairlead::fmi::exports::fmi2GetRealStatus(fmu.c, fairlead::fmi::abi::LAST_SUCCESSFUL_TIME, &mut time) };
                    if status == Status::Ok {
                        fmu.step(time, 1e-4);
                    }
                }
                Status::Error => refused += 1,
                other => panic!("{other:?} after {}", what()),
            }
            fmu.free(forged);
        } else {
            refused += 1;
        }
        sane(&fmu, &what);
    }
    assert!(refused > 0 && taken > 0, "{refused} refused, {taken} taken");
    assert_eq!(fmu.restore(state), Status::Ok);
    assert_eq!(fmu.sail(3, 5, 0.01), expected);
    fmu.free(state);
}
