//! What `cohort render` makes.

mod cli_support;

use std::collections::HashMap;
use std::path::Path;

use cli_support::{Folder, SCENE, with};
use exr::prelude::{AttributeValue, MetaData, SampleType};

/// The attributes of an EXR that are Cohort's, without the prefix.
fn metadata(path: &Path) -> HashMap<String, String> {
    let meta = MetaData::read_from_file(path, false).unwrap();
    let attributes = &meta.headers[0].own_attributes.other;
    let ours = attributes.iter().filter_map(|(name, value)| {
        let name = name.to_string();
        match value {
            AttributeValue::Text(text) => {
                Some((name.strip_prefix("cohort:")?.to_owned(), text.to_string()))
            }
            _ => None,
        }
    });
    ours.collect()
}

/// The pixels of the scene rendered with `arguments`, as bits.
fn pixels<'a>(arguments: impl IntoIterator<Item = &'a str>) -> Vec<[u32; 3]> {
    let folder = Folder::new();
    let output = folder.render(SCENE, arguments);
    assert!(output.status.success(), "{output:?}");
    let image = cohort::read_exr(&folder.path().join("out.exr")).unwrap();
    let bits = image.pixels().iter().map(|pixel| pixel.map(f32::to_bits));
    bits.collect()
}

/// Two renders of the same pixels by other seeds differ by what both say of their variance.
#[test]
fn the_variance_is_written_where_it_is_asked_for() {
    let folder = Folder::new();
    let out = folder.path().join("out.exr");
    let render = |spp, seed| {
        let arguments = ["--strategy", "roulette", "--spp", spp, "--seed", seed];
        let output = folder.render(SCENE, arguments.iter().chain(&["--variance"]).copied());
        assert!(output.status.success(), "{output:?}");
        let variance = cohort::film::read_exr_variance(&out).unwrap();
        (cohort::read_exr(&out).unwrap(), variance, output.stderr)
    };
    let (_, nothing, warning) = render("1", "1");
    assert_eq!(nothing, None);
    let warning = String::from_utf8(warning).unwrap();
    assert!(warning.contains("no variance is written"), "{warning}");

    let [(one, of_one, quiet), (other, of_other, _)] = ["1", "2"].map(|seed| render("64", seed));
    assert!(quiet.is_empty());
    let mean = |image: &cohort::film::Image| image.mean()[1];
    let believed = mean(&of_one.unwrap()) + mean(&of_other.unwrap());
    let pixels = one.pixels().iter().zip(other.pixels());
    let squares: Vec<f64> = pixels
        .map(|(one, other)| f64::from(one[1] - other[1]).powi(2))
        .collect();
    let seen = squares.iter().sum::<f64>() / squares.len() as f64;
    assert!((0.5..2.0).contains(&(seen / believed)), "{seen} {believed}");
}

#[test]
fn the_built_in_scene() {
    let folder = Folder::new();
    let arguments = [
        "render",
        "-D",
        "res=24",
        "--spp",
        "2",
        "--threads",
        "2",
        "--seed",
        "7",
    ];
    let output = folder.cohort(arguments).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    assert!(output.stderr.is_empty(), "{output:?}");
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(
        said.starts_with("cornell-knot.exr\ncornell-knot.png\n"),
        "{said}"
    );
    assert!(
        said.contains("complete") && said.contains("peak memory"),
        "{said}"
    );

    let exr = folder.path().join("cornell-knot.exr");
    let meta = MetaData::read_from_file(&exr, false).unwrap();
    let header = &meta.headers[0];
    let channels: Vec<_> = header
        .channels
        .list
        .iter()
        .map(|channel| (channel.name.to_string(), channel.sample_type))
        .collect();
    let float = |name: &str| (name.to_owned(), SampleType::F32);
    assert_eq!(channels, [float("B"), float("G"), float("R")]);
    let software = header.own_attributes.software_name.as_ref().unwrap();
    assert_eq!(
        software.to_string(),
        concat!("cohort ", env!("CARGO_PKG_VERSION"))
    );

    let metadata = metadata(&exr);
    for (name, value) in [
        ("scene", "built-in cornell-knot.xml"),
        ("strategy", "particle-filter"),
        ("strategy.rule", "learned"),
        ("sampler", "array-qmc"),
        ("guiding", "on"),
        ("adaptive", "off"),
        ("colour", "spectral, 4 wavelengths a path"),
        ("film-sums", "double"),
        ("direct-light", "next-event"),
        ("max-depth", "unlimited"),
        ("robust", "false"),
        ("build-quality", "low"),
        ("seed", "7"),
        ("threads", "2"),
        ("samples", "2"),
        ("camera-paths", "1152"),
        ("ended", "complete"),
        ("version", env!("CARGO_PKG_VERSION")),
        ("dropped.nan", "0"),
    ] {
        assert_eq!(metadata[name], value, "{name}");
    }
    assert!(metadata["rays"].parse::<u64>().unwrap() > 1152);
    assert!(metadata["seconds"].parse::<f64>().unwrap() > 0.0);
    assert!(!metadata["cpu"].is_empty());
    assert_eq!(
        metadata["embree"],
        cohort::embree::version().unwrap().to_string()
    );

    // The lamp is in the upper middle, and the walls are red at the left and green at the right.
    let image = cohort::read_exr(&exr).unwrap();
    let [left, right] = [image.pixel(1, 12), image.pixel(22, 12)];
    assert!(
        left[0] > left[1] && right[1] > right[0],
        "{left:?} {right:?}"
    );
    let brightest = (0..24).map(|y| image.pixel(12, y)[1]).fold(0.0, f32::max);
    assert!(brightest > 5.0, "{brightest}");

    let png = std::fs::File::open(folder.path().join("cornell-knot.png")).unwrap();
    let png = png::Decoder::new(std::io::BufReader::new(png))
        .read_info()
        .unwrap();
    assert_eq!(png.info().size(), (24, 24));
}

#[test]
fn the_same_command_gives_the_same_bits() {
    let once = pixels([]);
    assert_eq!(once, pixels([]));
    assert_eq!(once, pixels(["--seed", "0", "--spp", "2"]));
    assert_ne!(once, pixels(["--seed", "1"]));
    assert_ne!(once, pixels(["--spp", "3"]));
    assert_ne!(once, pixels(["--rgb"]));
    assert_eq!(once, pixels(["--wavelengths", "4"]));
    assert_ne!(once, pixels(["--wavelengths", "1"]));
    assert_ne!(once, pixels(["--wavelengths", "8"]));
    assert_ne!(once, pixels(["--direct", "off"]));
    assert_eq!(pixels(["--size", "3x5"]).len(), 15);
}

#[test]
fn the_greatest_depth_is_obeyed() {
    // The sphere is convex: emission alone, then direct light.
    let center = |depth| pixels(["--max-depth", depth])[4 * 8 + 4];
    assert_eq!(center("1"), [0.0_f32.to_bits(); 3]);
    assert_ne!(center("2"), [0.0_f32.to_bits(); 3]);
}

#[test]
fn intersection_options_leave_the_image_as_it_is() {
    let folder = Folder::new();
    let render = |more: &[&str]| {
        let arguments = [
            "render",
            "-D",
            "res=16",
            "--spp",
            "1",
            "--max-depth",
            "1",
            "-o",
            "a.exr",
        ];
        let output = folder
            .cohort(arguments.iter().chain(more).copied())
            .output()
            .unwrap();
        assert!(output.status.success(), "{output:?}");
        let path = folder.path().join("a.exr");
        (metadata(&path), cohort::read_exr(&path).unwrap())
    };
    let (_, plain) = render(&[]);
    for quality in ["low", "medium", "high"] {
        let (metadata, image) = render(&["--build-quality", quality, "--robust"]);
        assert_eq!(metadata["build-quality"], quality);
        assert_eq!(metadata["robust"], "true");
        assert_eq!(image, plain);
    }
}

/// What does best together is the default; a strategy that is named comes alone.
#[test]
fn a_named_strategy_has_no_sampler_and_no_guiding_by_default() {
    for (arguments, sampler, guiding) in [
        (&["--rgb"][..], "array-qmc", "on"),
        (&["--guiding", "off"], "array-qmc", "off"),
        (&["--sampler", "sobol"], "sobol", "on"),
        (&["--strategy", "particle-filter"], "independent", "off"),
        (
            &["--strategy", "ears", "--guiding", "on"],
            "independent",
            "on",
        ),
    ] {
        let folder = Folder::new();
        let output = folder.render(SCENE, arguments.iter().copied());
        assert!(output.status.success(), "{output:?}");
        let metadata = metadata(&folder.path().join("out.exr"));
        assert_eq!(metadata["sampler"], sampler, "{arguments:?}");
        assert_eq!(metadata["guiding"], guiding, "{arguments:?}");
    }
}

#[test]
fn adaptive_renders_say_how_many_samples_pixels_have() {
    let folder = Folder::new();
    let output = folder.render(SCENE, ["--spp", "64", "--adaptive", "on"]);
    assert!(output.status.success(), "{output:?}");
    let metadata = metadata(&folder.path().join("out.exr"));
    assert_eq!(metadata["adaptive"], "on");
    let (fewest, most) = metadata["samples"].split_once(" to ").unwrap();
    let [fewest, most] = [fewest, most].map(|count| count.parse::<u32>().unwrap());
    assert!(0 < fewest && fewest < 64 && 64 < most, "{fewest} to {most}");
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.contains("64.00 samples per pixel"), "{said}");
}

#[test]
fn every_strategy_and_all_its_settings() {
    for (arguments, name, settings) in [
        (
            &["--strategy", "fixed-depth", "--max-depth", "3"][..],
            "fixed-depth",
            &[][..],
        ),
        (
            &[
                "--strategy",
                "roulette",
                "--threshold",
                "0.25",
                "--termination",
                "0.75",
            ],
            "roulette",
            &[("threshold", "0.25"), ("termination", "0.75")],
        ),
        (
            &["--strategy", "throughput-roulette"],
            "throughput-roulette",
            &[("from-depth", "5")],
        ),
        (
            &["--strategy", "throughput-roulette", "--from-depth", "2"],
            "throughput-roulette",
            &[("from-depth", "2")],
        ),
        (
            &["--strategy", "go-with-the-winners", "--n-max", "2.5"],
            "go-with-the-winners",
            &[("n-max", "2.5")],
        ),
        (
            &[
                "--strategy",
                "particle-filter",
                "--n-max",
                "2",
                "--population",
                "tile",
                "--counts",
                "residual",
            ],
            "particle-filter",
            &[
                ("rule", "importance"),
                ("n-max", "2"),
                ("population", "tile"),
                ("counts", "residual"),
            ],
        ),
        (
            &[
                "--strategy",
                "particle-filter",
                "--population",
                "camera-path",
                "--counts",
                "stratified",
            ],
            "particle-filter",
            &[
                ("rule", "learned"),
                ("objective", "relative"),
                ("population", "camera-path"),
                ("counts", "stratified"),
            ],
        ),
        (
            &["--strategy", "paper-particle-filter"],
            "particle-filter",
            &[
                ("rule", "importance"),
                ("n-max", "10"),
                ("population", "camera-path"),
                ("counts", "multinomial"),
            ],
        ),
    ] {
        let folder = Folder::new();
        let output = folder.render(SCENE, arguments.iter().copied());
        assert!(output.status.success(), "{output:?}");
        let metadata = metadata(&folder.path().join("out.exr"));
        assert_eq!(metadata["strategy"], name);
        let count = metadata
            .keys()
            .filter(|key| key.starts_with("strategy."))
            .count();
        assert_eq!(count, settings.len(), "{metadata:?}");
        for (setting, value) in settings {
            assert_eq!(metadata[&format!("strategy.{setting}")], *value);
        }
    }
}

#[test]
fn what_the_scene_says_counts_unless_an_option_says_otherwise() {
    let scene = with(
        SCENE,
        r#"<integrator type="path"/>"#,
        r#"<integrator type="path"><integer name="max_depth" value="7"/><integer name="rr_depth" value="3"/></integrator>"#,
    );
    let scene = with(
        &scene,
        r#"value="2"/>"#,
        r#"value="2"/><integer name="seed" value="9"/>"#,
    );
    let folder = Folder::new();
    let of = |more: &[&str]| {
        let arguments = ["--strategy", "throughput-roulette"].iter().chain(more);
        let output = folder.render(&scene, arguments.copied());
        assert!(output.status.success(), "{output:?}");
        let metadata = metadata(&folder.path().join("out.exr"));
        ["max-depth", "seed", "samples", "strategy.from-depth"].map(|name| metadata[name].clone())
    };
    assert_eq!(of(&[]), ["7", "9", "2", "3"]);
    assert_eq!(
        of(&[
            "--max-depth",
            "4",
            "--seed",
            "1",
            "--spp",
            "5",
            "--from-depth",
            "2"
        ]),
        ["4", "1", "5", "2"]
    );
}

#[test]
fn black_images_come_with_a_warning() {
    let folder = Folder::new();
    let dark = with(SCENE, "<emitter type=\"constant\"/>\n", "");
    for scene in [
        &dark,
        &with(
            &dark,
            r#"<shape type="sphere"><bsdf type="diffuse"/></shape>"#,
            "",
        ),
    ] {
        let output = folder.render(scene, []);
        assert!(output.status.success(), "{output:?}");
        assert_eq!(
            String::from_utf8(output.stderr).unwrap(),
            "cohort: warning: the scene has no emitter, so the image will be black\n"
        );
        let image = cohort::read_exr(&folder.path().join("out.exr")).unwrap();
        assert_eq!(image.mean(), [0.0; 3]);
    }
}

#[test]
fn a_scene_without_shapes_shows_its_surroundings() {
    let sky = with(
        SCENE,
        r#"<shape type="sphere"><bsdf type="diffuse"/></shape>"#,
        "",
    );
    let folder = Folder::new();
    let output = folder.render(&sky, ["--rgb"]);
    assert!(
        output.status.success() && output.stderr.is_empty(),
        "{output:?}"
    );
    let image = cohort::read_exr(&folder.path().join("out.exr")).unwrap();
    assert!(
        image
            .pixels()
            .iter()
            .flatten()
            .all(|value| (value - 1.0).abs() < 1e-5),
        "{image:?}"
    );
}

#[test]
fn images_are_named_after_the_scene() {
    let folder = Folder::new();
    folder.write("my.scene.xml", SCENE);
    let output = folder.cohort(["render", "my.scene.xml"]).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    assert!(folder.path().join("my.scene.exr").exists());
    assert!(folder.path().join("my.scene.png").exists());
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 3);
}

#[test]
fn films_can_be_half_precision_and_luminance() {
    let scene = with(
        SCENE,
        r#"<rfilter type="box"/>"#,
        r#"<rfilter type="box"/><string name="component_format" value="float16"/><string name="pixel_format" value="luminance"/>"#,
    );
    let folder = Folder::new();
    assert!(folder.render(&scene, []).status.success());
    let meta = MetaData::read_from_file(folder.path().join("out.exr"), false).unwrap();
    let channels = &meta.headers[0].channels.list;
    assert_eq!(channels.len(), 1);
    assert_eq!(
        (
            channels[0].name.to_string().as_str(),
            channels[0].sample_type
        ),
        ("Y", SampleType::F16)
    );
}

#[test]
fn moments_have_mitsubas_channels() {
    let moment = |name: &str| {
        let nested =
            format!(r#"<integrator type="moment"><integrator type="path"{name}/></integrator>"#);
        with(SCENE, r#"<integrator type="path"/>"#, &nested)
    };
    // `[field.name for field in film.bitmap(raw=False).struct_()]` of Mitsuba 3.9.1
    for (name, called) in [("", "_arg_0"), (r#" name="inner""#, "inner")] {
        let folder = Folder::new();
        let output = folder.render(&moment(name), []);
        assert!(output.status.success(), "{output:?}");
        let meta = MetaData::read_from_file(folder.path().join("out.exr"), false).unwrap();
        let channels = meta.headers[0].channels.list.iter();
        let mut names: Vec<String> = channels.map(|channel| channel.name.to_string()).collect();
        names.sort();
        let mut expected = ["R", "G", "B"].map(str::to_owned).to_vec();
        for axis in ["X", "Y", "Z"] {
            expected.extend([format!("{called}.{axis}"), format!("m2_{called}.{axis}")]);
        }
        expected.sort();
        assert_eq!(names, expected);
        let plain = Folder::new();
        assert!(plain.render(SCENE, []).status.success());
        let image = |folder: &Folder| cohort::read_exr(&folder.path().join("out.exr")).unwrap();
        assert_eq!(image(&folder), image(&plain));
    }
}

#[test]
fn help_and_version() {
    let folder = Folder::new();
    let say = |arguments: &[&str]| {
        let output = folder.cohort(arguments.iter().copied()).output().unwrap();
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    let help = say(&["render", "--help"]);
    for option in [
        "--output",
        "--strategy",
        "--spp",
        "--time",
        "--rays",
        "--threads",
        "--seed",
        "--size",
        "--rgb",
        "--wavelengths",
        "--sums",
        "--models",
        "--direct",
        "--max-depth",
        "--robust",
        "--build-quality",
        "--threshold",
        "--termination",
        "--from-depth",
        "--n-max",
        "--population",
        "--counts",
        "-D <NAME=VALUE>",
    ] {
        assert!(help.contains(option), "{option} in {help}");
    }
    let version = say(&["--version"]);
    assert!(
        version.starts_with(concat!("cohort ", env!("CARGO_PKG_VERSION"), " (Embree ")),
        "{version}"
    );
}
