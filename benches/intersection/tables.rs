//! The tables: printed, and written as CSV and Markdown.

use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::path::Path;

use crate::outcome::{Outcome, Row};

/// Prints everything, and writes it to `cohort-bench/intersection.csv` and `.md` in cargo's target folder. Does nothing
/// when the arguments left nothing to measure.
pub fn publish(outcome: &Outcome) -> Result<(), Box<dyn Error>> {
    if outcome.rows.is_empty() {
        return Ok(());
    }
    let markdown = markdown(outcome)?;
    println!("\n{markdown}");

    // Cargo tells benchmarks of a folder for their files, `tmp` in the target folder.
    let target = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let folder = target.parent().unwrap_or(target).join("cohort-bench");
    fs::create_dir_all(&folder)?;
    let [csv, md] =
        ["csv", "md"].map(|extension| folder.join("intersection").with_extension(extension));
    write_csv(outcome, &csv)?;
    fs::write(&md, markdown)?;
    println!("Written: {}, {}", csv.display(), md.display());
    Ok(())
}

/// One line for each row; rates in million rays a second.
fn write_csv(outcome: &Outcome, path: &Path) -> Result<(), Box<dyn Error>> {
    let mut csv = csv::Writer::from_path(path)?;
    csv.write_record([
        "scene",
        "quality",
        "robust",
        "rays",
        "call",
        "coherence",
        "safe_mrays_per_s",
        "c_mrays_per_s",
        "ratio_low",
        "ratio_high",
        "ratio",
    ])?;
    for row in &outcome.rows {
        let [low, high] = row.speed.ratio_interval;
        csv.write_record([
            row.scene,
            row.variant.quality_name(),
            if row.variant.robust { "true" } else { "false" },
            row.rays,
            row.call,
            row.coherence_name(),
            &format!("{:.4}", row.speed.safe),
            &format!("{:.4}", row.speed.plain_c),
            &format!("{low:.4}"),
            &format!("{high:.4}"),
            &format!("{:.4}", row.speed.ratio),
        ])?;
    }
    csv.flush()?;
    Ok(())
}

fn markdown(outcome: &Outcome) -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    every_call(outcome, &mut text)?;
    builds(outcome, &mut text)?;
    fastest_calls(outcome, &mut text)?;
    ratios(outcome, &mut text)?;
    Ok(text)
}

fn every_call(outcome: &Outcome, text: &mut String) -> std::fmt::Result {
    writeln!(text, "## Every call\n")?;
    writeln!(
        text,
        "| scene | build | rays | call | rays called | safe, Mrays/s | C, Mrays/s | 95 % interval | safe / C |"
    )?;
    writeln!(text, "|---|---|---|---|---|---:|---:|---:|---:|")?;
    for row in &outcome.rows {
        let [low, high] = row.speed.ratio_interval;
        writeln!(
            text,
            "| {} | {} | {} | `{}` | {} | {:.3} | {:.3} | {low:.3} to {high:.3} | {:.3} |",
            row.scene,
            row.variant.name(),
            row.rays,
            row.call,
            row.coherence_name(),
            row.speed.safe,
            row.speed.plain_c,
            row.speed.ratio,
        )?;
    }
    Ok(())
}

fn builds(outcome: &Outcome, text: &mut String) -> std::fmt::Result {
    writeln!(text, "\n## Acceleration structures\n")?;
    writeln!(
        text,
        "| scene | triangles | build | time, s | memory, MiB | bytes per triangle |"
    )?;
    writeln!(text, "|---|---:|---|---:|---:|---:|")?;
    for build in &outcome.builds {
        writeln!(
            text,
            "| {} | {} | {} | {:.4} | {:.2} | {:.0} |",
            build.scene,
            build.triangles,
            build.variant.name(),
            build.time.as_secs_f64(),
            build.bytes as f64 / f64::from(1 << 20),
            build.bytes as f64 / build.triangles as f64,
        )?;
    }
    Ok(())
}

/// For every kind of rays, the fastest call and the fastest stream of a structure of arrays.
fn fastest_calls(outcome: &Outcome, text: &mut String) -> std::fmt::Result {
    writeln!(text, "\n## The fastest call for each kind of rays\n")?;
    writeln!(
        text,
        "| scene | build | rays | fastest call | rays called | Mrays/s | best structure of arrays, Mrays/s |"
    )?;
    writeln!(text, "|---|---|---|---|---|---:|---|")?;
    let is_same_kind =
        |a: &Row, b: &Row| (a.scene, a.variant, a.rays) == (b.scene, b.variant, b.rays);
    for rows in outcome.rows.chunk_by(is_same_kind) {
        let fastest = |wanted: fn(&Row) -> bool| {
            let rows = rows.iter().filter(|row| wanted(row));
            rows.max_by(|a, b| a.speed.safe.total_cmp(&b.speed.safe))
        };
        let Some(best) = fastest(|_| true) else {
            continue;
        };
        let stream = fastest(|row| row.call.ends_with("_stream")).map_or_else(String::new, |row| {
            format!("{:.3} ({})", row.speed.safe, row.coherence_name())
        });
        writeln!(
            text,
            "| {} | {} | {} | `{}` | {} | {:.3} | {stream} |",
            best.scene,
            best.variant.name(),
            best.rays,
            best.call,
            best.coherence_name(),
            best.speed.safe,
        )?;
    }
    Ok(())
}

/// For every call, the ratio over all kinds of rays.
fn ratios(outcome: &Outcome, text: &mut String) -> std::fmt::Result {
    writeln!(text, "\n## Safe / C by call\n")?;
    writeln!(text, "| call | rows | lowest | highest | median |")?;
    writeln!(text, "|---|---:|---:|---:|---:|")?;
    let mut calls: Vec<&str> = outcome.rows.iter().map(|row| row.call).collect();
    calls.sort_unstable();
    calls.dedup();
    for call in calls {
        let of_call = outcome.rows.iter().filter(|row| row.call == call);
        let mut ratios: Vec<f64> = of_call.map(|row| row.speed.ratio).collect();
        ratios.sort_by(f64::total_cmp);
        writeln!(
            text,
            "| `{call}` | {} | {:.3} | {:.3} | {:.3} |",
            ratios.len(),
            ratios[0],
            ratios[ratios.len() - 1],
            ratios[ratios.len() / 2],
        )?;
    }
    Ok(())
}
