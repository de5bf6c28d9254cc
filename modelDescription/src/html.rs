//! documentation/index.html.
