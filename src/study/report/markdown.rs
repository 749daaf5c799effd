//! `report.md`: the answer and the tables in GitHub's Markdown, with links to the images.

use std::fmt::Write as _;

use super::answer::Answer;
use super::facts::{DEFINITIONS, facts};
use super::table::{Cell, Table};
use crate::study::results::Results;

/// The whole file.
pub fn markdown(results: &Results, answer: &Answer, tables: &[Table], has_figure: bool) -> String {
    let mut text = format!("# {}\n\n", escaped(&answer.headline));
    for finding in &answer.findings {
        text += &format!("- {}\n", escaped(finding));
    }
    if !answer.cautions.is_empty() {
        text += "\nTo be kept in mind:\n\n";
        for caution in &answer.cautions {
            text += &format!("- {}\n", escaped(caution));
        }
    }
    text += "\n## Images\n\nOne repetition of each, then its error in false colour.\n\n";
    images(&mut text, results);
    if has_figure {
        let names = results
            .competitors
            .iter()
            .map(|competitor| escaped(&competitor.name));
        let names: Vec<String> = names.collect();
        let _ = writeln!(
            text,
            "\nSide by side, with enlarged crops ({}):\n\n![]({})",
            names.join(", "),
            super::FIGURE
        );
    }
    for table in tables {
        write_table(&mut text, table);
    }
    text += "\n## Conditions\n\n";
    for (name, value) in facts(results) {
        let _ = writeln!(text, "- {}: {}", escaped(&name), escaped(&value));
    }
    text += "\n## Commands\n\n";
    // Indented, so that nothing in a command can end the block.
    for line in results.commands.iter().flat_map(|command| command.lines()) {
        let _ = writeln!(text, "    {line}");
    }
    text += "\n## Measures\n\n";
    for (name, definition) in DEFINITIONS {
        let _ = writeln!(text, "- **{name}**: {}", escaped(definition));
    }
    text
}

fn images(text: &mut String, results: &Results) {
    let row = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let of_all = |cell: &dyn Fn(&crate::study::results::Competitor) -> String| {
        row(results.competitors.iter().map(cell).collect())
    };
    let picture = |name: &str, path: &str| {
        format!(
            "![{}](<{}>)",
            escaped(name),
            path.replace(['<', '>', '\n'], "")
        )
    };
    *text += &of_all(&|competitor| escaped(&competitor.name));
    *text += &of_all(&|_| "---".to_owned());
    *text += &of_all(&|competitor| picture(&competitor.name, &competitor.images.one_png));
    *text += &of_all(&|competitor| {
        picture(
            &format!("error of {}", competitor.name),
            &competitor.images.error_png,
        )
    });
    *text += &of_all(&|competitor| format!("[EXR](<{}>)", competitor.images.exr));
}

fn write_table(text: &mut String, table: &Table) {
    let _ = writeln!(text, "\n## {}\n", escaped(&table.title));
    if !table.note.is_empty() {
        let _ = writeln!(text, "{}\n", escaped(&table.note));
    }
    let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    *text += &line(table.columns.iter().map(|head| escaped(head)).collect());
    *text += &line(table.columns.iter().map(|_| "---".to_owned()).collect());
    for row in &table.rows {
        *text += &line(row.iter().map(cell).collect());
    }
}

fn cell(cell: &Cell) -> String {
    let value = escaped(&cell.value);
    if cell.detail.is_empty() {
        value
    } else if cell.detail.starts_with('(') {
        format!("{value} {}", escaped(&cell.detail))
    } else {
        format!("{value} ({})", escaped(&cell.detail))
    }
}

/// Text in which nothing is a command to Markdown.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '\n' | '\r' => escaped.push(' '),
            '\\' | '`' | '*' | '_' | '[' | ']' | '<' | '>' | '|' | '#' | '~' => {
                escaped.extend(['\\', letter]);
            }
            _ => escaped.push(letter),
        }
    }
    escaped
}
