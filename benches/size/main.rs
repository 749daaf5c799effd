//! Cost against size: time and memory for meshes of 10^3 to 10^7 triangles and for images of 256^2 to 4096^2 pixels.
//!
//!     scripts/size-study.sh [--quick]
//!
//! `docs/benchmarks.md` says what is measured.

#[path = "../common/effort.rs"]
mod effort;
mod fit;
#[path = "../common/median.rs"]
mod median;
mod memory;
mod process;
mod rows;
mod study;
mod subject;
#[path = "../common/table.rs"]
mod table;
mod worker;

use std::env;
use std::error::Error;
use std::path::Path;

use effort::Effort;
use process::WORKER;
use study::Measured;
use subject::Subject;
use table::Table;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = env::args().skip(1);
    if let (Some(WORKER), Some(subject)) = (arguments.next().as_deref(), arguments.next()) {
        return worker::serve(&serde_json::from_str(&subject)?);
    }
    let effort = Effort::from_arguments();
    let meshes = measure(Subject::meshes(effort), effort)?;
    let images = measure(Subject::images(effort), effort)?;
    if effort == Effort::Test {
        return Ok(());
    }
    let mut table = Table::new(rows::COLUMNS);
    rows::push_meshes(&mut table, &meshes);
    rows::push_images(&mut table, &images);
    table.publish("size")
}

/// Makes the meshes of `subjects` and measures them.
fn measure(mut subjects: Vec<Subject>, effort: Effort) -> Result<Vec<Measured>, Box<dyn Error>> {
    let folder = tempfile::tempdir_in(Path::new(env!("CARGO_TARGET_TMPDIR")))?;
    for (index, subject) in subjects.iter_mut().enumerate() {
        subject.make_mesh(folder.path().join(index.to_string()))?;
    }
    study::measure(subjects, effort.choose(1, 2, 3))
}
