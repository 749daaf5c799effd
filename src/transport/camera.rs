//! Stage: camera paths start.

use glam::Vec2;
use multiversion::multiversion;

use super::batch::{CameraPaths, Segments};
use super::engine::{Engine, TileJob};
use super::variant::Variant;
use crate::film::FilmTile;
use crate::lanes::CHUNK;
use crate::sampling::{Sampler, SequencePoint, SolidAnglePdf, Use};
use crate::scene::Refraction;
use crate::spectrum::{Colour, SpectrumArithmetic};

/// Starts `job.samples` paths for every pixel of the tile, pixel by pixel.
#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512dq+avx512vl+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
pub(super) fn start<C: Colour, V: Variant>(
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
    let mut points = [SequencePoint::default(); CHUNK];
    let mut numbers = [[0.0; CHUNK]; 3];
    // A pinhole looks at no point of a lens.
    let mut lens_numbers = [[0.5; CHUNK]; 2];
    let (mut pixel, mut sample) = (0, 0);
    for start in (0..count).step_by(CHUNK) {
        let chunk = start..count.min(start + CHUNK);
        let (first_pixel, first_sample) = (pixel, sample);
        for point in &mut points[..chunk.len()] {
            *point = sampler.point(pixel, job.first_sample + u64::from(sample));
            advance(&mut pixel, &mut sample, job.samples);
        }
        let points = &points[..chunk.len()];
        if C::RANDOM_NUMBERS > 0 {
            sampler.fill(points, Use::Camera, numbers.each_mut());
        } else {
            let [u, v, _] = &mut numbers;
            sampler.fill(points, Use::Camera, [u, v]);
        }
        if has_lens {
            sampler.fill(points, Use::Lens, lens_numbers.each_mut());
        }
        let [film_u, film_v, wavelength_u] = &numbers;
        let [lens_u, lens_v] = &lens_numbers;
        // Not by `extend`: the closure would be compiled for any processor.
        for &u in &wavelength_u[..chunk.len()] {
            paths.wavelengths.push(C::sample_wavelengths(u));
        }
        (pixel, sample) = (first_pixel, first_sample);
        for (lane, path) in chunk.enumerate() {
            let (x, y) = tile.position(pixel as usize);
            advance(&mut pixel, &mut sample, job.samples);
            let film = engine.filter.sample(x, y, [film_u[lane], film_v[lane]]);
            paths.filter_weight.push(film.weight);
            let centre = corner + Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
            let lens = [lens_u[lane], lens_v[lane]];
            let ray = engine.camera.ray(centre + film.offset, lens);
            segments.rays.set(
                path,
                ray.origin.into(),
                ray.direction.into(),
                ray.near,
                ray.far,
            );
            segments.push(
                path as u32,
                C::Spectrum::ONE,
                points[lane],
                SolidAnglePdf(f32::INFINITY),
            );
        }
    }
    if V::REFRACTS {
        segments.refraction.resize(count, Refraction::NONE);
    }
    paths.radiance.resize(count, C::Spectrum::ZERO);
    engine.emission.prepare(paths);
}

/// Goes on to the next of the `samples` of a pixel, or to the first of the next pixel.
#[inline(always)]
fn advance(pixel: &mut u32, sample: &mut u32, samples: u32) {
    *sample += 1;
    if *sample == samples {
        *sample = 0;
        *pixel += 1;
    }
}
