//! How much memory a vertex spends on its bsdf.

use crate::scene::bsdfs::{Bsdf, Diffuse};
use crate::spectrum::Spectrum;

/// Every vertex of a batch holds one: no model may grow it unnoticed.
#[test]
fn bsdfs_stay_small() {
    assert_eq!(size_of::<Diffuse<Spectrum<4>>>(), 16);
    assert!(size_of::<Bsdf<Spectrum<4>>>() <= 144);
    assert!(size_of::<Bsdf<Spectrum<8>>>() <= 160);
}
