//! Every form of call against intersections by brute force, user geometry against closed forms, and instances against both.

mod brute_force;
mod forms;
mod instances;
mod plain_c_forms;
mod quads;
mod user_geometry;

use std::num::NonZeroUsize;

use super::{BuildOptions, BuildQuality, Device};

fn device() -> Device {
    Device::new(NonZeroUsize::MIN).expect("Embree starts")
}

fn all_options() -> Vec<BuildOptions> {
    let qualities = [BuildQuality::Low, BuildQuality::Medium, BuildQuality::High];
    let mut options = Vec::new();
    for quality in qualities {
        for robust in [false, true] {
            for compact in [false, true] {
                options.push(BuildOptions {
                    quality,
                    robust,
                    compact,
                });
            }
        }
    }
    options
}

#[test]
fn the_version_is_the_one_built_for() {
    let version = super::version().expect("Embree starts");
    assert_eq!(version.major, if cfg!(embree4) { 4 } else { 3 });
    assert_eq!(version.to_string().split('.').count(), 3);
    println!("Embree {version}");
}

/// Numbers from 0 to 1 that look random (splitmix64).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (bits ^ (bits >> 31)) as u32 as f32 / u32::MAX as f32
    }

    /// A point of the cube from -1 to 1.
    fn point(&mut self) -> [f32; 3] {
        std::array::from_fn(|_| 2.0 * self.next() - 1.0)
    }
}
