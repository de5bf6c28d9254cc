//! `fmuResourceLocation`: a URI in theory, in practice anything between a URI and a path.

use std::path::PathBuf;

/// The folder that an importer means; `None` when it names none.
///
/// # Errors
/// Says what is wrong with the location.
pub fn resources(location: &[u8]) -> Result<Option<PathBuf>, String> {
    if location.is_empty() {
        return Ok(None);
    }
    let decoded = PathBuf::from(path(location, cfg!(windows), decode)?);
    // Importers that do not encode would have us decode a folder that is really called "a%20b".
    let raw = PathBuf::from(path(location, cfg!(windows), <[u8]>::to_vec)?);
    Ok(Some(if !decoded.exists() && raw.exists() { raw } else { decoded }))
}

/// The path in a `file` URI, or a bare absolute path as it is.
fn path(location: &[u8], windows: bool, decode: fn(&[u8]) -> Vec<u8>) -> Result<String, String> {
    let shown = String::from_utf8_lossy(location);
    let bytes = match location.split_at_checked(5) {
        Some((scheme, rest)) if scheme.eq_ignore_ascii_case(b"file:") => decode(strip_host(rest, windows)),
        _ if location.starts_with(b"/") || has_drive(location) || location.starts_with(b"\\\\") => location.to_vec(),
        _ => return Err(format!("resource location '{shown}' is no file URI; expected file:///folder/resources")),
    };
    if bytes.contains(&0) {
        return Err(format!("resource location '{shown}' contains a NUL character"));
    }
    let text = String::from_utf8(bytes).map_err(|_| format!("resource location '{shown}' is not UTF-8 after decoding"))?;
    if !text.starts_with(['/', '\\']) && !has_drive(text.as_bytes()) {
        return Err(format!("resource location '{shown}' is not an absolute path on this machine"));
    }
    Ok(tidy(&text, windows))
}

/// What follows the host; an empty host and `localhost` are this machine. Any other host is left in front of the path, which
/// is then a network path on Windows and no absolute path elsewhere.
fn strip_host(rest: &[u8], windows: bool) -> &[u8] {
    let Some(authority) = rest.strip_prefix(b"//") else { return rest };
    let end = authority.iter().position(|&b| b == b'/').unwrap_or(authority.len());
    let (host, path) = authority.split_at(end);
    match host {
        b"" => path,
        host if host.eq_ignore_ascii_case(b"localhost") || host == b"127.0.0.1" => path,
        _ if windows && !has_drive(authority) => rest,
        _ => authority,
    }
}

/// One leading slash, none before a drive letter, none at the end. Two are kept on Windows, where they begin a network path.
fn tidy(text: &str, windows: bool) -> String {
    let body = text.trim_start_matches('/');
    let slashes = text.len() - body.len();
    let head = match slashes {
        0 => "",
        _ if has_drive(body.as_bytes()) => "",
        2 if windows => "//",
        _ => "/",
    };
    let trimmed = body.trim_end_matches('/');
    // "C:" alone would be the current folder of that drive.
    let tail = if trimmed.ends_with(':') && has_drive(trimmed.as_bytes()) { "/" } else { "" };
    format!("{head}{trimmed}{tail}")
}

fn has_drive(path: &[u8]) -> bool {
    matches!(path, [letter, b':', rest @ ..] if letter.is_ascii_alphabetic() && matches!(rest, [] | [b'/' | b'\\', ..]))
}

/// Percent-decoding; a percent sign without two hexadecimal digits stands for itself.
fn decode(bytes: &[u8]) -> Vec<u8> {
    let hex = |b: u8| char::from(b).to_digit(16).map(|digit| digit as u8);
    let mut decoded = Vec::with_capacity(bytes.len());
    let mut rest = bytes;
    while let [first, tail @ ..] = rest {
        rest = tail;
        match (first, tail) {
            (b'%', [high, low, after @ ..]) if hex(*high).is_some() && hex(*low).is_some() => {
                decoded.push(hex(*high).unwrap_or(0) << 4 | hex(*low).unwrap_or(0));
                rest = after;
            }
            _ => decoded.push(*first),
        }
    }
    decoded
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unix(location: &str) -> Result<String, String> {
        path(location.as_bytes(), false, decode)
    }

    fn windows(location: &str) -> Result<String, String> {
        path(location.as_bytes(), true, decode)
    }

    #[test]
    fn every_form_that_importers_send() {
        for location in [
            "file:///tmp/f/resources",
            "file:/tmp/f/resources",
            "file://localhost/tmp/f/resources",
            "file://LOCALHOST/tmp/f/resources",
            "file:////tmp/f/resources",
            "FILE:///tmp/f/resources",
            "file:///tmp/f/resources/",
            "file:///tmp/f/%72esources",
            "/tmp/f/resources",
        ] {
            assert_eq!(unix(location).as_deref(), Ok("/tmp/f/resources"), "{location}");
        }
    }

    #[test]
    fn encoded_and_raw_names() {
        for location in ["file:///tmp/a%20b/%C3%BC%c3%9f", "file:////tmp/a b/üß", "file:///tmp/a b/%C3%BCß/"] {
            assert_eq!(unix(location).as_deref(), Ok("/tmp/a b/üß"), "{location}");
        }
        assert_eq!(unix("file:///tmp/100%/5%z").as_deref(), Ok("/tmp/100%/5%z"));
        assert_eq!(unix("file:///tmp/a#b?c").as_deref(), Ok("/tmp/a#b?c"));
        assert_eq!(unix("file:///").as_deref(), Ok("/"));
    }

    #[test]
    fn windows_drives_and_shares() {
        for location in ["file:///C:/a%20b", "file:/C:/a b", "file:////C:/a b/", "file://C:/a b", "file://localhost/C:/a b", "C:/a b"] {
            assert_eq!(windows(location).as_deref(), Ok("C:/a b"), "{location}");
        }
        assert_eq!(windows("file:///C:/").as_deref(), Ok("C:/"));
        assert_eq!(windows("file://server/share/x").as_deref(), Ok("//server/share/x"));
        assert_eq!(windows("file:////server/share/x").as_deref(), Ok("//server/share/x"));
    }

    #[test]
    fn what_is_no_folder_is_named() {
        for location in ["http://x/y", "resources", "file:resources", "file://elsewhere/x", "file:", "file:///a%00b", "file:///%ff"] {
            let message = unix(location).unwrap_err();
            assert!(message.contains(location), "{location}: {message}");
        }
    }

    #[test]
    fn no_location_means_no_folder() {
        assert_eq!(resources(b""), Ok(None));
    }

    #[test]
    fn folders_whose_names_look_encoded() {
        let folder = std::env::temp_dir().join(format!("fairlead {} a%20b", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let found = resources(format!("file:///{}", folder.display()).as_bytes());
        std::fs::remove_dir(&folder).unwrap();
        assert_eq!(found, Ok(Some(folder)));
    }
}
