//! Arguments that cannot be: each is refused at once, and says what would be right.

mod cli_support;

use cli_support::{Folder, SCENE, refused, with};

/// What is said of a good scene with `arguments`.
fn refusal<'a>(arguments: impl IntoIterator<Item = &'a str>) -> String {
    Folder::new().refusal(SCENE, arguments)
}

#[test]
fn numbers_out_of_range() {
    for (option, value, message) in [
        (
            "--spp",
            "0",
            "it must be a whole number from 1 to 4294967295",
        ),
        ("--spp", "99999999999", "from 1 to 4294967295"),
        ("--spp", "many", "from 1 to 4294967295"),
        ("--max-depth", "0", "from 1 to 4294967295"),
        ("--rays", "0", "from 1 to 18446744073709551615"),
        ("--seed", "1.5", "from 0 to 18446744073709551615"),
        ("--time", "0s", "the time must be longer than 0"),
        ("--time", "5", "written with units, such as 90s"),
        ("--time", "99999999999999999999y", "--time"),
        (
            "--size",
            "0x10",
            "the film is 0 x 10 pixels; each side must be from 1 to 65536",
        ),
        (
            "--size",
            "100000x100000",
            "each side must be from 1 to 65536",
        ),
        (
            "--size",
            "99999999999999999999x1",
            "a size is written WxH, such as 800x600",
        ),
        ("--size", "10", "a size is written WxH, such as 800x600"),
        ("--wavelengths", "3", "1, 4, 8"),
        ("--sums", "half", "single, double, compensated"),
        ("--direct", "on", "next-event"),
        ("--build-quality", "best", "high"),
        ("--strategy", "rullette", "go-with-the-winners"),
        ("--nonsense", "1", "--nonsense"),
    ] {
        let said = refusal([option, value]);
        assert!(said.contains(message), "{option} {value}: {said}");
    }
    for budgets in [
        ["--spp", "4", "--time", "1s"],
        ["--spp", "4", "--rays", "9"],
        ["--time", "1s", "--rays", "9"],
    ] {
        assert!(refusal(budgets).contains("cannot be used with"));
    }
    assert!(refusal(["--rgb", "--wavelengths", "4"]).contains("cannot be used with"));
}

#[test]
fn threads() {
    let folder = Folder::new();
    folder.write("scene.xml", SCENE);
    let refusal = |threads: &str| {
        let arguments = ["render", "scene.xml", "--threads", threads];
        refused(&folder.cohort(arguments).output().unwrap())
    };
    assert!(refusal("0").contains("it must be a whole number from 1 to 1024"));
    for absurd in ["1025", "18446744073709551615"] {
        assert_eq!(
            refusal(absurd),
            format!("cohort: {absurd} threads are too many; there can be from 1 to 1024")
        );
    }
}

#[test]
fn an_image_larger_than_memory() {
    // 4.3 thousand million pixels: more than half a tebibyte.
    let said = refusal(["--size", "65536x65536"]);
    assert!(
        said.starts_with("cohort: an image of 65536 x 65536 pixels needs 4"),
        "{said}"
    );
}

#[test]
fn settings_that_do_not_fit_the_strategy() {
    for (arguments, message) in [
        (
            ["--strategy", "roulette", "--n-max", "4"],
            "the strategy `roulette` has no setting `n-max`; it has threshold, termination",
        ),
        (
            ["--strategy", "particle-filter", "--threshold", "0.1"],
            "the strategy `particle-filter` has no setting `threshold`; it has rule, objective, n-max, population, counts",
        ),
        (
            ["--strategy", "go-with-the-winners", "--n-max", "0"],
            "the strategy `go-with-the-winners` cannot have n-max = 0: it must be positive and at most 1024",
        ),
        (
            ["--strategy", "go-with-the-winners", "--n-max", "1025"],
            "the strategy `go-with-the-winners` cannot have n-max = 1025: it must be positive and at most 1024",
        ),
        (
            ["--strategy", "particle-filter", "--n-max", "NaN"],
            "the strategy `particle-filter` cannot have n-max = NaN: it must be positive and at most 1024",
        ),
        (
            ["--strategy", "roulette", "--termination", "1"],
            "the strategy `roulette` cannot have termination = 1: it must be at least 0 and below 1",
        ),
    ] {
        assert_eq!(refusal(arguments), format!("cohort: {message}"));
    }
    let said = refusal(["--strategy", "particle-filter", "--counts", "fair"]);
    assert!(said.contains("systematic"), "{said}");
    let said = refusal(["--strategy", "particle-filter", "--population", "particle"]);
    assert!(said.contains("camera-path, pixel, tile"), "{said}");
    // The scene is not even looked at.
    let folder = Folder::new();
    let arguments = ["render", "missing.xml", "--threshold", "0.2"];
    let said = refused(&folder.cohort(arguments).output().unwrap());
    assert!(
        said.contains("the strategy `particle-filter` has no setting `threshold`"),
        "{said}"
    );
}

#[test]
fn settings_that_do_not_fit_the_scene() {
    assert_eq!(
        refusal(["--strategy", "fixed-depth"]),
        "cohort: the strategy `fixed-depth` never ends a path, so it needs a maximal depth (`--max-depth` or \
         `max_depth` of the integrator)"
    );
    let point = with(SCENE, r#"type="constant""#, r#"type="point""#);
    assert_eq!(
        Folder::new().refusal(&point, ["--direct", "off"]),
        "cohort: the scene has a light without extent (`point`, `spot` or `directional`), which paths cannot hit: \
         it needs next-event estimation (`--direct next-event`)"
    );
}

#[test]
fn places_where_no_image_can_be_written() {
    let folder = Folder::new();
    folder.write("scene.xml", SCENE);
    folder.write("file", "");
    std::fs::create_dir(folder.path().join("folder")).unwrap();
    std::fs::create_dir(folder.path().join("folder.exr")).unwrap();
    for (output, message) in [
        (
            "missing/a.exr",
            "cannot write missing/a.exr: its folder does not exist",
        ),
        ("file/a.exr", "cannot write file/a.exr: "),
        (
            "folder",
            "folder: this is a folder; name a file in it that ends in .exr",
        ),
        (
            "folder.exr",
            "folder.exr: this is a folder; name a file in it that ends in .exr",
        ),
        ("folder/", "folder/: this is a folder"),
        ("/", "/: this is a folder"),
        ("", "a value is required"),
        (
            "a.png",
            "a.png: an image is written as EXR with a PNG beside it; name a file that ends in .exr",
        ),
        ("a.exr.gz", "name a file that ends in .exr"),
        ("/proc/a.exr", "cannot write /proc/a.exr: "),
    ] {
        let arguments = ["render", "scene.xml", "-o", output];
        let said = refused(&folder.cohort(arguments).output().unwrap());
        assert!(said.contains(message), "{output}: {said}");
    }
}

/// Skipped for users whom no permission stops, such as root.
#[cfg(unix)]
#[test]
fn a_folder_that_may_not_be_written() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new();
    folder.write("scene.xml", SCENE);
    let locked = folder.path().join("locked");
    std::fs::create_dir(&locked).unwrap();
    std::fs::set_permissions(&locked, std::fs::Permissions::from_mode(0o500)).unwrap();
    if std::fs::write(locked.join("probe"), "").is_ok() {
        return;
    }
    let arguments = ["render", "scene.xml", "-o", "locked/a.exr"];
    let said = refused(&folder.cohort(arguments).output().unwrap());
    assert!(said.contains("Permission denied"), "{said}");
}

#[test]
fn a_command_is_needed() {
    let folder = Folder::new();
    for arguments in [&[][..], &["rander"], &["render", "a.xml", "b.xml"]] {
        let said = refused(&folder.cohort(arguments.iter().copied()).output().unwrap());
        assert!(said.contains("Usage"), "{said}");
    }
}
