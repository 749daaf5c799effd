//! How `cohort render` behaves while it runs: budgets of time and rays, interruption, threads, memory, closed pipes.
#![cfg(target_os = "linux")]

mod cli_support;

use std::fs::{self, File};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use cli_support::{Folder, SCENE};

/// The program, started in `folder` and left running.
fn start(folder: &Folder, arguments: &[&str]) -> Child {
    Command::new(assert_cmd::cargo::cargo_bin!("cohort"))
        .current_dir(folder.path())
        .args(["render", "-D", "res=48", "-o", "out.exr"])
        .args(arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// The processor time in clock ticks and the name of every thread of a process.
fn threads(process: u32) -> Vec<(u64, String)> {
    let Ok(tasks) = fs::read_dir(format!("/proc/{process}/task")) else {
        return Vec::new();
    };
    let thread = |task: std::io::Result<fs::DirEntry>| {
        let stat = fs::read_to_string(task.ok()?.path().join("stat")).ok()?;
        let (name, rest) = stat.rsplit_once(") ")?;
        let fields: Vec<&str> = rest.split(' ').collect();
        // Fields 14 and 15 of proc_pid_stat(5), counted from 1; `rest` begins with field 3.
        let ticks = fields[11].parse::<u64>().ok()? + fields[12].parse::<u64>().ok()?;
        Some((ticks, name.to_owned()))
    };
    tasks.filter_map(thread).collect()
}

fn is_renderer((ticks, name): &(u64, String)) -> bool {
    name.contains("(render ") && *ticks > 5
}

/// Waits until the process has been rendering for a while and listens to Ctrl-C.
fn wait_until_rendering(child: &Child) {
    let start = Instant::now();
    loop {
        let threads = threads(child.id());
        let listens = threads.iter().any(|(_, name)| name.contains("(ctrl-c"));
        if listens && threads.iter().any(is_renderer) {
            return;
        }
        assert!(start.elapsed() < Duration::from_secs(60), "{threads:?}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

fn interrupt(child: &Child) {
    // The shell's own `kill`: a minimal Debian has no program of this name.
    let status = Command::new("sh")
        .args(["-c", "kill -INT \"$0\"", &child.id().to_string()])
        .status();
    assert!(status.unwrap().success());
}

fn attribute(folder: &Folder, name: &str) -> String {
    let meta = exr::meta::MetaData::read_from_file(folder.path().join("out.exr"), false).unwrap();
    let name = exr::meta::attribute::Text::from(name);
    match &meta.headers[0].own_attributes.other[&name] {
        exr::meta::attribute::AttributeValue::Text(text) => text.to_string(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn an_interrupted_render_writes_what_there_is() {
    let folder = Folder::new();
    let child = start(&folder, &["--spp", "100000000"]);
    wait_until_rendering(&child);
    interrupt(&child);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{output:?}");
    assert!(
        String::from_utf8_lossy(&output.stderr).contains("stopping; what there is will be written")
    );
    assert!(String::from_utf8_lossy(&output.stdout).contains("interrupted"));
    assert_eq!(attribute(&folder, "cohort:ended"), "interrupted");
    let image = cohort::read_exr(&folder.path().join("out.exr")).unwrap();
    assert!(
        image.mean().iter().all(|&mean| mean > 0.01),
        "{:?}",
        image.mean()
    );
    assert!(folder.path().join("out.png").exists());
    // No partial file is left.
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
}

#[test]
fn an_interrupted_render_goes_on_from_its_checkpoint() {
    let arguments = ["--spp", "512", "--threads", "2"];
    let at_once = Folder::new();
    let output = start(&at_once, &arguments).wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{output:?}");

    let folder = Folder::new();
    let kept = [&arguments[..], &["--checkpoint", "out.checkpoint"]].concat();
    let child = start(&folder, &kept);
    wait_until_rendering(&child);
    interrupt(&child);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{output:?}");
    let output = start(&folder, &kept).wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("going on from out.checkpoint"), "{said}");
    assert_eq!(attribute(&folder, "cohort:samples"), "512");
    let image = |folder: &Folder| cohort::read_exr(&folder.path().join("out.exr")).unwrap();
    assert!(image(&folder) == image(&at_once), "the image is another");

    let other = [&kept[..], &["--seed", "5"]].concat();
    let output = start(&folder, &other).wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(
        said.contains("out.checkpoint is of another render"),
        "{said}"
    );
    let itself = [&arguments[..], &["--checkpoint", "out.exr"]].concat();
    let output = start(&folder, &itself).wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{output:?}");
}

#[test]
fn a_budget_of_time_is_kept() {
    let folder = Folder::new();
    let output = start(&folder, &["--time", "2s"])
        .wait_with_output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let seconds: f64 = attribute(&folder, "cohort:seconds").parse().unwrap();
    // Generous: other programs may want the processor, too.
    assert!((1.5..4.0).contains(&seconds), "{seconds}");
    assert_eq!(attribute(&folder, "cohort:ended"), "out of time");
    assert!(!attribute(&folder, "cohort:samples").starts_with("0 "));
}

#[test]
fn a_budget_of_rays_is_kept() {
    let folder = Folder::new();
    let output = start(&folder, &["--rays", "100000", "--threads", "1"])
        .wait_with_output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let rays: u64 = attribute(&folder, "cohort:rays").parse().unwrap();
    // A batch of 256 pixels, eight samples each, has some ten rays per sample.
    assert!((100_000..150_000).contains(&rays), "{rays}");
    assert_eq!(attribute(&folder, "cohort:ended"), "out of rays");
}

#[test]
fn too_short_a_time_is_told() {
    let folder = Folder::new();
    let output = start(&folder, &["--time", "1ns"])
        .wait_with_output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(
        said,
        "cohort: warning: 2304 pixels are black because the render ended before their first sample\n"
    );
    assert_eq!(attribute(&folder, "cohort:samples"), "0");
}

/// Beside the threads that render there are the main thread, which waits for them, the one that waits for Ctrl-C, and
/// those with which Embree has built its structure if there may be more than one.
#[test]
fn one_thread_is_one_thread() {
    for count in [1, 2] {
        let folder = Folder::new();
        let mut child = start(&folder, &["--time", "60s", "--threads", &count.to_string()]);
        wait_until_rendering(&child);
        std::thread::sleep(Duration::from_millis(500));
        let threads = threads(child.id());
        child.kill().unwrap();
        child.wait().unwrap();
        let all = if count == 1 { 3..=3 } else { 4..=5 };
        assert!(all.contains(&threads.len()), "{threads:?}");
        let busy = threads.iter().filter(|thread| is_renderer(thread)).count();
        assert_eq!(busy, count, "{threads:?}");
    }
}

#[test]
fn memory_does_not_grow_with_the_samples() {
    let peak = |spp: &str| -> f64 {
        let folder = Folder::new();
        let output = start(&folder, &["--spp", spp, "--threads", "1"])
            .wait_with_output()
            .unwrap();
        let said = String::from_utf8(output.stdout).unwrap();
        let (_, after) = said.split_once("peak memory ").unwrap();
        after.split_once(" MiB").unwrap().0.parse().unwrap()
    };
    // Passes are as large as they get in both. One number kept of each sample would take 16 MiB more.
    let (few, many) = (peak("256"), peak("2048"));
    assert!(many < few + 8.0, "{few} MiB, then {many} MiB");
}

#[test]
fn nobody_has_to_listen() {
    let folder = Folder::new();
    let scene = folder.write("scene.xml", SCENE);
    for stream in ["stdout", "stderr"] {
        let full = || Stdio::from(File::options().write(true).open("/dev/full").unwrap());
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("cohort"));
        command.arg("render").arg(&scene).current_dir(folder.path());
        match stream {
            "stdout" => command.stdout(full()),
            _ => command.stderr(full()).arg("--nonsense"),
        };
        let code = command.output().unwrap().status.code();
        assert_eq!(
            code,
            Some(if stream == "stdout" { 0 } else { 2 }),
            "{stream}"
        );
    }
}
