//! The report of a study as files, and as a page in a browser.

#[path = "support/files.rs"]
#[allow(dead_code, reason = "the module serves many tests")]
mod files;
mod report_support;

use std::fs;
use std::path::{Path, PathBuf};

use cohort::study::report::write_report;
use cohort::study::results::*;
use cohort::study::statistics::Interval;
use report_support::browser::Browser;
use report_support::synthetic::{comparison, competitor, pair, write_images};

/// Writes the report and its images into a folder that is kept, so that people can look at it.
fn report(name: &str, results: &Results) -> PathBuf {
    let folder = files::kept_folder(name);
    write_images(results, &folder);
    write_report(results, &folder).unwrap();
    folder
}

fn text(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).unwrap()
}

/// An accuracy study of two settings.
fn accuracy() -> Results {
    let mut results = comparison();
    results.kind = StudyKind::Accuracy;
    let verdict = |axis: &str, value: &str, error: (f64, f64, f64), text: &str| Verdict {
        axis: axis.to_owned(),
        value: value.to_owned(),
        is_default: value == "4",
        time_per_sample: Interval {
            estimate: 1.21,
            bounds: Some((1.19, 1.23)),
        },
        error_at_equal_time: Interval {
            estimate: error.0,
            bounds: Some((error.1, error.2)),
        },
        bias: Interval {
            estimate: -0.031,
            bounds: Some((-0.034, -0.028)),
        },
        biased: axis == "max-depth",
        text: text.to_owned(),
    };
    let mut varied = |name: &str, noise: f64, verdict: Verdict| {
        let mut competitor = competitor(name, noise);
        competitor.verdict = Some(verdict);
        results.competitors.push(competitor);
    };
    varied(
        "wavelengths-4",
        30.0,
        verdict(
            "wavelengths",
            "4",
            (0.91, 0.88, 0.94),
            "costs 21 % time, buys 9 % error",
        ),
    );
    varied(
        "wavelengths-8",
        40.0,
        verdict(
            "wavelengths",
            "8",
            (1.07, 1.02, 1.12),
            "costs 21 % time, loses 7 % error",
        ),
    );
    varied(
        "depth-4",
        25.0,
        verdict("max-depth", "4", (0.8, 0.7, 0.9), "costs bias"),
    );
    results.competitors.drain(1..3);
    results.competitors[0].name = "baseline".to_owned();
    results.pairs = vec![
        pair("baseline", "wavelengths-4", 1.2),
        pair("wavelengths-4", "wavelengths-8", 0.7),
    ];
    results
}

#[test]
fn the_data_survives_its_file() {
    let results = comparison();
    let folder = report("report-files", &results);
    let again: Results = serde_json::from_str(&text(&folder, "results.json")).unwrap();
    // Not assert_eq, which would print both.
    assert!(
        again == results,
        "results.json reads back as something else"
    );
    let csv = text(&folder, "results.csv");
    // A head, then 3 competitors, 8 snapshots, 4 repetitions.
    assert_eq!(csv.lines().count(), 1 + 3 * 8 * 4);
    assert!(
        csv.lines()
            .nth(1)
            .unwrap()
            .starts_with("roulette,1,14.0625,")
    );
}

#[test]
fn page_and_markdown_open_with_the_answer() {
    let folder = report("report-answer", &comparison());
    let headline = "roulette and particle-filter lead; no difference is shown between them.";
    let slower = "go-with-the-winners is slower than roulette: it needs 1.61 times the time for the same error";
    let page = text(&folder, "index.html");
    assert!(page.contains(&format!("<h1>{headline}</h1>")) && page.contains(slower));
    assert!(page.contains("A Processor &lt;of some kind&gt; &amp; more"));
    let markdown = text(&folder, "report.md");
    assert!(markdown.starts_with(&format!("# {headline}")) && markdown.contains(slower));
    assert!(markdown.contains("![roulette](<images/roulette-one.png>)"));
    assert!(folder.join("figure.png").exists());
}

#[test]
fn an_accuracy_study_has_verdicts() {
    let folder = report("report-accuracy", &accuracy());
    let markdown = text(&folder, "report.md");
    assert!(markdown.starts_with(
        "# At equal time, wavelengths-4 has less error than baseline; wavelengths-8 has more. depth-4 has a bias that \
         no time removes."
    ), "{markdown}");
    assert!(markdown.contains("- wavelengths 4 (default): costs 21 % time, buys 9 % error."));
    assert!(markdown.contains("−3.10 % (biased) (−3.40 to −2.80)"));
    // Pairs of settings with each other are not what was asked.
    assert!(!markdown.contains("wavelengths-8 against wavelengths-4"));
}

#[test]
fn one_repetition_shows_no_difference() {
    let mut results = comparison();
    results.conditions.repetitions = 1;
    for pair in &mut results.pairs {
        pair.relative_efficiency.bounds = None;
        pair.finding = Finding::NoDifferenceShown;
    }
    let folder = report("report-single", &results);
    assert!(
        text(&folder, "report.md")
            .starts_with("# No difference can be shown from a single repetition.")
    );
}

#[test]
fn a_missing_image_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let error = write_report(&comparison(), folder.path()).unwrap_err();
    assert!(error.to_string().contains("roulette-one.png"), "{error}");
    assert!(!folder.path().join("index.html").exists());
}

#[test]
fn the_page_works_in_a_browser() {
    let browser = match Browser::start() {
        Ok(browser) => browser,
        Err(why) => return files::say_skipped("the_page_works_in_a_browser", &why),
    };
    let folder = report("report-page", &comparison());
    browser.look(1280, 900, false);
    browser.open(&folder.join("index.html"));
    let shots = [
        ("wide", 1280, false),
        ("narrow", 400, false),
        ("dark", 1280, true),
    ];
    for (name, width, dark) in shots {
        browser.look(width, 900, dark);
        let overflow = browser.value("document.documentElement.scrollWidth - innerWidth");
        assert!(
            overflow.as_f64().unwrap() <= 0.0,
            "{name} is {overflow} px too wide"
        );
        browser.screenshot(&folder.join(format!("{name}.png")));
    }
    browser.look(1280, 900, false);
    all_images_are_there(&browser);
    the_slider_moves(&browser);
    the_zoom_is_linked(&browser);
    browser.screenshot(&folder.join("zoomed.png"));

    let accuracy = report("report-accuracy-page", &accuracy());
    browser.open(&accuracy.join("index.html"));
    all_images_are_there(&browser);
    browser.screenshot(&accuracy.join("wide.png"));

    let requests = browser.requests();
    assert!(!requests.is_empty(), "the log does not even have the page");
    let foreign: Vec<_> = requests
        .iter()
        .filter(|url| !url.ends_with("/index.html"))
        .collect();
    assert!(foreign.is_empty(), "the page asked for {foreign:?}");
    let console = browser.console();
    assert!(console.is_empty(), "{console:?}");
}

fn all_images_are_there(browser: &Browser) {
    let broken = "[...document.images].filter(image => !image.naturalWidth || !image.alt).map(image => image.outerHTML.slice(0, 80))";
    assert_eq!(browser.value(broken), serde_json::json!([]));
}

fn the_slider_moves(browser: &Browser) {
    let split = "parseFloat(getComputedStyle(document.querySelector('.pane.right')).clipPath.split(' ').at(-1))";
    assert_eq!(browser.value(split), 50.0);
    browser.drag("#handle", 90, 0);
    let width = browser
        .value("document.querySelector('.split').clientWidth")
        .as_f64()
        .unwrap();
    let moved = browser.value(split).as_f64().unwrap();
    assert!(
        (moved - 50.0 - 9000.0 / width).abs() < 0.5,
        "{moved} of {width} px"
    );
    // The left arrow.
    browser.keys("#handle", "\u{e012}");
    assert!(browser.value(split).as_f64().unwrap() < moved - 1.0);
    // Another image on the right.
    let right = "document.getElementById('right-image').alt";
    assert_eq!(browser.value(right), "go-with-the-winners, one repetition");
    browser.keys("#right", "particle-filter");
    assert_eq!(browser.value(right), "particle-filter, one repetition");
}

fn the_zoom_is_linked(browser: &Browser) {
    let transforms = "[...new Set([...document.querySelectorAll('.layer')].map(layer => getComputedStyle(layer).transform.split(',')[0]))]";
    assert_eq!(browser.value(transforms), serde_json::json!(["matrix(1"]));
    browser.value("document.querySelector('.gallery .view').scrollIntoView({block: 'center'})");
    // Until the page has stopped scrolling.
    std::thread::sleep(std::time::Duration::from_millis(600));
    browser.wheel(".gallery .view", -100);
    browser.wheel(".gallery .view", -100);
    browser.wheel(".gallery .view", -100);
    browser.wheel(".gallery .view", -100);
    let zoomed = browser.value(transforms);
    let zoomed = zoomed.as_array().unwrap();
    assert_eq!(zoomed.len(), 1, "{zoomed:?}");
    assert_ne!(zoomed[0], "matrix(1");
    let place = "getComputedStyle(document.documentElement).getPropertyValue('--x')";
    let before: f64 = browser.value(place).as_str().unwrap().parse().unwrap();
    browser.drag(".gallery .view", 60, 0);
    let after: f64 = browser.value(place).as_str().unwrap().parse().unwrap();
    assert!(after > before + 0.05, "{before} to {after}");
    browser.keys(".gallery .view", "0");
    assert_eq!(browser.value(transforms), serde_json::json!(["matrix(1"]));
    browser.keys(".gallery .view", "+++++");
    assert_ne!(browser.value(transforms), serde_json::json!(["matrix(1"]));
}
