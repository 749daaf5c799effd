//! Colours of lamps texel by texel, interpolated as Mitsuba does.

use std::sync::LazyLock;

use super::cie::illuminant_d65;
use super::upsampling::SigmoidPolynomial;
use super::values::Spectrum;
use super::wavelengths::Wavelengths;

/// An image of emitted colours, in the form for three channels and in the one for wavelengths.
#[derive(Clone, Debug)]
pub struct EmissionImage {
    rgb: Vec<[f32; 3]>,
    filtered: Vec<FilteredD65>,
}

/// A point between the centres of four texels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BetweenTexels {
    /// The texels: upper left, upper right, lower left, lower right.
    pub corners: [usize; 4],
    /// Where it is between left (0) and right (1).
    pub across: f32,
    /// Where it is between above (0) and below (1).
    pub down: f32,
}

/// Daylight through a coloured filter: `scale` times the filter times D65.
#[derive(Clone, Copy, Debug)]
struct FilteredD65 {
    /// `None` is black.
    filter: Option<SigmoidPolynomial>,
    scale: f32,
}

impl EmissionImage {
    /// The image with these colours (linear sRGB, each number from 0 to 1e30), in any order.
    pub fn new(rgb: Vec<[f32; 3]>) -> Self {
        let filtered = rgb.iter().map(|&rgb| FilteredD65::of(rgb)).collect();
        Self { rgb, filtered }
    }

    /// The number of texels.
    pub fn len(&self) -> usize {
        self.rgb.len()
    }

    /// Whether there are no texels.
    pub fn is_empty(&self) -> bool {
        self.rgb.is_empty()
    }

    /// The colours of the texels, linear sRGB.
    pub fn texels(&self) -> &[[f32; 3]] {
        &self.rgb
    }

    /// The colour at a point: linear sRGB.
    #[inline]
    pub(super) fn rgb(&self, at: &BetweenTexels) -> [f32; 3] {
        let [c00, c10, c01, c11] = at.corners.map(|texel| self.rgb[texel]);
        std::array::from_fn(|i| at.mix([c00[i], c10[i], c01[i], c11[i]]))
    }

    /// The emission at a point, by wavelength. Filters and scales are interpolated on their own, as Mitsuba does.
    #[inline]
    pub(super) fn spectrum<const N: usize>(
        &self,
        at: &BetweenTexels,
        wavelengths: &Wavelengths<N>,
    ) -> Spectrum<N> {
        let texels = at.corners.map(|texel| self.filtered[texel]);
        let scale = at.mix(texels.map(|texel| texel.scale));
        Spectrum(wavelengths.nm().map(|nm| {
            let filter =
                at.mix(texels.map(|texel| texel.filter.map_or(0.0, |filter| filter.at(nm))));
            scale * filter * illuminant_d65(nm)
        }))
    }
}

impl BetweenTexels {
    #[inline]
    fn mix(&self, [above_left, above_right, below_left, below_right]: [f32; 4]) -> f32 {
        let above = above_left + self.across * (above_right - above_left);
        let below = below_left + self.across * (below_right - below_left);
        above + self.down * (below - above)
    }
}

impl FilteredD65 {
    /// The emission of a colour: the filter of the same hue whose greatest component is one half, and the scale to match.
    fn of(rgb: [f32; 3]) -> Self {
        let scale = 2.0 * rgb.into_iter().fold(0.0, f32::max);
        let filter = (scale > 0.0).then(|| TABLE.fetch(rgb.map(|channel| channel / scale)));
        Self { filter, scale }
    }
}

/// The filters of all hues: Jakob and Hanika's table (section 4) for colours whose greatest component is one half.
struct FilterTable {
    /// By greatest channel, share of the channel after the next, share of the next channel.
    filters: [Vec<SigmoidPolynomial>; 3],
}

/// Nodes along each axis of the table, as in Mitsuba's.
const NODES: usize = 64;

static TABLE: LazyLock<FilterTable> = LazyLock::new(FilterTable::new);

impl FilterTable {
    fn new() -> Self {
        let share = |node: usize| 0.5 * node as f32 / (NODES - 1) as f32;
        let filters = std::array::from_fn(|greatest| {
            let grey = SigmoidPolynomial::fit([0.5; 3]);
            let mut filters = vec![grey; NODES * NODES];
            // From grey towards the saturated colours, each from its neighbour.
            for last in (0..NODES).rev() {
                for next in (0..NODES).rev() {
                    let neighbour = match (last, next) {
                        _ if next + 1 < NODES => last * NODES + next + 1,
                        _ if last + 1 < NODES => (last + 1) * NODES + next,
                        _ => continue,
                    };
                    let mut rgb = [0.5; 3];
                    rgb[(greatest + 1) % 3] = share(next);
                    rgb[(greatest + 2) % 3] = share(last);
                    filters[last * NODES + next] = filters[neighbour].refit(rgb);
                }
            }
            filters
        });
        Self { filters }
    }

    /// The filter for a colour whose greatest component is one half.
    fn fetch(&self, rgb: [f32; 3]) -> SigmoidPolynomial {
        let greatest = (1..3).fold(0, |best, channel| {
            if rgb[channel] >= rgb[best] {
                channel
            } else {
                best
            }
        });
        let node = |channel: usize| {
            let position = (rgb[channel % 3] * 2.0 * (NODES - 1) as f32).clamp(0.0, 63.0);
            let node = (position as usize).min(NODES - 2);
            (node, position - node as f32)
        };
        let (next, across) = node(greatest + 1);
        let (last, down) = node(greatest + 2);
        let upper_left = last * NODES + next;
        let corners =
            [0, 1, NODES, NODES + 1].map(|step| self.filters[greatest][upper_left + step]);
        SigmoidPolynomial::mix(corners, across, down)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::SpectralCurve;

    const NM: [f32; 4] = [410.0, 480.0, 550.0, 650.0];

    fn at(corners: [usize; 4], across: f32, down: f32) -> BetweenTexels {
        BetweenTexels {
            corners,
            across,
            down,
        }
    }

    /// At a texel, an image and a colour of its own are the same but for the table's interpolation.
    #[test]
    fn texels_are_colours() {
        let mut colours = vec![[0.0; 3], [2.0, 2.0, 2.0], [1e30, 1e-30, 1e-3]];
        for i in 0..400_u32 {
            let part = |step: u32| ((i * step) % 97) as f32 / 97.0;
            colours.push([part(13), part(29), part(41)]);
        }
        let image = EmissionImage::new(colours.clone());
        let wavelengths = Wavelengths::at(NM);
        for (texel, rgb) in colours.into_iter().enumerate() {
            assert_eq!(image.rgb(&at([texel; 4], 0.0, 0.0)), rgb);
            let values = image.spectrum(&at([texel; 4], 0.3, 0.9), &wavelengths);
            let curve = SpectralCurve::rgb_emission(rgb).unwrap();
            let expected = curve.evaluate(&wavelengths);
            let greatest = rgb.into_iter().fold(0.0, f32::max);
            for (value, expected) in values.0.iter().zip(expected.0) {
                assert!(
                    (value - expected).abs() <= 0.02 * greatest,
                    "{rgb:?}: {values:?}"
                );
            }
        }
    }

    #[test]
    fn points_lie_between_texels() {
        let image = EmissionImage::new(vec![[1.0; 3], [2.0; 3], [4.0; 3], [8.0; 3]]);
        let point = at([0, 1, 2, 3], 0.25, 0.5);
        let expected = 0.5 * (1.25 + 5.0);
        assert_eq!(image.rgb(&point), [expected; 3]);
        let white = SpectralCurve::rgb_emission([1.0; 3]).unwrap();
        let wavelengths = Wavelengths::at(NM);
        let values = image.spectrum(&point, &wavelengths);
        for (value, white) in values.0.iter().zip(white.evaluate(&wavelengths).0) {
            assert!((value / white - expected).abs() < 1e-4);
        }
    }
}
