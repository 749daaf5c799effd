//! A device keeps to its number of threads. Alone in its process, so that the threads can be counted.
#![cfg(target_os = "linux")]

use std::num::NonZeroUsize;
use std::sync::Arc;

use cohort::embree::{
    BuildOptions, Device, EmbreeError, QuadMesh, Scene, SceneBuilder, VertexBuffer,
};

/// The threads of this process.
fn threads() -> usize {
    std::fs::read_dir("/proc/self/task").map_or(0, Iterator::count)
}

/// A scene large enough for Embree to build it with all its threads.
fn build(threads: usize) -> Result<Scene, EmbreeError> {
    let device = Device::new(NonZeroUsize::new(threads).unwrap_or(NonZeroUsize::MIN))?;
    let side = 300_u32;
    let corners = (0..side * side).map(|i| {
        let (x, y) = ((i % side) as f32, (i / side) as f32);
        [x, y, (0.1 * x).sin() * (0.1 * y).cos()]
    });
    let quads = (0..side - 1).flat_map(|y| {
        (0..side - 1).map(move |x| {
            let a = y * side + x;
            [a, a + 1, a + side + 1, a + side]
        })
    });
    let mesh = QuadMesh::new(
        Arc::new(VertexBuffer::new(corners)),
        Arc::new(quads.collect()),
    )?;
    let mut builder = SceneBuilder::new(&device, BuildOptions::default());
    builder.add_quads(mesh);
    builder.build()
}

#[test]
fn one_thread_is_really_one_and_three_are_at_most_two_more() -> Result<(), EmbreeError> {
    let before = threads();
    let one = build(1)?;
    assert_eq!(threads(), before, "a device of one thread started others");
    let three = build(3)?;
    assert!(threads() > before, "a device of three threads started none");
    assert!(
        threads() <= before + 2,
        "a device of three threads started {}",
        threads() - before
    );
    drop((one, three));
    Ok(())
}
