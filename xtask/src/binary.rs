//! What a library asks of the system that loads it, and whether it exports what FMI wants: read from its tables, without running it.

use object::read::ImportFlags;
use object::{Object, elf};
use std::collections::BTreeSet;
use std::fmt;

/// The functions of FMI 2.0 that a co-simulation FMU exports.
const EXPORTS: &str = "fmi2GetTypesPlatform fmi2GetVersion fmi2SetDebugLogging fmi2Instantiate fmi2FreeInstance fmi2SetupExperiment \
    fmi2EnterInitializationMode fmi2ExitInitializationMode fmi2Terminate fmi2Reset fmi2GetReal fmi2GetInteger fmi2GetBoolean fmi2GetString \
    fmi2SetReal fmi2SetInteger fmi2SetBoolean fmi2SetString fmi2GetFMUstate fmi2SetFMUstate fmi2FreeFMUstate fmi2SerializedFMUstateSize \
    fmi2SerializeFMUstate fmi2DeSerializeFMUstate fmi2GetDirectionalDerivative fmi2SetRealInputDerivatives fmi2GetRealOutputDerivatives \
    fmi2DoStep fmi2CancelStep fmi2GetStatus fmi2GetRealStatus fmi2GetIntegerStatus fmi2GetBooleanStatus fmi2GetStringStatus";

/// Libraries that every system of the kind has, in lower case; a trailing `*` stands for any ending.
const SYSTEM_LIBRARIES: [&str; 20] = [
    // GLIBC, which was several libraries before 2.34; libgcc unwinds panics in a build without zig.
    "libc.so.6",
    "libm.so.6",
    "libpthread.so.0",
    "libdl.so.2",
    "librt.so.1",
    "ld-linux-x86-64.so.2",
    "ld-linux-aarch64.so.1",
    "libgcc_s.so.1",
    "kernel32.dll",
    "kernelbase.dll",
    "ntdll.dll",
    "advapi32.dll",
    "bcryptprimitives.dll",
    "bcrypt.dll",
    "userenv.dll",
    "ws2_32.dll",
    "msvcrt.dll",
    "ucrtbase.dll",
    "api-ms-win-*",
    "/usr/lib/lib*",
];

/// A version of GLIBC: 2.17 is (2, 17).
pub type Version = (u32, u32);

/// What a library asks of a system.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// The newest version of GLIBC that one of its imports carries.
    pub glibc: Option<Version>,
    /// The libraries that it loads.
    pub libraries: BTreeSet<String>,
}

impl fmt::Display for Needs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some((major, minor)) = self.glibc {
            write!(f, "GLIBC {major}.{minor}, ")?;
        }
        let names: Vec<_> = self.libraries.iter().map(String::as_str).collect();
        f.write_str(&names.join(", "))
    }
}

/// What the library needs, and what is wrong with it as a library of an FMU.
///
/// # Errors
/// It is no library that can be read.
pub fn inspect(library: &[u8]) -> Result<(Needs, Vec<String>), String> {
    let file = object::File::parse(library).map_err(|e| format!("no library: {e}"))?;
    let read = |e: object::Error| format!("a damaged library: {e}");
    let mut problems = exports(&file).map_err(read)?;
    let mut needs = Needs::default();
    for entry in file.import_libraries().map_err(read)? {
        needs.libraries.insert(String::from_utf8_lossy(entry.map_err(read)?.name()).into_owned());
    }
    let strange = needs.libraries.iter().filter(|name| !is_of_the_system(name));
    problems.extend(strange.map(|name| format!("it needs {name}, which is not part of every system")));
    for import in file.imports().map_err(read)? {
        let import = import.map_err(read)?;
        let name = import.name().into_name().map_or_else(String::new, |n| String::from_utf8_lossy(n).into_owned());
        let ImportFlags::Elf { version, .. } = import.flags() else { continue };
        match version.map(String::from_utf8_lossy) {
            Some(version) => needs.glibc = needs.glibc.max(glibc(&version)),
            // A weak one may stay unfound; any other has to come from a library that says its version, as all of GLIBC's do.
            None if !import.is_weak() => problems.push(format!("it imports {name}, and nobody says from where")),
            None => {}
        }
    }
    if let object::File::Elf64(elf) = &file
        && !stays_mapped(elf).map_err(read)?
    {
        problems.push("it is not linked with -z nodelete, and may be unloaded under its instances".into());
    }
    Ok((needs, problems))
}

/// Every function of FMI, and nothing else.
fn exports(file: &object::File) -> object::read::Result<Vec<String>> {
    let mut found = BTreeSet::new();
    for export in file.exports()? {
        let name =
            export?.into_name().into_name().map_or_else(|| "an export without a name".into(), |n| String::from_utf8_lossy(&n).into_owned());
        // macOS puts an underscore before every C name.
        found.insert(name.strip_prefix('_').map_or(name.clone(), str::to_owned));
    }
    let wanted: BTreeSet<String> = EXPORTS.split_whitespace().map(str::to_owned).collect();
    let missing = wanted.difference(&found).map(|name| format!("{name} is not exported"));
    let more = found.difference(&wanted).map(|name| format!("{name} is exported; expected the functions of FMI 2.0 and nothing else"));
    Ok(missing.chain(more).collect())
}

fn is_of_the_system(library: &str) -> bool {
    let library = library.to_ascii_lowercase();
    SYSTEM_LIBRARIES.iter().any(|known| known.strip_suffix('*').map_or(library == *known, |head| library.starts_with(head)))
}

/// The number in GLIBC_2.17 or GLIBC_2.2.5.
fn glibc(version: &str) -> Option<Version> {
    let mut numbers = version.strip_prefix("GLIBC_")?.split('.').map(|n| n.parse().ok());
    Some((numbers.next()??, numbers.next()??))
}

fn stays_mapped(file: &object::read::elf::ElfFile64) -> object::read::Result<bool> {
    let table = file.elf_section_table().dynamic_table(file.endian(), file.data())?;
    let nodelete = |d: object::read::elf::Dynamic| d.tag == elf::DT_FLAGS_1 && d.val & elf::DF_1_NODELETE.0 != 0;
    Ok(table.iter().any(nodelete))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_versions_of_glibc_compare_as_numbers() {
        assert_eq!(glibc("GLIBC_2.2.5"), Some((2, 2)));
        assert!(glibc("GLIBC_2.17") > glibc("GLIBC_2.9"));
        assert_eq!((glibc("GCC_3.0"), glibc("GLIBC_PRIVATE")), (None, None));
    }

    #[test]
    fn exact_only_the_systems_own_libraries_are_allowed() {
        for good in ["libc.so.6", "KERNEL32.dll", "api-ms-win-crt-math-l1-1-0.dll", "/usr/lib/libSystem.B.dylib"] {
            assert!(is_of_the_system(good), "{good}");
        }
        for bad in ["libstdc++.so.6", "libgcc_s_seh-1.dll", "libwinpthread-1.dll", "libc.so.6.1"] {
            assert!(!is_of_the_system(bad), "{bad}");
        }
    }

    /// This test program is a library as far as the file format goes, but not an FMU's.
    #[test]
    #[cfg(target_os = "linux")]
    fn exact_another_library_is_no_fmus() {
        let program = std::fs::read(std::env::current_exe().expect("it runs")).expect("it can be read");
        let (needs, problems) = inspect(&program).expect("an ELF file");
        assert!(needs.glibc >= Some((2, 2)) && needs.libraries.contains("libc.so.6"), "{needs:?}");
        assert!(problems.iter().any(|p| p == "fmi2DoStep is not exported"), "{problems:?}");
        assert!(problems.iter().any(|p| p.contains("nodelete")), "{problems:?}");
        assert!(inspect(&program[..200]).is_err() && inspect(b"MZ").is_err());
    }
}
