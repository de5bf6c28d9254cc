//! Files beside an FMU for tools that read more than the FMU: OSP's libcosim, and whatever reads SSP.

use crate::error::{Failure, Result, at};
use crate::package::{Contents, write_archive};
use fairlead::variables::Model;
use model_description::{osp, ssp};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Writes `NAME_OspModelDescription.xml`, which libcosim looks for beside the FMU, and an example `NAME_OspSystemStructure.xml`.
///
/// # Errors
/// A file that cannot be written.
pub fn write_osp(model: &Model, fmu: &Path) -> Result<Vec<PathBuf>> {
    let document = model.document();
    // libcosim goes by the model's name, not by that of the file.
    let description = fmu.with_file_name(format!("{}_OspModelDescription.xml", document.name));
    let system = fmu.with_file_name(format!("{}_OspSystemStructure.xml", document.name));
    write(&description, osp::model_description(&document))?;
    write(&system, osp::system_structure(&document, &file_name(fmu)?))?;
    Ok(vec![description, system])
}

/// Writes `NAME.ssv`, a parameter set with every number of the scene, and `NAME.ssp`, an example system with FMU and parameter set in it.
///
/// # Errors
/// A file that cannot be read or written.
pub fn write_ssp(model: &Model, fmu: &Path) -> Result<Vec<PathBuf>> {
    let document = model.document();
    let (values, system) = (fmu.with_extension("ssv"), fmu.with_extension("ssp"));
    write(&values, ssp::parameter_values(&document))?;
    let parameters = format!("resources/{}.ssv", document.name);
    let unit = format!("resources/{}.fmu", document.name);
    let description = ssp::system_structure(&document, &unit, &parameters).map_err(|e| at(&system, e))?;
    let contents: Contents = vec![
        ("SystemStructure.ssd".into(), description),
        (parameters, fs::read(&values).map_err(|e| at(&values, e))?),
        (unit, fs::read(fmu).map_err(|e| at(fmu, e))?),
    ];
    write_archive(&system, &contents)?;
    Ok(vec![values, system])
}

fn file_name(path: &Path) -> Result<String> {
    let name = path.file_name().and_then(|name| name.to_str());
    name.map(str::to_owned).ok_or_else(|| Failure(format!("{}: expected a file name in UTF-8, to be written into XML", path.display())))
}

fn write(path: &Path, text: io::Result<Vec<u8>>) -> Result<()> {
    text.and_then(|text| fs::write(path, text)).map_err(|e| at(path, e))
}
