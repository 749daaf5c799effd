//! Stage: finished camera paths are added to their pixels.

use multiversion::multiversion;

use super::batch::CameraPaths;
use super::engine::Engine;
use super::statistics::DroppedSamples;
use crate::film::{Accumulator, FilmTile, PixelStatistics, SecondMoments, TilePixels};
use crate::room::make_room;
use crate::sampling::SamplerKind;
use crate::spectrum::{Colour, SpectrumArithmetic, xyz_from_srgb};
use crate::walk::Scope;

/// Adds every path to its pixel of the tile, where all of a pixel have the same `weight` together; those that carry no radiance count as black there, and in
/// `dropped`.
pub(super) fn expose<C: Colour>(
    engine: &Engine,
    weight: f64,
    paths: &mut CameraPaths<C>,
    tile: &mut FilmTile,
    dropped: &mut DroppedSamples,
) {
    // Paths of one population, or of one sequence, are not independent of each other: together they are one unit.
    let joint = matches!(engine.strategy.scope(), Scope::Pixel | Scope::Tile)
        || engine.settings.sampler != SamplerKind::Independent;
    find_colours(paths);
    match &mut tile.pixels {
        TilePixels::Single(pixels) => expose_pixels(paths, joint, weight, pixels, dropped),
        TilePixels::Double(pixels) => expose_pixels(paths, joint, weight, pixels, dropped),
        TilePixels::Compensated(pixels) => {
            expose_pixels(paths, joint, weight, pixels, dropped);
        }
    }
    if let Some(moments) = &mut tile.second_moments {
        expose_moments(paths, weight, moments);
    }
}

/// Finds out what the radiances of the paths are in linear sRGB.
#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512dq+avx512vl+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
fn find_colours<C: Colour>(paths: &mut CameraPaths<C>) {
    make_room(&mut paths.colour, paths.radiance.len());
    let draws = &paths.wavelength_draw;
    C::to_rgb(
        &paths.radiance,
        &paths.wavelengths,
        draws,
        &mut paths.colour,
    );
}

/// Adds the squares of the paths to their pixels.
fn expose_moments<C: Colour>(paths: &CameraPaths<C>, weight: f64, moments: &mut SecondMoments) {
    for path in 0..paths.radiance.len() {
        if let Some(rgb) = rgb(paths, path) {
            let pixel = paths.pixel(path as u32);
            let weight = weight / f64::from(paths.count(pixel as usize));
            let weight = weight * f64::from(paths.filter_weight[path]);
            let xyz = xyz_from_srgb(rgb.map(f64::from));
            moments.add((paths.pixels.start + pixel) as usize, xyz, weight);
        }
    }
}

/// Adds the paths to their pixels: those of a pixel as one unit where they are `joint`.
#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512dq+avx512vl+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
fn expose_pixels<C: Colour, A: Accumulator>(
    paths: &CameraPaths<C>,
    joint: bool,
    weight: f64,
    pixels: &mut [PixelStatistics<A>],
    dropped: &mut DroppedSamples,
) {
    let mut path = 0;
    let pixels = &mut pixels[paths.pixels.start as usize..paths.pixels.end as usize];
    for (number, pixel) in pixels.iter_mut().enumerate() {
        let samples = paths.count(number);
        let weight = weight / f64::from(samples);
        // A copy can stay in registers.
        let mut statistics = *pixel;
        let mut sum = [A::default(); 3];
        for _ in 0..samples {
            let rgb = sample(paths, path, dropped);
            path += 1;
            if joint {
                for (sum, value) in sum.iter_mut().zip(rgb) {
                    sum.add(value);
                }
            } else {
                statistics.add_unit(1, weight, rgb);
            }
        }
        if joint {
            statistics.add_unit(samples, weight, sum.map(A::total));
        }
        *pixel = statistics;
    }
}

/// The weighted colour of a finished path; black, and counted, where it is no radiance.
#[inline(always)]
fn sample<C: Colour>(
    paths: &CameraPaths<C>,
    path: usize,
    dropped: &mut DroppedSamples,
) -> [f64; 3] {
    match rgb(paths, path) {
        Some(rgb) => {
            let weight = f64::from(paths.filter_weight[path]);
            rgb.map(|value| f64::from(value) * weight)
        }
        None => {
            dropped.count(paths.radiance[path].components());
            [0.0; 3]
        }
    }
}

/// The linear sRGB colour of a finished path, if it is a radiance.
#[inline(always)]
fn rgb<C: Colour>(paths: &CameraPaths<C>, path: usize) -> Option<[f32; 3]> {
    let radiance = paths.radiance[path];
    let is_radiance = |sound, &value: &f32| sound & (0.0..=f32::MAX).contains(&value);
    let is_sound = radiance.components().iter().fold(true, is_radiance);
    is_sound.then_some(paths.colour[path])
}
