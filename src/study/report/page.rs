//! `index.html`: one file that needs nothing else, and no network.

use std::path::Path;

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::ReportError;
use super::answer::Answer;
use super::facts::{DEFINITIONS, budget, facts};
use super::numbers::counted;
use super::plots::{Plot, plots};
use super::table::{Cell, Table};
use super::viewer::{CompetitorImages, sections, swatch};
use super::{CSV, JSON, MARKDOWN};
use crate::study::results::{Pair, Results, StudyKind};

/// Lets the browser load nothing but what stands in the page.
const POLICY: &str =
    "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'";

/// The whole page; images are read from `folder`.
pub fn page(
    results: &Results,
    answer: &Answer,
    tables: &[Table],
    folder: &Path,
) -> Result<Markup, ReportError> {
    let plots = plots(results)?;
    let images = results
        .competitors
        .iter()
        .map(|competitor| CompetitorImages::read(results, competitor, folder));
    let images = images.collect::<Result<Vec<_>, _>>()?;
    let title = match results.kind {
        StudyKind::Compare => "Comparison",
        StudyKind::Accuracy => "Accuracy",
    };
    Ok(html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                link rel="icon" href="data:,";
                title { (title) ": " (results.scene.name) }
                style { (PreEscaped(include_str!("page.css"))) }
            }
            body {
                main {
                    (opening(results, answer, title))
                    (sections(results, &images))
                    @if !plots.is_empty() { (plot_section(results, &plots)) }
                    section id="tables" {
                        h2 { "Tables" }
                        @for table in tables { (table_markup(results, table)) }
                    }
                    (how_it_was_made(results))
                }
                footer { p {
                    "The same data: " a href=(JSON) { (JSON) } ", " a href=(CSV) { (CSV) } ", " a href=(MARKDOWN) { (MARKDOWN) }
                } }
                script { (PreEscaped(include_str!("page.js"))) }
            }
        }
    })
}

/// The answer.
fn opening(results: &Results, answer: &Answer, title: &str) -> Markup {
    let conditions = &results.conditions;
    html! {
        header {
            p.eyebrow {
                b { (title) } " · " (results.scene.name) " · " (results.scene.width) " × " (results.scene.height) " · "
                (budget(results)) " · " (counted(conditions.threads as u64, "thread")) " · "
                (counted(conditions.repetitions.into(), "repetition")) " · " (conditions.colour)
            }
            h1 { (answer.headline) }
            @if results.kind == StudyKind::Compare && results.pairs.len() == answer.findings.len() {
                (findings_with_bars(results, answer))
            } @else {
                ul.findings { @for finding in &answer.findings { li { (unbroken(finding)) } } }
            }
            @if !answer.cautions.is_empty() {
                aside.cautions aria-label="To be kept in mind" {
                    b { "To be kept in mind" }
                    ul { @for caution in &answer.cautions { li { (unbroken(caution)) } } }
                }
            }
        }
    }
}

/// Every finding with its interval drawn on a logarithmic axis that all share.
fn findings_with_bars(results: &Results, answer: &Answer) -> Markup {
    let ends = results.pairs.iter().flat_map(|pair| {
        let ratio = &pair.relative_efficiency;
        let (low, high) = ratio.bounds.unwrap_or((ratio.estimate, ratio.estimate));
        [low, ratio.estimate, high]
    });
    let widest = ends
        .filter(|end| end.is_finite() && *end > 0.0)
        .map(|end| end.log2().abs())
        .fold(0.5, f64::max)
        .min(10.0)
        * 1.08;
    html! {
        ul.findings.with-bars { @for (pair, finding) in results.pairs.iter().zip(&answer.findings) {
            li { p { (unbroken(finding)) } (bar(pair, widest)) }
        } }
        p.note {
            "Error is relative mean squared error at the whole budget. Bars show the ratio of efficiencies with its 95\u{a0}% interval on a "
            "logarithmic axis; where a bar holds the line at 1, no difference is shown."
        }
    }
}

/// The interval of a pair; `widest` is the largest binary logarithm on the axis.
fn bar(pair: &Pair, widest: f64) -> Markup {
    let place = |ratio: f64| {
        let log = if ratio > 0.0 {
            ratio.log2().clamp(-widest, widest)
        } else {
            -widest
        };
        50.0 + log / widest * 50.0
    };
    let ratio = &pair.relative_efficiency;
    let middle = place(ratio.estimate);
    let (low, high) = ratio
        .bounds
        .map_or((middle, middle), |(low, high)| (place(low), place(high)));
    let clear = if (low..=high).contains(&50.0) {
        ""
    } else {
        "clear"
    };
    html! {
        div.bar aria-hidden="true" {
            div.track {
                i.one {}
                i.range .(clear) style=(format!("left:{low:.2}%;width:{:.2}%", high - low)) {}
                i.dot .(clear) style=(format!("left:{middle:.2}%")) {}
            }
            div.ends {
                span { "← " (pair.first) " better" } span { "1" } span { (pair.second) " better →" }
            }
        }
    }
}

/// The text with its percent signs kept beside their numbers.
fn unbroken(text: &str) -> String {
    text.replace(" %", "\u{a0}%")
}

fn plot_section(results: &Results, plots: &[Plot]) -> Markup {
    let banded = results.conditions.repetitions > 1;
    html! {
        section id="plots" {
            h2 { "Error over cost" }
            p.note {
                "Both axes are logarithmic." @if banded { " Bands are 95\u{a0}% intervals over the repetitions." }
                @else { " One repetition leaves no bands." }
            }
            div.plots { @for plot in plots {
                figure {
                    figcaption { (plot.title) }
                    div role="img" aria-label=(format!("{}; its numbers are in results.csv", plot.title)) { (PreEscaped(&plot.svg)) }
                }
            } }
        }
    }
}

fn table_markup(results: &Results, table: &Table) -> Markup {
    let index = |cell: &Cell| {
        let all = &results.competitors;
        let index = all
            .iter()
            .position(|competitor| competitor.name == cell.value);
        index.filter(|_| results.kind == StudyKind::Compare)
    };
    html! {
        h3 { (table.title) }
        @if !table.note.is_empty() { p.note { (table.note) } }
        div.scroll tabindex="0" role="region" aria-label=(table.title) {
            table {
                thead { tr { @for head in &table.columns { th scope="col" { (head) } } } }
                tbody { @for row in &table.rows {
                    tr { @for (column, cell) in row.iter().enumerate() {
                        @if column == 0 {
                            th scope="row" { @if let Some(index) = index(cell) { (swatch(index)) } (content(cell)) }
                        } @else {
                            td { (content(cell)) }
                        }
                    } }
                } }
            }
        }
    }
}

fn content(cell: &Cell) -> Markup {
    html! {
        (cell.value)
        @if !cell.detail.is_empty() { small { (cell.detail) } }
    }
}

fn how_it_was_made(results: &Results) -> Markup {
    html! {
        section id="conditions" {
            h2 { "How it was measured" }
            dl.facts { @for (name, value) in facts(results) {
                div { dt { (name) } dd { (value) } }
            } }
            @if !results.commands.is_empty() {
                h3 { "Commands" }
                div.commands {
                    button type="button" #copy hidden { "Copy" }
                    pre tabindex="0" { code #commands { (results.commands.join("\n")) } }
                }
            }
            h3 { "Measures" }
            dl.definitions { @for (name, definition) in DEFINITIONS {
                div { dt { (name) } dd { (definition) } }
            } }
        }
    }
}
