//! What the engine's variants are worth: a scene that calls for no effect by the variant for such scenes, and by the one that
//! holds every effect.
//!
//!     cargo bench --bench effects [-- --quick]
//!
//! `docs/benchmarks.md` says what is measured.

#[path = "../common/cases.rs"]
mod cases;
#[path = "../common/effort.rs"]
mod effort;
#[path = "../common/median.rs"]
mod median;
#[path = "../common/rates.rs"]
mod rates;
#[path = "../common/table.rs"]
mod table;
#[path = "../common/turns.rs"]
mod turns;

use std::collections::HashMap;
use std::error::Error;
use std::num::NonZeroUsize;
use std::sync::Arc;

use cohort::{LoadOptions, Scene};

use cases::Case;
use effort::Effort;
use rates::{Rates, median_ratio};
use table::Table;

const COLUMNS: [&str; 8] = [
    "scene",
    "colour",
    "strategy",
    "matte, Mpaths/s",
    "general, Mpaths/s",
    "ratio",
    "matte, % in Embree",
    "general, % in Embree",
];

/// A surface that is not matte.
const MIRROR: &str = r#"<scene version="3.0.0">
    <sensor type="perspective"/>
    <shape type="sphere"><bsdf type="conductor"/></shape>
</scene>"#;

fn main() -> Result<(), Box<dyn Error>> {
    let effort = Effort::from_arguments();
    let mut table = Table::new(COLUMNS);
    let mut general_scenes = HashMap::new();
    for (name, scene) in cases::scenes(effort)? {
        general_scenes.insert(name, Arc::new(with_mirror(scene)?));
    }
    for matte in Case::all(effort)? {
        println!("{}", matte.labels().join(", "));
        let general = Case {
            scene: general_scenes[matte.name].clone(),
            ..matte
        };
        let one = NonZeroUsize::MIN;
        let renders = [matte.render(one)?, general.render(one)?];
        table.push(row(&matte, &turns::in_turns(&renders, effort)));
    }
    if effort == Effort::Test {
        return Ok(());
    }
    table.publish("effects")
}

/// The same scene with one more material, which no shape has: whatever its surfaces are, the engine takes the general variant.
fn with_mirror(scene: Arc<Scene>) -> Result<Scene, Box<dyn Error>> {
    let mut scene = Arc::into_inner(scene).ok_or("the scene is in use elsewhere")?;
    let mirror = Scene::from_xml(MIRROR, &LoadOptions::default())?;
    scene.materials.extend(mirror.materials);
    assert!(!scene.is_matte());
    Ok(scene)
}

fn row(case: &Case, [matte, general]: &[Vec<Rates>; 2]) -> Vec<String> {
    let ratio = median_ratio(matte, general);
    let [matte, general] = [matte, general].map(|runs| Rates::median(runs));
    let mut row = case.labels().to_vec();
    row.extend([
        format!("{:.3}", matte.paths / 1e6),
        format!("{:.3}", general.paths / 1e6),
        format!("{ratio:.3}"),
        format!("{:.1}", 100.0 * matte.embree_share),
        format!("{:.1}", 100.0 * general.embree_share),
    ]);
    row
}
