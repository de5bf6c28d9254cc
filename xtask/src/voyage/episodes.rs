//! Stretches of a record in which something holds: the cable off its sheave, out of the groove, slack.

use super::Record;

/// One stretch. The record knows the communication points only: it begins at the first row where it holds and ends at the first where it does not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Episode {
    /// s.
    pub begin: f64,
    /// s; the last row's time where it still holds there.
    pub end: f64,
    /// It holds at the last row.
    pub open: bool,
}

/// The stretches in which `holds` of a row.
pub fn episodes(times: &[f64], holds: impl Fn(usize) -> bool) -> Vec<Episode> {
    let mut found: Vec<Episode> = Vec::new();
    let mut open = false;
    for (row, &time) in times.iter().enumerate() {
        let now = holds(row);
        match found.last_mut().filter(|_| open) {
            Some(last) => *last = Episode { end: time, open: now, ..*last },
            None if now => found.push(Episode { begin: time, end: time, open: true }),
            None => {}
        }
        open = now;
    }
    found
}

/// What befell the cable, by name: `(what, episodes)`, also where there was none.
pub fn all(record: &Record) -> Vec<(String, Vec<Episode>)> {
    let of = |name: &str, value: bool| {
        Some(episodes(&record.times, |row| (record.columns[name][row] != 0.0) == value)).filter(|_| record.has(name))
    };
    let mut list = Vec::new();
    let mut add = |what: String, name: &str, value: bool| {
        if record.has(name) {
            list.extend(of(name, value).map(|found| (what, found)));
        }
    };
    for (i, sheave) in record.scene.sheaves.iter().enumerate() {
        add(format!("off the {}", sheave.name), &format!("sheave[{}].in_contact", i + 1), false);
        add(format!("out of the groove of the {}", sheave.name), &format!("sheave[{}].out_of_groove", i + 1), true);
    }
    add("slack cable".to_owned(), "cable.slack", true);
    list
}

/// Where the least line load on a sheave was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margin {
    /// N/m.
    pub line_load: f64,
    pub row: usize,
}

/// The least of `line_loads` among rows that are in contact.
pub fn least_in_contact(line_loads: &[f64], in_contact: impl Fn(usize) -> bool) -> Option<Margin> {
    let rows = line_loads.iter().enumerate().filter(|&(row, load)| load.is_finite() && in_contact(row));
    rows.min_by(|a, b| a.1.total_cmp(b.1)).map(|(row, &line_load)| Margin { line_load, row })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_episodes_end_where_it_no_longer_holds() {
        let times = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5];
        let of = |flags: [bool; 6]| episodes(&times, |row| flags[row]).iter().map(|e| (e.begin, e.end, e.open)).collect::<Vec<_>>();
        assert_eq!(of([false; 6]), []);
        assert_eq!(of([true; 6]), [(0.0, 0.5, true)]);
        assert_eq!(of([false, true, true, false, true, false]), [(0.1, 0.3, false), (0.4, 0.5, false)]);
        assert_eq!(of([true, false, false, false, false, true]), [(0.0, 0.1, false), (0.5, 0.5, true)]);
    }

    #[test]
    fn exact_the_margin_counts_contact_only() {
        let contact = [true, false, true, true];
        assert_eq!(least_in_contact(&[5.0, 0.0, 3.0, f64::NAN], |row| contact[row]), Some(Margin { line_load: 3.0, row: 2 }));
        assert_eq!(least_in_contact(&[5.0], |_| false), None);
    }
}
