//! What an eye makes of the difference between two images: LDR-FLIP.
//!
//! Andersson et al., FLIP: A Difference Evaluator for Alternating Images, HPG 2020, by NVIDIA's own implementation in the
//! crate `nv-flip`, for its default viewing distance (67 pixels per degree).

use nv_flip::{DEFAULT_PIXELS_PER_DEGREE, FlipImageRgb8};

use crate::film::{Image, srgb_bytes};

/// The mean over pixels of LDR-FLIP between the tone-mapped images, in [0, 1]; 0 for equal ones.
///
/// # Panics
/// Where the images differ in size.
pub(super) fn mean_flip(image: &Image, reference: &Image) -> f64 {
    let [image, reference] = [image, reference].map(|image| {
        let size = image.size();
        FlipImageRgb8::with_data(size.width, size.height, &srgb_bytes(image))
    });
    let map = nv_flip::flip(reference, image, DEFAULT_PIXELS_PER_DEGREE).to_vec();
    map.iter().map(|value| f64::from(*value)).sum::<f64>() / map.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::ImageSize;

    fn flat(value: [f32; 3]) -> Image {
        let mut image = Image::black(ImageSize {
            width: 24,
            height: 24,
        });
        for index in 0..24 * 24 {
            *image.pixel_mut(index % 24, index / 24) = value;
        }
        image
    }

    #[test]
    fn equal_images_differ_by_nothing_and_opposites_by_almost_all() {
        let green = flat([0.0, 0.7, 0.0]);
        let blue = flat([0.0, 0.0, 0.7]);
        assert_eq!(mean_flip(&green, &green), 0.0);
        let (near, far) = (
            mean_flip(&flat([0.0, 0.65, 0.0]), &green),
            mean_flip(&blue, &green),
        );
        assert!(near > 0.01 && near < 0.5, "{near}");
        assert!(far > 0.7 && far <= 1.0, "{far}");
    }

    #[test]
    fn lamps_are_compared_as_they_are_shown() {
        let (lamp, brighter) = (flat([40.0; 3]), flat([80.0; 3]));
        assert!(mean_flip(&brighter, &lamp) < 0.01);
    }
}
