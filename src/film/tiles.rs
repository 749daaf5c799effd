//! The film as tiles, each owned by whoever renders it.

use serde::{Deserialize, Serialize};

use super::{FilmSums, Image, PixelStatistics, SecondMoments, TilePixels};
use crate::scene::ImageSize;

/// Side of a tile in pixels.
pub const TILE_SIDE: u32 = 16;

/// A square of the film (less at the right and lower border).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FilmTile {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// Its size.
    pub size: ImageSize,
    /// Its pixels, row by row.
    pub pixels: TilePixels,
    /// The second moments of their samples, if the film was asked for them.
    pub second_moments: Option<SecondMoments>,
}

impl FilmTile {
    /// The tile without samples whose first column and row are `x` and `y`, on a film of size `film`.
    fn new([x, y]: [u32; 2], film: ImageSize, sums: FilmSums) -> Self {
        let size = Self::size_at([x, y], film);
        Self {
            x,
            y,
            size,
            pixels: TilePixels::new(sums, size.pixels()),
            second_moments: None,
        }
    }

    /// The size of the tile whose first column and row are `x` and `y`, on a film of size `film`.
    fn size_at([x, y]: [u32; 2], film: ImageSize) -> ImageSize {
        ImageSize {
            width: TILE_SIDE.min(film.width - x),
            height: TILE_SIDE.min(film.height - y),
        }
    }

    /// The same tile without samples, whose pixels add up in `sums`.
    pub fn without_samples(&self, sums: FilmSums) -> Self {
        Self {
            pixels: TilePixels::new(sums, self.size.pixels()),
            second_moments: None,
            ..*self
        }
    }

    /// Column and row on the film of the pixel with this index in [`Self::pixels`].
    #[inline]
    pub fn position(&self, index: usize) -> (u32, u32) {
        let index = index as u32;
        (
            self.x + index % self.size.width,
            self.y + index / self.size.width,
        )
    }
}

/// The sums of all pixels of the crop window, tile by tile.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Film {
    size: ImageSize,
    tiles: Vec<FilmTile>,
}

impl Film {
    /// A film without samples, which adds up in `sums`.
    pub fn new(size: ImageSize, sums: FilmSums) -> Self {
        let tiles = corners(size)
            .map(|corner| FilmTile::new(corner, size, sums))
            .collect();
        Self { size, tiles }
    }

    /// The same film, which also adds up the second moments of its samples.
    pub fn with_second_moments(mut self) -> Self {
        for tile in &mut self.tiles {
            tile.second_moments = Some(SecondMoments::new(tile.pixels.count()));
        }
        self
    }

    /// Whether this is like `Film::new(size, sums)` but for its samples, and, if `second_moments`, like that
    /// [with them](Self::with_second_moments). What was loaded from a file may be anything.
    pub fn is_like_new(&self, size: ImageSize, sums: FilmSums, second_moments: bool) -> bool {
        let is_at = |tile: &FilmTile, [x, y]: [u32; 2]| {
            let count = tile.size.pixels();
            [tile.x, tile.y] == [x, y]
                && tile.size == FilmTile::size_at([x, y], size)
                && tile.pixels.sums() == sums
                && tile.pixels.count() == count
                && tile.second_moments.as_ref().map(SecondMoments::count)
                    == second_moments.then_some(count)
        };
        self.size == size
            && self.tiles.len() == Self::tile_count(size)
            && corners(size)
                .zip(&self.tiles)
                .all(|(corner, tile)| is_at(tile, corner))
    }

    /// How many tiles a film of `size` has.
    pub fn tile_count(size: ImageSize) -> usize {
        corners(size).count()
    }

    /// Size in pixels.
    pub fn size(&self) -> ImageSize {
        self.size
    }

    /// The tiles, row by row.
    pub fn tiles(&self) -> &[FilmTile] {
        &self.tiles
    }

    /// The tiles, row by row.
    pub fn tiles_mut(&mut self) -> &mut [FilmTile] {
        &mut self.tiles
    }

    /// The mean of every pixel.
    pub fn image(&self) -> Image {
        self.map(|pixel| pixel.mean().map(|value| value as f32))
    }

    /// The variance of the mean of every pixel, or `None` if one does not know it.
    pub fn variance(&self) -> Option<Image> {
        let known = self.pixels().all(|pixel| pixel.units >= 2);
        known.then(|| {
            self.map(|pixel| {
                pixel
                    .variance_of_mean()
                    .unwrap_or_default()
                    .map(|v| v as f32)
            })
        })
    }

    /// The mean over the samples of every pixel of X^2, Y^2 and Z^2 (CIE), if the film adds them up.
    pub fn second_moments(&self) -> Option<Image> {
        let mut image = Image::black(self.size);
        for tile in &self.tiles {
            let moments = tile.second_moments.as_ref()?;
            for (index, pixel) in tile.pixels.iter().enumerate() {
                let (x, y) = tile.position(index);
                let mean = moments.mean(index, pixel.weight);
                *image.pixel_mut(x, y) = mean.map(|value| value as f32);
            }
        }
        Some(image)
    }

    /// The pixels in no particular order.
    pub fn pixels(&self) -> impl Iterator<Item = PixelStatistics> {
        self.tiles.iter().flat_map(|tile| tile.pixels.iter())
    }

    /// The number of camera paths of every pixel, row by row from the top, or `None` where all have the same.
    pub fn unequal_samples(&self) -> Option<Vec<u32>> {
        let first = self.pixels().next()?.samples;
        if self.pixels().all(|pixel| pixel.samples == first) {
            return None;
        }
        let mut samples = vec![0; self.size.pixels()];
        for tile in &self.tiles {
            for (index, pixel) in tile.pixels.iter().enumerate() {
                let (x, y) = tile.position(index);
                let place = y as usize * self.size.width as usize + x as usize;
                samples[place] = u32::try_from(pixel.samples).unwrap_or(u32::MAX);
            }
        }
        Some(samples)
    }

    fn map(&self, value: impl Fn(&PixelStatistics) -> [f32; 3]) -> Image {
        let mut image = Image::black(self.size);
        for tile in &self.tiles {
            for (index, pixel) in tile.pixels.iter().enumerate() {
                let (x, y) = tile.position(index);
                *image.pixel_mut(x, y) = value(&pixel);
            }
        }
        image
    }
}

/// First column and row of every tile of a film of `size`, row by row.
fn corners(size: ImageSize) -> impl Iterator<Item = [u32; 2]> {
    let starts = |length: u32| (0..length).step_by(TILE_SIDE as usize);
    starts(size.height).flat_map(move |y| starts(size.width).map(move |x| [x, y]))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: ImageSize = ImageSize {
        width: 37,
        height: 18,
    };

    fn doubles(tile: &mut FilmTile) -> &mut [PixelStatistics] {
        match &mut tile.pixels {
            TilePixels::Double(pixels) => pixels,
            other => panic!("{:?}", other.sums()),
        }
    }

    #[test]
    fn tiles_cover_every_pixel_once() {
        let mut film = Film::new(SIZE, FilmSums::Double);
        for tile in film.tiles_mut() {
            for index in 0..tile.pixels.count() {
                let (x, y) = tile.position(index);
                doubles(tile)[index].add_unit(1, 1.0, [f64::from(x), f64::from(y), 1.0]);
            }
        }
        let image = film.image();
        for y in 0..18 {
            for x in 0..37 {
                assert_eq!(image.pixel(x, y), [x as f32, y as f32, 1.0]);
            }
        }
        assert!(film.pixels().all(|pixel| pixel.samples == 1));
        assert_eq!((film.variance(), film.unequal_samples()), (None, None));
        doubles(&mut film.tiles_mut()[0])[1].add_unit(2, 1.0, [0.0; 3]);
        assert_eq!(film.unequal_samples().unwrap()[..3], [1, 3, 1]);
    }

    #[test]
    fn a_film_with_other_tiles_is_told() {
        let film = Film::new(SIZE, FilmSums::Single);
        assert!(film.is_like_new(SIZE, FilmSums::Single, false));
        assert!(!film.is_like_new(SIZE, FilmSums::Double, false));
        assert!(!film.is_like_new(SIZE, FilmSums::Single, true));
        let (mut less, mut moved, mut cut) = (film.clone(), film.clone(), film.clone());
        less.tiles.pop();
        moved.tiles.swap(0, 1);
        cut.tiles[2].pixels = TilePixels::new(FilmSums::Single, 5);
        for broken in [less, moved, cut] {
            assert!(!broken.is_like_new(SIZE, FilmSums::Single, false));
        }
        let mut film = film.with_second_moments();
        assert!(film.is_like_new(SIZE, FilmSums::Single, true));
        assert!(!film.is_like_new(SIZE, FilmSums::Single, false));
        film.tiles[1].second_moments = Some(SecondMoments::new(5));
        assert!(!film.is_like_new(SIZE, FilmSums::Single, true));
    }

    #[test]
    fn second_moments_are_means_of_squares() {
        let mut film = Film::new(SIZE, FilmSums::Double);
        assert_eq!(film.second_moments(), None);
        film = film.with_second_moments();
        let tile = &mut film.tiles_mut()[1];
        doubles(tile)[2].add_unit(4, 1.0, [0.0; 3]);
        let moments = tile.second_moments.as_mut().unwrap();
        moments.add(2, [1.0, 2.0, -3.0], 1.0);
        moments.add(2, [0.0, 2.0, 1.0], -0.5);
        let image = film.second_moments().unwrap();
        assert_eq!(image.pixel(18, 0), [0.25, 0.5, 2.125]);
        assert_eq!(image.pixel(17, 0), [0.0; 3]);
    }
}
