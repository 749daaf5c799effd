//! `cohort compare` and `cohort accuracy`: reports, equal budgets, interruption and resuming, mistakes.

mod cli_support;

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use cli_support::{Folder, SCENE, refused};
use cohort::study::results::{Finding, Results, StudyKind};

/// The built-in scene's file, small.
fn knot() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/cornell-knot.xml");
    path.display().to_string()
}

fn results(folder: &Path) -> Results {
    serde_json::from_slice(&fs::read(folder.join("results.json")).unwrap()).unwrap()
}

/// Runs `cohort SUBCOMMAND SCENE -o study` with a small image, a cheap reference and `more`.
fn study(folder: &Folder, subcommand: &str, more: &[&str]) -> std::process::Output {
    let scene = knot();
    let arguments = [
        subcommand, &scene, "-o", "study", "--size", "24x24", "--rgb",
    ];
    let mut command = folder.cohort(arguments.into_iter().chain(more.iter().copied()));
    command.timeout(Duration::from_secs(300)).output().unwrap()
}

#[test]
fn a_comparison_ends_in_a_report() {
    let folder = Folder::new();
    let output = study(
        &folder,
        "compare",
        &[
            "--strategies",
            "roulette,roulette:threshold=0.3,particle-filter:population=tile",
            "--spp",
            "32",
            "--repeat",
            "3",
            "--reference-spp",
            "256",
            "--metrics",
            "flip",
            "--crop",
            "3,4,8x8",
        ],
    );
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    assert!(!said.contains("rough"), "{said}");
    let study = folder.path().join("study");
    for file in [
        "index.html",
        "report.md",
        "results.csv",
        "results.json",
        "images/reference.exr",
    ] {
        assert!(study.join(file).is_file(), "{file}");
    }
    let results = results(&study);
    assert_eq!(results.kind, StudyKind::Compare);
    let names: Vec<&str> = results
        .competitors
        .iter()
        .map(|c| c.name.as_str())
        .collect();
    assert_eq!(
        names,
        [
            "roulette",
            "roulette:threshold=0.3",
            "particle-filter:population=tile"
        ]
    );
    assert_eq!(results.pairs.len(), 3);
    assert_eq!(
        results.reference.strategy.as_deref(),
        Some("throughput-roulette")
    );
    assert!(results.reference.variance.unwrap() > 0.0);
    assert_eq!((results.crops[0].x, results.crops[0].width), (3, 8));
    for competitor in &results.competitors {
        let at: Vec<f64> = competitor
            .snapshots
            .iter()
            .map(|snapshot| snapshot.at)
            .collect();
        assert_eq!(at, [1.0, 2.0, 4.0, 8.0, 16.0, 32.0]);
        let last = competitor.snapshots.last().unwrap();
        assert_eq!(last.camera_paths, 32.0 * 24.0 * 24.0);
        assert_eq!(last.repetitions.len(), 3);
        // 24x24 pixels of 32 samples: the error is some per cent, and falls as one over the number of samples.
        let error = last.errors.relative_mse;
        assert!(
            error.bounds.is_some() && (1e-3..1.0).contains(&error.estimate),
            "{error:?}"
        );
        // From 4 samples on: with fewer, rare bright samples in dark pixels decide about a relative error.
        let early = competitor.snapshots[2].errors.relative_mse.estimate;
        assert!(
            (2.0..32.0).contains(&(early / error.estimate)),
            "{early} {error:?}"
        );
        assert!(last.errors.flip.is_some());
        // The variance between repetitions is the same error, measured without any reference.
        let ratio = last.errors.variance.unwrap().all.estimate / last.errors.mse.estimate;
        assert!((0.3..3.0).contains(&ratio), "{ratio}");
        for image in [&competitor.images.exr, &competitor.images.error_png] {
            assert!(study.join(image).is_file(), "{image}");
        }
    }
}

#[test]
fn budgets_are_equal_within_one_per_cent() {
    // In rays: what a budget of time does depends on what else the machine does. The report says how equal it was.
    let folder = Folder::new();
    let strategies = "roulette,go-with-the-winners,particle-filter";
    let output = study(
        &folder,
        "compare",
        &[
            "--strategies",
            strategies,
            "--rays",
            "6000000",
            "--repeat",
            "1",
            "--reference-spp",
            "64",
        ],
    );
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    for competitor in &results(&folder.path().join("study")).competitors {
        for snapshot in &competitor.snapshots {
            let ratio = snapshot.rays.unwrap() / snapshot.at;
            // A batch has some thirty thousand rays.
            let allowed = 1.01_f64.max(1.0 + 60_000.0 / snapshot.at);
            assert!(
                (1.0..allowed).contains(&ratio),
                "{} {ratio}",
                competitor.name
            );
        }
    }
}

#[test]
fn an_interrupted_study_goes_on_and_finds_the_same() {
    let folder = Folder::new();
    folder.write("scene.xml", SCENE);
    let arguments = |output: &'static str| {
        let study = [
            "compare",
            "scene.xml",
            "--size",
            "32x32",
            "--rgb",
            "--strategies",
            "roulette,particle-filter",
        ];
        let amount = [
            "--spp",
            "4096",
            "--repeat",
            "2",
            "--reference-spp",
            "4096",
            "-o",
            output,
        ];
        study.into_iter().chain(amount)
    };
    let at_once = folder.cohort(arguments("whole")).output().unwrap();
    assert!(at_once.status.success());
    let mut interruptions = 0;
    let mut patience = Duration::from_millis(250);
    loop {
        let mut child = Command::new(assert_cmd::cargo::cargo_bin!("cohort"))
            .current_dir(folder.path())
            .args(arguments("parts"))
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(patience);
        // The shell's own `kill`: a minimal Debian has no program of this name. The study may have ended by itself.
        let _ = Command::new("sh")
            .args(["-c", "kill -INT \"$0\"", &child.id().to_string()])
            .stderr(Stdio::null())
            .status();
        match child.wait().unwrap().code() {
            Some(130) => interruptions += 1,
            Some(0) => break,
            // The signal came before anybody listened.
            None => {}
            code => panic!("{code:?}"),
        }
        // However slow the machine is, one attempt will be long enough.
        patience = patience * 5 / 4;
    }
    println!("interrupted {interruptions} times");
    assert!(interruptions > 0, "it was never interrupted");
    let whole = results(&folder.path().join("whole"));
    let parts = results(&folder.path().join("parts"));
    for (whole, parts) in whole.competitors.iter().zip(&parts.competitors) {
        for (whole, parts) in whole.snapshots.iter().zip(&parts.snapshots) {
            assert_eq!(whole.repetitions, parts.repetitions);
            assert_eq!(whole.rays, parts.rays);
        }
    }
}

#[test]
fn settings_are_compared_with_the_default() {
    let folder = Folder::new();
    let output = study(
        &folder,
        "accuracy",
        &[
            "--settings",
            "max-depth,sums,direct",
            "--spp",
            "32",
            "--repeat",
            "3",
            "--reference-spp",
            "512",
        ],
    );
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let results = results(&folder.path().join("study"));
    assert_eq!(results.kind, StudyKind::Accuracy);
    assert_eq!(results.competitors[0].name, "default");
    assert!(results.competitors[0].verdict.is_none());
    let verdict = |name: &str| {
        let competitor = results
            .competitors
            .iter()
            .find(|competitor| competitor.name == name);
        competitor.unwrap().verdict.clone().unwrap()
    };
    // Direct light alone is less than half of what the box reflects.
    let short = verdict("max-depth=2");
    assert!(short.biased && short.bias.estimate < -0.05, "{short:?}");
    assert!(!verdict("sums=compensated").biased);
    // Without next-event estimation the small lamp is hit by chance.
    assert!(verdict("direct=off").error_at_equal_time.estimate > 1.5);
}

#[test]
fn mistakes_are_told_before_any_time_is_spent() {
    let folder = Folder::new();
    let refusal = |more: &[&str]| refused(&study(&folder, "compare", more));
    assert!(refusal(&["--strategies", "rulette"]).contains("rulette"));
    assert!(
        refusal(&["--strategies", "roulette,roulette"]).contains("`roulette` takes part twice")
    );
    assert!(refusal(&["--strategies", "roulette:n-max=2"]).contains("n-max"));
    assert!(
        refusal(&["--strategies", "roulette", "--crop", "20,20,8x8"])
            .contains("not inside of the image")
    );
    assert!(refusal(&["--strategies", "roulette", "--crop", "20,20"]).contains("X,Y,WxH"));
    assert!(refusal(&["--strategies", "roulette", "--reference", "none.exr"]).contains("none.exr"));
    assert!(
        refusal(&["--strategies", "roulette", "--peer", "povray"])
            .contains("unknown peer `povray`")
    );
    assert!(
        refusal(&[
            "--strategies",
            "roulette",
            "--peer",
            "mitsuba",
            "--rays",
            "1000"
        ])
        .contains("does not count its rays")
    );
    assert!(!folder.path().join("study/index.html").exists());
}

#[test]
fn a_folder_with_another_study_is_left_alone() {
    let folder = Folder::new();
    let with = |spp: &'static str| {
        study(
            &folder,
            "compare",
            &[
                "--strategies",
                "roulette",
                "--spp",
                spp,
                "--repeat",
                "1",
                "--reference-spp",
                "8",
            ],
        )
    };
    let output = with("4");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    assert!(said.contains("The reference is rough"), "{said}");
    let before = fs::read(folder.path().join("study/results.json")).unwrap();
    assert!(refused(&with("5")).contains("another study"));
    assert_eq!(
        fs::read(folder.path().join("study/results.json")).unwrap(),
        before
    );
    // The same again finds it complete.
    assert!(with("4").status.success());
    let results = results(&folder.path().join("study"));
    assert!(
        results
            .pairs
            .iter()
            .all(|pair| pair.finding == Finding::NoDifferenceShown)
    );
}
