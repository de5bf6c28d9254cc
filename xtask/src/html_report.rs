//! A self-contained HTML page: text, tables and inline SVG figures, no scripts and nothing to load.

use std::fmt::Write as _;

const STYLE: &str = "\
:root{color-scheme:light}
body{margin:0;background:#f4f6f8;color:#222b36;font:16px/1.55 system-ui,-apple-system,'Segoe UI',Roboto,'Helvetica Neue',Arial,sans-serif}
main{max-width:940px;margin:0 auto;padding:2.5rem 1.5rem 4rem}
main.roomy{max-width:1120px}
h1{font-size:1.6rem;line-height:1.2;margin:0 0 .6rem}
h2{font-size:1.25rem;margin:2.4rem 0 .7rem;padding-bottom:.3rem;border-bottom:1px solid #d5dbe1}
p{margin:.6rem 0;max-width:46rem}
.tiles{display:flex;flex-wrap:wrap;gap:.9rem;margin:1.4rem 0}
.tile{flex:1 1 7.5rem;background:#fff;border:1px solid #dde2e7;border-radius:8px;padding:.8rem 1rem}
.tile b{display:block;font-size:1.45rem;line-height:1.25;font-variant-numeric:tabular-nums}
.tile span{color:#5b6773;font-size:.86rem}
table{border-collapse:collapse;background:#fff;border:1px solid #dde2e7;font-size:.93rem;margin:.8rem 0;min-width:55%}
th,td{padding:.38rem .9rem;text-align:left;border-bottom:1px solid #e8ecef;vertical-align:top}
th{background:#eef1f4;font-weight:600}
tr:last-child td{border-bottom:0}
td.number,th.number{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}
figure{margin:1.2rem 0;background:#fff;border:1px solid #dde2e7;border-radius:8px;padding:.7rem .7rem .9rem}
figure svg{display:block;width:100%;height:auto}
figure img{display:block;max-width:100%;height:auto;margin:auto}
.wide{overflow-x:auto}
.wide table{font-size:.84rem;min-width:100%}
.wide th,.wide td{padding:.3rem .6rem}
.wide th.number{white-space:normal}
.figures td:first-child{min-width:22rem}
.gallery{display:grid;grid-template-columns:repeat(auto-fill,minmax(30rem,1fr));gap:.8rem;margin:1rem 0}
.gallery figure{margin:0}
.roomy p{max-width:58rem}
.roomy figcaption{max-width:58rem;text-align:center;margin:auto}
td small{display:block;color:#5b6773;font-size:.92em;line-height:1.4}
td.holds{color:#00704a;font-weight:600}
td.missed{color:#b00020;font-weight:700}
figure svg text{font-family:system-ui,-apple-system,'Segoe UI',Roboto,'Helvetica Neue',Arial,sans-serif}
figcaption{color:#4b5763;font-size:.9rem;padding:.5rem .6rem 0;max-width:48rem}
@media print{body{background:#fff}figure,table,.tiles{break-inside:avoid}}
";

/// A page under construction.
#[derive(Debug, Clone)]
pub struct Page {
    title: String,
    body: String,
    wide: bool,
}

impl Page {
    /// An empty page with this title, which is also its first heading.
    pub fn new(title: &str) -> Page {
        Page { title: escaped(title), body: String::new(), wide: false }
    }

    /// The page with room for wide tables.
    pub fn wide(mut self) -> Page {
        self.wide = true;
        self
    }

    /// A section's heading.
    pub fn heading(&mut self, text: &str) -> &mut Page {
        self.push(&format!("<h2>{}</h2>", escaped(text)))
    }

    /// A paragraph of plain text.
    pub fn paragraph(&mut self, text: &str) -> &mut Page {
        self.push(&format!("<p>{}</p>", escaped(text)))
    }

    /// A row of key figures: (value, what it is).
    pub fn tiles(&mut self, tiles: &[(String, &str)]) -> &mut Page {
        let mut html = String::from("<div class=\"tiles\">");
        for (value, meaning) in tiles {
            let _ = write!(html, "<div class=\"tile\"><b>{}</b><span>{}</span></div>", escaped(value), escaped(meaning));
        }
        self.push(&(html + "</div>"))
    }

    /// A table. Cells that begin like a number are set flush right; what follows a line break in a cell is set smaller below.
    pub fn table(&mut self, header: &[&str], rows: &[Vec<String>]) -> &mut Page {
        let numeric = |column: usize| {
            let mut cells = rows.iter().filter_map(|row| row.get(column)).filter(|cell| !cell.is_empty()).peekable();
            cells.peek().is_some()
                && cells.all(|cell| cell.trim_start_matches(['-', '\u{2212}', '+']).starts_with(|c: char| c.is_ascii_digit()))
        };
        let class = |column: usize| if numeric(column) { " class=\"number\"" } else { "" };
        let mut html = String::from("<table>");
        if !header.is_empty() {
            html.push_str("<thead><tr>");
            for (column, cell) in header.iter().enumerate() {
                let _ = write!(html, "<th{}>{}</th>", class(column), escaped(cell));
            }
            html.push_str("</tr></thead>");
        }
        html.push_str("<tbody>");
        for row in rows {
            html.push_str("<tr>");
            for (column, cell) in row.iter().enumerate() {
                let class = match cell.as_str() {
                    "holds" => " class=\"holds\"",
                    "MISSED" => " class=\"missed\"",
                    _ => class(column),
                };
                let text = match cell.split_once('\n') {
                    Some((first, below)) => format!("{}<small>{}</small>", escaped(first), escaped(below)),
                    None => escaped(cell),
                };
                let _ = write!(html, "<td{class}>{text}</td>");
            }
            html.push_str("</tr>");
        }
        self.push(&(html + "</tbody></table>"))
    }

    /// A heading that links can point to.
    pub fn anchored_heading(&mut self, id: &str, text: &str) -> &mut Page {
        self.push(&format!("<h2 id=\"{}\">{}</h2>", escaped(id), escaped(text)))
    }

    /// Links to headings of this page: (id, text).
    pub fn list(&mut self, links: &[(String, String)]) -> &mut Page {
        let items: Vec<String> =
            links.iter().map(|(id, text)| format!("<li><a href=\"#{}\">{}</a></li>", escaped(id), escaped(text))).collect();
        self.push(&format!("<ul>{}</ul>", items.join("")))
    }

    /// A table of many columns in small type, which scrolls sideways on a narrow screen.
    pub fn wide_table(&mut self, header: &[&str], rows: &[Vec<String>]) -> &mut Page {
        self.push("<div class=\"wide\">").table(header, rows).push("</div>")
    }

    /// The same with room for sentences in the first column.
    pub fn figure_table(&mut self, header: &[&str], rows: &[Vec<String>]) -> &mut Page {
        self.push("<div class=\"wide figures\">").table(header, rows).push("</div>")
    }

    /// A figure in a file beside the page.
    pub fn image(&mut self, file: &str, title: &str, caption: &str) -> &mut Page {
        let (file, title, caption) = (escaped(file), escaped(title), escaped(caption));
        self.push(&format!("<figure><img src=\"{file}\" alt=\"{title}\" loading=\"lazy\"><figcaption>{caption}</figcaption></figure>"))
    }

    /// Small figures in files beside the page, side by side: (file, title).
    pub fn gallery(&mut self, images: &[(String, String)]) -> &mut Page {
        let image = |(file, title): &(String, String)| {
            format!("<figure><img src=\"{}\" alt=\"{}\" loading=\"lazy\"></figure>", escaped(file), escaped(title))
        };
        self.push(&format!("<div class=\"gallery\">{}</div>", images.iter().map(image).collect::<String>()))
    }

    /// A link to a file beside the page.
    pub fn file(&mut self, file: &str, what: &str) -> &mut Page {
        self.push(&format!("<p><a href=\"{0}\">{0}</a>: {1}</p>", escaped(file), escaped(what)))
    }

    /// A figure: an SVG document, taken as it is, with a caption.
    pub fn figure(&mut self, svg: &str, caption: &str) -> &mut Page {
        self.push(&format!("<figure>\n{svg}<figcaption>{}</figcaption></figure>", escaped(caption)))
    }

    /// The whole page.
    pub fn html(&self) -> String {
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" \
             content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main{class}>\n\
             <h1>{title}</h1>\n{body}</main>\n</body>\n</html>\n",
            title = self.title,
            class = if self.wide { " class=\"roomy\"" } else { "" },
            body = self.body
        )
    }

    fn push(&mut self, html: &str) -> &mut Page {
        self.body.push_str(html);
        self.body.push('\n');
        self
    }
}

/// Text with HTML's special characters replaced.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_text_is_escaped_and_numbers_are_aligned() {
        let mut page = Page::new("a & b");
        page.heading("x < y")
            .paragraph("1 > 0")
            .table(&["what", "value"], &[vec!["steps".into(), "12".into()], vec!["error".into(), "\u{2212}3e-4".into()]]);
        page.figure("<svg></svg>", "\"caption\"").tiles(&[("3 \u{d7}".into(), "times")]);
        let html = page.html();
        for part in [
            "<h1>a &amp; b</h1>",
            "x &lt; y",
            "1 &gt; 0",
            "<td>steps</td><td class=\"number\">12</td>",
            "<svg></svg>",
            "&quot;caption&quot;",
        ] {
            assert!(html.contains(part), "{part}");
        }
        assert!(!html.contains("<script") && !html.contains("http"));
    }
}
