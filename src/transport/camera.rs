//! Stage: camera paths start.

use glam::Vec2;
use multiversion::multiversion;

use super::batch::{CameraPaths, Segments};
use super::engine::{Engine, TileJob};
use crate::film::FilmTile;
use crate::sampling::{Sampler, SolidAnglePdf, Use};
use crate::spectrum::{Colour, SpectrumArithmetic};

/// Starts `job.samples` paths for every pixel of the tile, pixel by pixel.
#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512dq+avx512vl+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
pub(super) fn start<C: Colour>(
    engine: &Engine,
    job: &TileJob,
    tile: &FilmTile,
    sampler: &mut Sampler,
    paths: &mut CameraPaths<C>,
    segments: &mut Segments<C>,
) {
    let has_lens = engine.camera.has_lens();
    let crop = engine.scene.film.crop;
    let corner = Vec2::new(crop.x as f32, crop.y as f32);
    let count = tile.pixels.count() * job.samples as usize;
    paths.restart(count);
    segments.restart(count);
    for pixel in 0..tile.pixels.count() {
        let (x, y) = tile.position(pixel);
        let centre = corner + Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
        for index in 0..job.samples {
            let point = sampler.point(pixel as u32, job.first_sample + u64::from(index));
            let [film_u, film_v, wavelength_u] = if C::RANDOM_NUMBERS > 0 {
                sampler.numbers(point, Use::Camera)
            } else {
                let [u, v] = sampler.numbers(point, Use::Camera);
                [u, v, 0.0]
            };
            let sample = engine.filter.sample(x, y, [film_u, film_v]);
            let index = paths.radiance.len();
            paths.wavelengths.push(C::sample_wavelengths(wavelength_u));
            paths.radiance.push(C::Spectrum::ZERO);
            paths.filter_weight.push(sample.weight);
            let lens = if has_lens {
                sampler.numbers(point, Use::Lens)
            } else {
                [0.5; 2]
            };
            let ray = engine.camera.ray(centre + sample.offset, lens);
            segments.push(
                index as u32,
                C::Spectrum::ONE,
                point,
                false,
                SolidAnglePdf(f32::INFINITY),
            );
            segments.rays.set(
                index,
                ray.origin.into(),
                ray.direction.into(),
                ray.near,
                ray.far,
            );
        }
    }
}
