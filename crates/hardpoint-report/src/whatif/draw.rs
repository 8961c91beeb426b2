//! The page of a changed design: curves as SVG, tables, and a heat map; one file that opens from disk.

use std::fmt::Write;

use plotters::prelude::*;

use crate::figures::{number, rounded};
use crate::metric::MetricChange;
use crate::page::{Table, escape_text as escaped};

use super::{ChangeFact, MeasureFact, WhatIfFacts};

/// Size of one plot, pixels.
const SIZE: (u32, u32) = (560, 340);
const COLOURS: [RGBColor; 4] = [
    RGBColor(120, 128, 136),
    RGBColor(0xd5, 0x5e, 0x00),
    RGBColor(0x00, 0x72, 0xb2),
    RGBColor(0x1c, 0x21, 0x26),
];
const STYLE: &str = "\
:root{color-scheme:light dark;font:15px/1.45 system-ui,sans-serif}\
body{max-width:1180px;margin:2rem auto;padding:0 1rem}\
table{border-collapse:collapse;margin:.5rem 0 1.5rem;font-variant-numeric:tabular-nums}\
th,td{padding:.2rem .6rem;border-bottom:1px solid #8884;text-align:right;white-space:nowrap}\
th:first-child,td:first-child{text-align:left}\
.scroll{overflow-x:auto}.plots{display:flex;flex-wrap:wrap;gap:1rem}\
.plots svg{background:#fff;border:1px solid #8884;border-radius:4px;max-width:100%;height:auto}\
.heat td{min-width:3.5rem}.note{color:#777;max-width:70ch}";

pub(super) fn html(
    facts: &WhatIfFacts,
    over: Option<&str>,
    wanted: &dyn Fn(&str) -> bool,
) -> Result<String, String> {
    let mut page = String::new();
    let title = escaped(&facts.name);
    write!(
        page,
        "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width\"><title>{title}</title><style>{STYLE}</style></head>\
         <body><h1>{title}</h1>"
    )
    .map_err(|e| e.to_string())?;
    if !facts.change.is_empty() {
        page += &format!(
            "<p><strong>What if {}?</strong> The change is {}.</p>",
            escaped(&facts.change_line()),
            escaped(&facts.follows)
        );
        if !facts.nearest.is_empty() {
            page += &format!(
                "<p>The nearest change that keeps all joints closed: {}.</p>",
                escaped(&ChangeFact::line(&facts.nearest))
            );
        }
        let abscissa = over.and_then(|name| facts.measures.iter().find(|m| m.measure == name));
        page += "<div class=\"plots\">";
        for m in facts.measures.iter().filter(|m| wanted(&m.measure) && Some(m.measure.as_str()) != over) {
            page += &plot(&facts.times, abscissa, m, false).map_err(|e| e.to_string())?;
            page += &plot(&facts.times, abscissa, m, true).map_err(|e| e.to_string())?;
        }
        page += "</div>";
        page += &table(&facts.table(wanted));
        page += &MetricChange::table(&facts.metrics).map_or(String::new(), |t| table(&t));
    }
    page += &heat_map(facts);
    for measure in facts.ranked().into_iter().filter(|m| wanted(m)) {
        page += &table(&facts.ranking(measure, 10));
    }
    page += &format!(
        "<p class=\"note\">{}, from {}</p></body></html>\n",
        escaped(facts.generator),
        escaped(&facts.file)
    );
    Ok(page)
}

/// Today's curve, both predictions and the exact one; or by how much they differ from today's.
fn plot(
    times: &[f64],
    over: Option<&MeasureFact>,
    m: &MeasureFact,
    change: bool,
) -> Result<String, Box<dyn std::error::Error>> {
    let less_today =
        |curve: &[f64]| -> Vec<f64> { curve.iter().zip(&m.today).map(|(x, now)| x - now).collect() };
    let curves = match change {
        false => [m.today.clone(), m.first.clone(), m.second.clone(), m.exact.clone()],
        true => [Vec::new(), less_today(&m.first), less_today(&m.second), less_today(&m.exact)],
    };
    // Every curve stands over its own abscissa: a changed design has another wheel travel, too.
    let abscissa = |c: usize| match over {
        None => times,
        Some(x) => [&x.today, &x.first, &x.second, &x.exact][c],
    };
    let range = |values: &mut dyn Iterator<Item = f64>| {
        let (low, high) =
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        let room = if high > low { 0.04 * (high - low) } else { f64::max(1e-6, 0.01 * high.abs()) };
        (low - room)..(high + room)
    };
    let xs = range(&mut (0..4).flat_map(|c| abscissa(c).iter().copied()));
    let ys = range(&mut curves.iter().flat_map(|c| c.iter().copied()));
    if !(xs.start.is_finite() && ys.start.is_finite()) {
        return Ok(String::new());
    }
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        let mut chart = ChartBuilder::on(&root)
            .caption(
                format!("{}{} [{}]", if change { "change of " } else { "" }, m.measure, m.unit),
                ("sans-serif", 16),
            )
            .margin(10)
            .x_label_area_size(38)
            .y_label_area_size(66)
            .build_cartesian_2d(xs.clone(), ys.clone())?;
        let along = over.map_or("t [s]".into(), |x| format!("{} [{}]", x.measure, x.unit));
        chart
            .configure_mesh()
            .x_desc(along)
            .x_label_formatter(&|x| tick(*x, &xs))
            .y_label_formatter(&|y| tick(*y, &ys))
            .light_line_style(WHITE)
            .draw()?;
        // The exact curve lies under the predictions, which are broken lines.
        for c in [0, 3, 1, 2] {
            let points: Vec<(f64, f64)> =
                abscissa(c).iter().copied().zip(curves[c].iter().copied()).collect();
            if points.is_empty() {
                continue;
            }
            let style = COLOURS[c].stroke_width(if c == 3 { 3 } else { 2 });
            let legend = move |(x, y): (i32, i32)| {
                PathElement::new(vec![(x, y), (x + 18, y)], COLOURS[c].stroke_width(2))
            };
            if c == 1 || c == 2 {
                let dash = if c == 1 { (3, 4) } else { (8, 5) };
                chart
                    .draw_series(DashedLineSeries::new(points, dash.0, dash.1, style))?
                    .label(super::CURVES[c])
                    .legend(legend);
            } else {
                chart.draw_series(LineSeries::new(points, style))?.label(super::CURVES[c]).legend(legend);
            }
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperRight)
            .background_style(WHITE.mix(0.8))
            .border_style(RGBColor(200, 204, 208))
            .draw()?;
        root.present()?;
    }
    Ok(svg)
}

/// A number at an axis: what is round-off of its range is nothing.
fn tick(x: f64, range: &std::ops::Range<f64>) -> String {
    let none = x.abs() < 1e-9 * (range.end - range.start);
    rounded(if none { 0.0 } else { x }, 4)
}

/// Measures by variables; within a measure and a unit the strongest is the darkest.
fn heat_map(facts: &WhatIfFacts) -> String {
    let measures = facts.ranked();
    let mut units: Vec<&str> = Vec::new();
    for i in &facts.influence {
        if !units.contains(&i.per.as_str()) {
            units.push(&i.per);
        }
    }
    let mut page = String::new();
    for unit in units {
        let of_unit = || facts.influence.iter().filter(|i| i.per == unit);
        let mut variables: Vec<&str> = Vec::new();
        for i in of_unit() {
            if !variables.contains(&i.variable.as_str()) {
                variables.push(&i.variable);
            }
        }
        let per = if unit == "1" { "per unit".to_owned() } else { format!("per {unit}") };
        page += &format!(
            "<h2>Which variable moves which measure, {}</h2><div class=\"scroll\"><table class=\"heat\"><tr><th>variable</th>",
            escaped(&per)
        );
        for m in &measures {
            let unit = of_unit().find(|i| i.measure == *m).map_or("", |i| &i.unit);
            page += &format!("<th>{}<br>{}</th>", escaped(m), escaped(unit));
        }
        page += "</tr>";
        for v in variables {
            page += &format!("<tr><td>{}</td>", escaped(v));
            for m in &measures {
                let largest =
                    of_unit().filter(|i| i.measure == *m).map(|i| i.largest.abs()).fold(0.0, f64::max);
                match of_unit().find(|i| i.measure == *m && i.variable == v) {
                    Some(i) => {
                        let share = if largest > 0.0 { i.largest.abs() / largest } else { 0.0 };
                        page += &format!(
                            "<td style=\"background:rgba(31,111,178,{:.2})\" title=\"at t = {} s\">{}</td>",
                            0.75 * share,
                            number(i.time),
                            rounded(i.largest, 3)
                        );
                    }
                    None => page += "<td></td>",
                }
            }
            page += "</tr>";
        }
        page += "</table></div>";
    }
    page
}

fn table(table: &Table) -> String {
    let cells = |tag: &str, row: &[String]| -> String {
        row.iter().map(|cell| format!("<{tag}>{}</{tag}>", escaped(cell))).collect()
    };
    let rows: String = table.rows.iter().map(|row| format!("<tr>{}</tr>", cells("td", row))).collect();
    format!(
        "<h2>{}</h2><p class=\"note\">{}</p><div class=\"scroll\"><table><tr>{}</tr>{rows}</table></div>",
        escaped(&table.title),
        escaped(&table.note),
        cells("th", &table.header)
    )
}
