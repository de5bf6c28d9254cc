//! `index.html`: tensions, forces on sheaves, margins against detachment, what befell the cable, load cycles.

use super::Record;
use super::episodes::{all, least_in_contact};
use super::rainflow::{binned, cycles, exceedance};
use crate::demo_report::units::{ANGLE, FORCE, LENGTH, LINE_LOAD, TORQUE, Unit, rounded, times};
use crate::html_report::Page;
use crate::plots::{Chart, PALETTE, Panel, Series};

/// Episodes of a kind that are listed one by one.
const LISTED: usize = 30;
/// What stays below it, in SI units, is zero but for rounding.
const NOTHING: f64 = 1e-9;

/// The page.
pub fn html(record: &Record, animated: bool) -> String {
    let (begin, end) = (record.times[0], record.times[record.times.len() - 1]);
    let mut page = Page::new(&format!("{}: loads and detachment", record.title)).wide();
    page.paragraph(&format!(
        "A run from {} s to {} s with {} communication points. What happens between two of them is not in the outputs: choose a step that \
         resolves the loads. Angles on a sheave count about its axis from \"up\".",
        number(begin),
        number(end),
        record.times.len()
    ));
    if let Some(failure) = &record.failure {
        page.paragraph(&format!("The run ended early: {failure}"));
    }
    if animated {
        page.file("animation.html", "the cable moving; #t=12.5&view=orbit behind the address opens it at that time in that view");
    }
    page.tiles(&tiles(record));
    episodes(&mut page, record);
    margins(&mut page, record);
    figures(&mut page, record);
    extremes(&mut page, record);
    let winch = ["winch.tension", "anchor.tension"].into_iter().find(|name| record.has(name));
    if let Some(name) = winch {
        load_cycles(&mut page, record, name);
    }
    page.html()
}

/// Three decimals at most.
fn number(value: f64) -> String {
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// In a unit that suits the value.
fn with_unit(value: f64, unit: &Unit) -> String {
    let (symbol, factor) = unit.fitting([value].into_iter());
    format!("{} {symbol}", rounded(factor * value))
}

fn plural(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

fn least(values: &[f64]) -> Option<(usize, f64)> {
    values.iter().copied().enumerate().filter(|(_, v)| v.is_finite()).min_by(|a, b| a.1.total_cmp(&b.1))
}

fn greatest(values: &[f64]) -> Option<(usize, f64)> {
    // Of equal ones the first: `max_by` alone would give the last.
    values.iter().copied().enumerate().filter(|(_, v)| v.is_finite()).rev().max_by(|a, b| a.1.total_cmp(&b.1))
}

fn tiles(record: &Record) -> Vec<(String, &'static str)> {
    let mut tiles = Vec::new();
    let force = |found: Option<(usize, f64)>| found.map(|(_, value)| with_unit(value, &FORCE));
    let column = |name: &str| record.column(name);
    let mut add = |value: Option<String>, what| tiles.extend(value.map(|value| (value, what)));
    add(force(column("cable.tension_max").and_then(greatest)), "greatest tension in the cable");
    add(force(column("cable.tension_min").and_then(least)), "least tension in the cable");
    let lift = (0..record.scene.sheaves.len()).filter_map(|i| margin(record, i)).map(|(load, _)| load).min_by(f64::total_cmp);
    add(lift.map(|load| with_unit(load, &LINE_LOAD)), "least line load on a sheave in contact");
    let count = |of: fn(&str) -> bool| all(record).iter().filter(|(what, _)| of(what)).map(|(_, list)| list.len()).sum::<usize>();
    if !record.scene.sheaves.is_empty() {
        add(Some(count(|what| !what.starts_with("slack")).to_string()), "times off a sheave or out of its groove");
    }
    add(Some(count(|what| what.starts_with("slack")).to_string()), "times slack");
    tiles
}

fn episodes(page: &mut Page, record: &Record) {
    page.heading("Detachment and slack");
    let mut rows = Vec::new();
    let mut notes = Vec::new();
    for (what, list) in all(record) {
        if list.is_empty() {
            notes.push(format!("{what}: never"));
            continue;
        }
        let total: f64 = list.iter().map(|episode| episode.end - episode.begin).sum();
        notes.push(format!("{what}: {}, {} s together", plural(list.len(), "time"), number(total)));
        rows.extend(list.iter().take(LISTED).map(|episode| {
            let end = if episode.open { "still at the end of the run".to_owned() } else { number(episode.end) };
            vec![what.clone(), number(episode.begin), end, number(episode.end - episode.begin)]
        }));
        if list.len() > LISTED {
            notes.push(format!("the first {LISTED} are listed"));
        }
    }
    let mut text = notes.join("; ");
    if let Some(first) = text.get(..1).map(str::to_uppercase) {
        text.replace_range(..1, &first);
        page.paragraph(&format!("{text}."));
    }
    if !rows.is_empty() {
        page.table(&["What", "From, s", "To, s", "For, s"], &rows);
    }
}

/// The least line load of a sheave, N/m, while the cable touches it, and the row.
fn margin(record: &Record, i: usize) -> Option<(f64, usize)> {
    let contact = record.of_sheave(i, "in_contact");
    let found = least_in_contact(record.of_sheave(i, "line_load_min")?, |row| contact.is_none_or(|contact| contact[row] != 0.0))?;
    Some((found.line_load, found.row))
}

fn margins(page: &mut Page, record: &Record) {
    let rows: Vec<_> = (0..record.scene.sheaves.len())
        .filter_map(|i| {
            let sheave = &record.scene.sheaves[i];
            let Some((load, row)) = margin(record, i) else {
                record.of_sheave(i, "line_load_min")?;
                return Some(vec![sheave.name.clone(), "never in contact".to_owned()]);
            };
            let at = |what: &str| record.of_sheave(i, what).map(|values| values[row]);
            let degrees = |what: &str| at(what).map_or_else(String::new, |angle| format!("{:.1}", angle.to_degrees()));
            let tension = at("tension_in").zip(at("tension_out")).map(|(a, b)| a.min(b));
            let mean = tension.map(|tension| tension / sheave.radius);
            let share = mean.filter(|mean| *mean > 0.0).map_or_else(String::new, |mean| format!("{:.0} %", 100.0 * load / mean));
            let time = number(record.times[row]);
            let tension = tension.map_or_else(String::new, |tension| with_unit(tension, &FORCE));
            Some(vec![
                sheave.name.clone(),
                with_unit(load, &LINE_LOAD),
                share,
                time,
                degrees("contact_begin"),
                degrees("contact_end"),
                tension,
            ])
        })
        .collect();
    if rows.is_empty() {
        return;
    }
    page.heading("Margin against lifting off");
    page.paragraph(
        "The least line load between cable and sheave while they touch, away from the arc's ends, and when and where that was: at nothing the cable \
         lifts off. Its share is of T/R, the line load of a flexible cable under the lesser of the tensions at both sides then.",
    );
    page.wide_table(
        &["Sheave", "Least line load", "Share of T/R", "At, s", "Contact begins, °", "Contact ends, °", "Lesser tension"],
        &rows,
    );
}

fn panel(record: &Record, quantity: &str, unit: &Unit, names: &[String]) -> Option<Panel> {
    let found: Vec<_> = names.iter().filter_map(|name| Some((name, record.column(name)?))).collect();
    let (symbol, factor) = unit.fitting(found.iter().flat_map(|(_, values)| values.iter().copied()));
    let lines: Vec<_> = found
        .iter()
        .zip(PALETTE.iter().cycle())
        .map(|((name, values), colour)| Series::new(name, &record.times, &times(values, factor), *colour).width(1.3))
        .collect();
    (!lines.is_empty()).then(|| Panel::new(&format!("{quantity}, {symbol}"), lines))
}

fn figures(page: &mut Page, record: &Record) {
    let tensions: Vec<String> = record.tensions().into_iter().map(str::to_owned).collect();
    let (inside, ends): (Vec<_>, Vec<_>) = tensions.into_iter().partition(|name| name.starts_with("sheave[") || name.starts_with("cable."));
    let (sheaves, cable): (Vec<_>, Vec<_>) = inside.into_iter().partition(|name| name.starts_with("sheave["));
    let each = |what: &str| (1..=record.scene.sheaves.len()).map(|i| format!("sheave[{i}].{what}")).collect::<Vec<_>>();
    let charts = [(
        "Tensions",
        "Tension",
        [(&ends, &FORCE), (&sheaves, &FORCE), (&cable, &FORCE)],
        "Effective tensions at the cable's ends, at the sheaves, and their least and greatest along the cable.",
    )];
    let mut list: Vec<(Chart, &str)> = Vec::new();
    for (title, quantity, groups, caption) in charts {
        let panels: Vec<_> = groups.iter().filter_map(|(names, unit)| panel(record, quantity, unit, names)).collect();
        list.push((Chart::new(title, "Time, s", panels), caption));
    }
    let flanks: Vec<_> =
        (1..=record.scene.sheaves.len()).flat_map(|i| [1, 2].map(|side| format!("sheave[{i}].flank_force[{side}]"))).collect();
    let panels = [
        panel(record, "Resultant", &FORCE, &each("normal_force")),
        panel(record, "On the flanks", &FORCE, &flanks),
        panel(record, "Least line load", &LINE_LOAD, &each("line_load_min")),
        panel(record, "Contact arc", &ANGLE, &each("wrap_angle")).map(|panel| panel.height(130.0)),
    ];
    let panels: Vec<_> = panels.into_iter().flatten().collect();
    list.push((
        Chart::new("Sheaves", "Time, s", panels),
        "What the cable does to the sheaves; a line load of nothing is a cable that lifts off.",
    ));
    page.heading("Over time");
    for (chart, caption) in list.iter().filter(|(chart, _)| !chart.panels.is_empty()) {
        page.figure(&chart.svg(), caption);
    }
}

fn extremes(page: &mut Page, record: &Record) {
    let mut list: Vec<(String, &Unit)> = record.tensions().into_iter().map(|name| (name.to_owned(), &FORCE)).collect();
    for i in 1..=record.scene.sheaves.len() {
        let of = |what: &str| format!("sheave[{i}].{what}");
        list.extend(["normal_force", "flank_force[1]", "flank_force[2]", "force.x", "force.y", "force.z"].map(|what| (of(what), &FORCE)));
        list.extend(["line_load_max", "line_load_min"].map(|what| (of(what), &LINE_LOAD)));
        list.extend(["wrap_angle", "turn_angle"].map(|what| (of(what), &ANGLE)));
    }
    for axis in ["x", "y", "z"] {
        list.extend(["winch", "anchor", "ship"].map(|of| (format!("{of}.force.{axis}"), &FORCE)));
        list.extend(["body", "load", "ship"].map(|of| (format!("{of}.{axis}"), &LENGTH)));
    }
    list.extend([("winch.torque", &TORQUE), ("winch.payout", &LENGTH)].map(|(name, unit)| (name.to_owned(), unit)));
    list.extend(["ship.roll", "ship.pitch", "ship.yaw"].map(|name| (name.to_owned(), &ANGLE)));
    // By what they belong to, as they come.
    let order = ["cable", "winch", "anchor", "sheave", "body", "load", "ship"];
    list.sort_by_key(|(name, _)| order.iter().position(|first| name.starts_with(first)));
    let rows: Vec<_> = list
        .iter()
        .filter_map(|(name, unit)| {
            let values = record.column(name)?;
            let ((low, least), (high, greatest)) = (least(values)?, greatest(values)?);
            if least.abs().max(greatest.abs()) < NOTHING {
                return None;
            }
            let (symbol, factor) = unit.fitting(values.iter().copied());
            let write = |value: f64| format!("{:.3}", value * factor + 0.0).replace('-', "\u{2212}");
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            let (low, high) = (number(record.times[low]), number(record.times[high]));
            Some(vec![name.clone(), write(least), low, write(mean), write(greatest), high, symbol.to_owned()])
        })
        .collect();
    page.heading("Extremes")
        .paragraph("Least and greatest value at the communication points, and when each came first; what is zero throughout (below 1e-9 in SI units) is left out.");
    page.wide_table(&["What", "Least", "at, s", "Mean", "Greatest", "at, s", "Unit"], &rows);
}

fn load_cycles(page: &mut Page, record: &Record, name: &str) {
    let Some(values) = record.column(name) else { return };
    let found = cycles(values);
    let (Some((_, low)), Some((_, high))) = (least(values), greatest(values)) else { return };
    let (symbol, factor) = FORCE.fitting([low, high].into_iter());
    let write = |value: f64| rounded(value * factor);
    page.heading(&format!("Load cycles of {name}"));
    let count: f64 = found.iter().map(|cycle| cycle.count).sum();
    page.paragraph(&format!(
        "Rain-flow count after ASTM E1049-85 (section 5.4.4): {count} cycles, a half cycle counting half, in ten classes of equal width. The lowest \
         class holds the smallest ripple too."
    ));
    let rows: Vec<_> = binned(&found, 10)
        .iter()
        .map(|bin| {
            let mean = if bin.count > 0.0 { write(bin.mean) } else { String::new() };
            vec![write(bin.from), write(bin.to), format!("{}", bin.count), mean]
        })
        .collect();
    let [from, to, mean] = ["Range from", "to", "Mean of these cycles"].map(|what| format!("{what}, {symbol}"));
    page.table(&[&from, &to, "Cycles", &mean], &rows);
    page.heading(&format!("Levels that {name} exceeds"));
    let span = record.times[record.times.len() - 1] - record.times[0];
    let rows: Vec<_> = (0..10)
        .map(|k| {
            let level = low + (high - low) * f64::from(k) / 10.0;
            let (crossings, above) = exceedance(&record.times, values, level);
            let share = if span > 0.0 { 100.0 * above / span } else { 0.0 };
            vec![write(level), crossings.to_string(), number(above), format!("{share:.2}")]
        })
        .collect();
    page.table(&[&format!("Level, {symbol}"), "Times risen through", "Above, s", "Above, % of the run"], &rows);
}
