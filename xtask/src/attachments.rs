//! What lies in an FMU beside the model itself: its picture, its ports for drawing and connecting, and all licences.

use crate::error::{Failure, Result};
use crate::licenses;
use model_description::{Document, terminals};

/// Drawn for fairlead; FMI wants a PNG.
const ICON: &[u8] = include_bytes!("../../modelDescription/pages/model.png");

/// Paths in the archive and bytes.
///
/// # Errors
/// A licence that cannot be found.
pub fn attachments(document: &Document) -> Result<Vec<(String, Vec<u8>)>> {
    let terminals = terminals::terminals_and_icons(document).map_err(|e| Failure(format!("terminalsAndIcons.xml: {e}")))?;
    let mut files = vec![
        ("model.png".to_owned(), ICON.to_vec()),
        ("terminalsAndIcons/terminalsAndIcons.xml".to_owned(), terminals),
        ("terminalsAndIcons/icon.png".to_owned(), ICON.to_vec()),
    ];
    let licenses = licenses::all()?.into_iter();
    files.extend(licenses.map(|(name, text)| (format!("documentation/licenses/{name}"), text.into_bytes())));
    Ok(files)
}
