//! Reconstruction by filter importance sampling (Ernst, Stamminger and Greiner 2006): sample positions are drawn from
//! the filter about a pixel's centre, so that every pixel is a plain weighted mean of samples of its own.
//!
//! Pixels then share no samples: tiles are independent of each other, and each pixel knows its own variance.

use glam::Vec2;

use crate::scene::{FilmDescription, ReconstructionFilter};

/// Bins of a profile's piecewise constant density; the weight makes up for what the bins get wrong.
const BINS: usize = 128;

/// Where a camera sample lies and what it counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilterSample {
    /// Offset from the centre of the pixel, in pixels.
    pub offset: Vec2,
    /// Filter over density, normalised: its mean is 1. Negative in the negative lobes of a filter.
    pub weight: f32,
}

/// Draws positions for the samples of each pixel of a film.
#[derive(Clone, Debug)]
pub struct FilterSampler {
    columns: Axis,
    rows: Axis,
}

/// Draws positions for the samples of one pixel.
#[derive(Clone, Copy, Debug)]
pub struct PixelFilter<'f> {
    column: &'f Profile,
    row: &'f Profile,
}

/// The filter along one axis of the film, for every distance to its two borders.
#[derive(Clone, Debug)]
struct Axis {
    length: u32,
    /// From this distance on (in pixels) the filter does not reach a border.
    reach: u32,
    /// By the distances to the first and to the last pixel, each up to `reach`.
    profiles: Vec<Profile>,
}

/// The filter's profile over the interval in which samples may lie.
#[derive(Clone, Debug)]
struct Profile {
    filter: ReconstructionFilter,
    start: f32,
    bin_width: f32,
    /// The distribution function at the upper end of each bin.
    cumulative: Vec<f32>,
    /// One over the filter's integral over the interval.
    normalisation: f32,
}

impl FilterSampler {
    /// The sampler for a film. Unless the film has `sample_border`, no sample lies outside its crop window, and pixels
    /// near the border are means over the part of the filter that is inside (as in Mitsuba).
    pub fn new(film: &FilmDescription) -> Self {
        let axis = |length| Axis::new(film.filter, length, film.sample_border);
        Self {
            columns: axis(film.crop.size.width),
            rows: axis(film.crop.size.height),
        }
    }

    /// That of the pixel in column `x` and row `y` of the crop window.
    #[inline(always)]
    pub fn pixel(&self, x: u32, y: u32) -> PixelFilter<'_> {
        PixelFilter {
            column: self.columns.profile(x),
            row: self.rows.profile(y),
        }
    }
}

impl PixelFilter<'_> {
    /// Draws a position from uniform numbers in [0, 1).
    #[inline(always)]
    pub fn sample(&self, u: [f32; 2]) -> FilterSample {
        let (column, row) = (self.column.sample(u[0]), self.row.sample(u[1]));
        FilterSample {
            offset: Vec2::new(column.offset, row.offset),
            weight: column.weight * row.weight,
        }
    }
}

impl Axis {
    fn new(filter: ReconstructionFilter, length: u32, sample_border: bool) -> Self {
        let reach = if sample_border {
            0
        } else {
            (filter.radius() - 0.5).ceil().max(0.0) as u32
        };
        // A distance beyond what the film is long never occurs.
        let reach = reach.min(length);
        let limit = |distance: u32| match distance {
            d if d < reach => (d as f32 + 0.5).min(filter.radius()),
            _ => filter.radius(),
        };
        let profiles = (0..=reach)
            .flat_map(|before| (0..=reach).map(move |after| (before, after)))
            .map(|(before, after)| Profile::new(filter, -limit(before), limit(after)))
            .collect();
        Self {
            length,
            reach,
            profiles,
        }
    }

    #[inline(always)]
    fn profile(&self, pixel: u32) -> &Profile {
        let before = pixel.min(self.reach);
        let after = (self.length - 1 - pixel).min(self.reach);
        &self.profiles[(before * (self.reach + 1) + after) as usize]
    }
}

/// A position along one axis.
struct AxisSample {
    offset: f32,
    weight: f32,
}

impl Profile {
    fn new(filter: ReconstructionFilter, start: f32, end: f32) -> Self {
        let bins = if filter == ReconstructionFilter::Box {
            1
        } else {
            BINS
        };
        let bin_width = (end - start) / bins as f32;
        let (mut mass, mut integral) = (Vec::with_capacity(bins), 0.0);
        const POINTS: usize = 32;
        for bin in 0..bins {
            let mut absolute = 0.0;
            for point in 0..POINTS {
                let x = start + (bin as f32 + (point as f32 + 0.5) / POINTS as f32) * bin_width;
                let value = filter.profile(f64::from(x)) * f64::from(bin_width) / POINTS as f64;
                absolute += value.abs();
                integral += value;
            }
            mass.push(absolute);
        }
        let total: f64 = mass.iter().sum();
        let mut sum = 0.0;
        let mut cumulative: Vec<f32> = mass
            .iter()
            .map(|m| {
                sum += m / total;
                sum as f32
            })
            .collect();
        if let Some(last) = cumulative.last_mut() {
            *last = 1.0;
        }
        Self {
            filter,
            start,
            bin_width,
            cumulative,
            normalisation: (1.0 / integral) as f32,
        }
    }

    #[inline(always)]
    fn sample(&self, u: f32) -> AxisSample {
        if self.filter == ReconstructionFilter::Box {
            return AxisSample {
                offset: self.start + u * self.bin_width,
                weight: 1.0,
            };
        }
        self.sample_bins(u)
    }

    /// The same by the piecewise constant density.
    #[inline]
    fn sample_bins(&self, u: f32) -> AxisSample {
        let last = self.cumulative.len() - 1;
        let bin = self.cumulative.partition_point(|&c| c <= u).min(last);
        let below = if bin == 0 {
            0.0
        } else {
            self.cumulative[bin - 1]
        };
        let probability = self.cumulative[bin] - below;
        let within = ((u - below) / probability).clamp(0.0, 1.0);
        let offset = self.start + (bin as f32 + within) * self.bin_width;
        let density = probability / self.bin_width;
        let value = self.filter.profile(f64::from(offset)) as f32;
        AxisSample {
            offset,
            weight: value * self.normalisation / density,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::{RandomStream, StreamKey};

    fn film(filter: ReconstructionFilter) -> FilmDescription {
        FilmDescription {
            filter,
            ..FilmDescription::new(7, 5).unwrap()
        }
    }

    const FILTERS: [ReconstructionFilter; 4] = [
        ReconstructionFilter::Box,
        ReconstructionFilter::Tent { radius: 1.0 },
        ReconstructionFilter::Gaussian { stddev: 0.5 },
        ReconstructionFilter::Mitchell {
            b: 1.0 / 3.0,
            c: 1.0 / 3.0,
        },
    ];

    #[test]
    fn the_weighted_mean_of_a_function_is_its_filtered_value() {
        // Along x, of cos(x): a closed form is not needed, a fine quadrature of the filter over the film will do.
        for filter in FILTERS {
            let sampler = FilterSampler::new(&film(filter));
            for pixel in 0..7 {
                let mut random = RandomStream::new(StreamKey {
                    seed: 3,
                    tile: pixel,
                    pass: 0,
                });
                let (mut sum, mut weights) = (0.0, 0.0);
                let n = 100_000;
                for _ in 0..n {
                    let sample = sampler.pixel(pixel, 2).sample(random.uniform_2d());
                    let x = pixel as f32 + 0.5 + sample.offset.x;
                    assert!(
                        (0.0..=7.0).contains(&x),
                        "{filter:?}: sample at {x} is outside the film"
                    );
                    sum += f64::from(sample.weight * x.cos()) / f64::from(n);
                    weights += f64::from(sample.weight) / f64::from(n);
                }
                let (mut want, mut norm) = (0.0, 0.0);
                for i in 0..70_000 {
                    let x = 7.0 * (f64::from(i) + 0.5) / 70_000.0;
                    let f = filter.profile(x - f64::from(pixel) - 0.5);
                    want += f * x.cos();
                    norm += f;
                }
                assert!(
                    (weights - 1.0).abs() < 0.02,
                    "{filter:?} {pixel}: {weights}"
                );
                assert!(
                    (sum - want / norm).abs() < 0.02,
                    "{filter:?} {pixel}: {sum} {}",
                    want / norm
                );
            }
        }
    }

    #[test]
    fn with_sample_border_the_whole_filter_counts_everywhere() {
        let mut film = film(ReconstructionFilter::Tent { radius: 1.5 });
        film.sample_border = true;
        let sampler = FilterSampler::new(&film);
        assert!(sampler.pixel(0, 0).sample([0.0, 0.5]).offset.x < -1.4);
    }
}
