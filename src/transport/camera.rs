//! Stage: camera paths start.

use std::ops::Range;

use glam::Vec2;
use multiversion::multiversion;

use super::batch::{CameraPaths, Segments};
use super::engine::{Engine, TileJob};
use super::lineage::first_births;
use super::variant::{Scattering, Variant, carries_points};
use crate::film::{FilmTile, PixelFilter};
use crate::lanes::CHUNK;
use crate::sampling::{Sampler, SequencePoint, SolidAnglePdf, Use};
use crate::scene::{CameraRayLanes, Refraction};
use crate::spectrum::{Colour, SpectrumArithmetic};

/// Starts the paths of the `pixels` of the tile, pixel by pixel: as many of each as `job.counts` says.
#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512dq+avx512vl+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
pub(super) fn start<C: Colour, V: Variant>(
    engine: &Engine,
    job: &TileJob<'_>,
    tile: &FilmTile,
    pixels: Range<u32>,
    sampler: &mut Sampler,
    paths: &mut CameraPaths<C>,
    segments: &mut Segments<C>,
) {
    let has_lens = engine.camera.has_lens();
    let count = paths.restart(pixels.clone(), job.counts);
    paths.find_sequences(sampler, tile);
    let carries_points = carries_points::<V>(sampler);
    segments.restart(0, count);
    let mut points = [SequencePoint::default(); CHUNK];
    let mut numbers = [[0.0; CHUNK]; 3];
    // A pinhole looks at no point of a lens.
    let mut lens_numbers = [[0.5; CHUNK]; 2];
    let mut raster = [[0.0; CHUNK]; 2];
    let mut rays = CameraRayLanes::new();
    let mut next = Sample::default();
    let mut pixel = Pixel::of(engine, tile, pixels.start as usize);
    for start in (0..count).step_by(CHUNK) {
        let chunk = start..count.min(start + CHUNK);
        if sampler.has_sequences() {
            let mut at = next;
            for point in &mut points[..chunk.len()] {
                let sequences = &paths.sequences[at.pixel];
                *point = sequences.camera_point(at.sample);
                if carries_points {
                    segments.point.push(sequences.path_point(at.sample));
                }
                at.advance(&paths.ends);
            }
        }
        if C::RANDOM_NUMBERS > 0 {
            sampler.fill(&points, chunk.len(), Use::Camera, numbers.each_mut());
        } else {
            let [u, v, _] = &mut numbers;
            sampler.fill(&points, chunk.len(), Use::Camera, [u, v]);
        }
        if has_lens {
            sampler.fill(&points, chunk.len(), Use::Lens, lens_numbers.each_mut());
        }
        let [film_u, film_v, wavelength_u] = &numbers;
        C::sample_wavelengths(
            wavelength_u,
            chunk.len(),
            &mut paths.wavelengths,
            &mut paths.wavelength_draw,
        );
        for lane in 0..chunk.len() {
            if next.sample == 0 {
                pixel = Pixel::of(engine, tile, pixels.start as usize + next.pixel);
            }
            next.advance(&paths.ends);
            let film = pixel.filter.sample([film_u[lane], film_v[lane]]);
            paths.filter_weight.push(film.weight);
            [raster[0][lane], raster[1][lane]] = (pixel.centre + film.offset).to_array();
        }
        engine.camera.rays(&raster, &lens_numbers, &mut rays);
        rays.copy_to(segments.rays.as_mut(), chunk);
    }
    segments.path.extend(0..count as u32);
    segments.throughput.resize(count, C::Spectrum::ONE);
    // No other technique draws what the camera sees.
    let certain = SolidAnglePdf(f32::INFINITY);
    segments.direction_pdf.resize(count, certain);
    if V::REFRACTS {
        segments.refraction.resize(count, Refraction::NONE);
    }
    paths.radiance.resize(count, C::Spectrum::ZERO);
    if job.learns {
        first_births(&mut segments.births, count);
    }
    engine.emission.prepare(paths);
    V::Scattering::prepare(engine, paths);
}

/// A pixel on the film.
struct Pixel<'f> {
    /// Its centre in raster space, in pixels from the corner of the whole film.
    centre: Vec2,
    filter: PixelFilter<'f>,
}

impl<'f> Pixel<'f> {
    /// That with this index in the tile.
    #[inline(always)]
    fn of(engine: &'f Engine, tile: &FilmTile, index: usize) -> Self {
        let (x, y) = tile.position(index);
        let crop = engine.scene.film.crop;
        let corner = Vec2::new(crop.x as f32, crop.y as f32);
        Self {
            centre: corner + Vec2::new(x as f32 + 0.5, y as f32 + 0.5),
            filter: engine.filter.pixel(x, y),
        }
    }
}

/// A sample of a pixel.
#[derive(Clone, Copy, Default)]
struct Sample {
    /// Its number within the batch.
    path: u32,
    /// The number of the pixel within the batch.
    pixel: usize,
    /// Its number within the pixel.
    sample: u32,
}

impl Sample {
    /// Goes on to the next sample of a pixel, or to the first of the next pixel: `ends` has the first of the next one for each.
    #[inline(always)]
    fn advance(&mut self, ends: &[u32]) {
        self.path += 1;
        self.sample += 1;
        if self.path == ends[self.pixel] {
            self.sample = 0;
            self.pixel += 1;
        }
    }
}
