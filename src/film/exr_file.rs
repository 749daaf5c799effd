//! OpenEXR files: the image in linear sRGB, with everything about how it was made as attributes.

use std::path::Path;

use exr::meta::attribute::{AttributeValue, Chromaticities, Text};
use exr::prelude::*;

use super::{FilmFileError, Image, WholeFile};
use crate::scene::{ImageSize, PixelFormat};
use crate::spectrum::xyz_from_srgb;

/// How an EXR is written.
#[derive(Clone, Debug)]
pub struct ExrOptions {
    /// Which channels.
    pub format: PixelFormat,
    /// 16-bit instead of 32-bit numbers.
    pub half_precision: bool,
    /// Camera paths of each pixel, row by row from the top, for a channel `samples` of their own; none where all
    /// pixels have the same number. Ignored where the length is not that of the image.
    pub samples: Option<Vec<u32>>,
    /// The variance of every pixel's mean, for channels `variance.R`, `variance.G` and `variance.B` of 32-bit numbers.
    /// Ignored where its size is not that of the image.
    pub variance: Option<Image>,
    /// The moments of the samples, for channels of 32-bit numbers of their own.
    pub moments: Option<ExrMoments>,
    /// Attributes: name and value.
    pub attributes: Vec<(String, String)>,
}

/// The moments of samples: Mitsuba's channels `NAME.X`, `NAME.Y`, `NAME.Z` with the mean of every pixel in CIE XYZ, and the
/// same with `m2_` before them for the means of the squares.
#[derive(Clone, Debug)]
pub struct ExrMoments {
    /// What the channels are called.
    pub name: String,
    /// The means of X^2, Y^2 and Z^2. Without effect where its size is not that of the image.
    pub second: Image,
}

impl Default for ExrOptions {
    fn default() -> Self {
        Self {
            format: PixelFormat::Rgb,
            half_precision: false,
            samples: None,
            variance: None,
            moments: None,
            attributes: Vec::new(),
        }
    }
}

/// The channels of a variance image, in the order of its values.
const VARIANCE_CHANNELS: [&str; 3] = ["variance.R", "variance.G", "variance.B"];

/// Writes an image as EXR: scan lines, ZIP compression, primaries of ITU-R BT.709.
pub fn write_exr(
    path: &Path,
    image: &Image,
    options: &ExrOptions,
) -> std::result::Result<(), FilmFileError> {
    let size = image.size();
    let column = |value: &dyn Fn(&[f32; 3]) -> f32| {
        let values = image.pixels().iter().map(value);
        if options.half_precision {
            FlatSamples::F16(values.map(f16::from_f32).collect())
        } else {
            FlatSamples::F32(values.collect())
        }
    };
    // Channels of an EXR stand in alphabetical order.
    let mut channels: SmallVec<[AnyChannel<FlatSamples>; 4]> = match options.format {
        PixelFormat::Rgb => [("B", 2), ("G", 1), ("R", 0)]
            .into_iter()
            .map(|(name, channel)| AnyChannel::new(name, column(&|pixel| pixel[channel])))
            .collect(),
        PixelFormat::Luminance => {
            let luminance = |p: &[f32; 3]| 0.212_671 * p[0] + 0.715_160 * p[1] + 0.072_169 * p[2];
            std::iter::once(AnyChannel::new("Y", column(&luminance))).collect()
        }
    };
    if let Some(samples) = &options.samples
        && samples.len() == size.pixels()
    {
        channels.push(AnyChannel::new(
            "samples",
            FlatSamples::U32(samples.clone()),
        ));
    }
    if let Some(variance) = &options.variance
        && variance.size() == size
    {
        for (channel, name) in VARIANCE_CHANNELS.into_iter().enumerate() {
            // Never in half precision, which ends at 6e-8: squares of small errors.
            let values = variance.pixels().iter().map(|pixel| pixel[channel]);
            channels.push(AnyChannel::new(name, FlatSamples::F32(values.collect())));
        }
    }
    if let Some(moments) = &options.moments
        && moments.second.size() == size
    {
        channels.extend(moment_channels(image, moments));
    }
    let mut attributes = LayerAttributes {
        software_name: Some(Text::from(concat!("cohort ", env!("CARGO_PKG_VERSION")))),
        ..LayerAttributes::default()
    };
    for (name, value) in &options.attributes {
        if let (Some(name), Some(value)) = (Text::new_or_none(name), Text::new_or_none(value)) {
            attributes.other.insert(name, AttributeValue::Text(value));
        }
    }
    let layer = Layer::new(
        Vec2(size.width as usize, size.height as usize),
        attributes,
        Encoding {
            compression: Compression::ZIP16,
            blocks: Blocks::ScanLines,
            line_order: LineOrder::Increasing,
        },
        AnyChannels::sort(channels),
    );
    let mut file = exr::image::Image::from_layer(layer);
    file.attributes.chromaticities = Some(Chromaticities {
        red: Vec2(0.64, 0.33),
        green: Vec2(0.30, 0.60),
        blue: Vec2(0.15, 0.06),
        white: Vec2(0.3127, 0.3290),
    });
    WholeFile::create(path)?.finish(|writer| {
        file.write()
            .to_buffered(writer)
            .map_err(|error| FilmFileError::Encode {
                path: path.to_owned(),
                message: error.to_string(),
            })
    })
}

/// The channels of the first moments, which are those of `image`, and of the second.
fn moment_channels<'i>(
    image: &'i Image,
    moments: &'i ExrMoments,
) -> impl Iterator<Item = AnyChannel<FlatSamples>> + 'i {
    const AXES: [&str; 3] = ["X", "Y", "Z"];
    let channel = |name: String, values: Vec<f32>| {
        // Never in half precision, which ends at 65504: squares of bright pixels.
        AnyChannel::new(&*name, FlatSamples::F32(values))
    };
    let name = &moments.name;
    let first = AXES.into_iter().enumerate().map(move |(axis, letter)| {
        let xyz = |rgb: &[f32; 3]| xyz_from_srgb(rgb.map(f64::from))[axis] as f32;
        let values = image.pixels().iter().map(xyz).collect();
        channel(format!("{name}.{letter}"), values)
    });
    let second = AXES.into_iter().enumerate().map(move |(axis, letter)| {
        let values = moments.second.pixels().iter().map(|pixel| pixel[axis]);
        channel(format!("m2_{name}.{letter}"), values.collect())
    });
    first.chain(second)
}

/// Reads the R, G and B channels of an EXR.
pub fn read_exr(path: &Path) -> std::result::Result<Image, FilmFileError> {
    let refuse = |message: String| FilmFileError::Read {
        path: path.to_owned(),
        message,
    };
    let file = exr::prelude::read_first_rgba_layer_from_file(
        path,
        |resolution, _| (resolution.width(), vec![[0.0_f32; 3]; resolution.area()]),
        |(width, pixels), position, (r, g, b, _): (f32, f32, f32, f32)| {
            pixels[position.y() * *width + position.x()] = [r, g, b];
        },
    )
    .map_err(|error| refuse(error.to_string()))?;
    let resolution = file.layer_data.size;
    let side = |n: usize| u32::try_from(n).map_err(|_| refuse("it is too large".into()));
    let size = ImageSize {
        width: side(resolution.width())?,
        height: side(resolution.height())?,
    };
    let mut image = Image::black(size);
    let (_, pixels) = file.layer_data.channel_data.pixels;
    for (index, pixel) in pixels.into_iter().enumerate() {
        *image.pixel_mut(index as u32 % size.width, index as u32 / size.width) = pixel;
    }
    Ok(image)
}

/// Reads the channels `variance.R`, `variance.G` and `variance.B` of an EXR; `None` where it does not have all three.
pub fn read_exr_variance(path: &Path) -> std::result::Result<Option<Image>, FilmFileError> {
    let refuse = |message: String| FilmFileError::Read {
        path: path.to_owned(),
        message,
    };
    let file = read_first_flat_layer_from_file(path).map_err(|error| refuse(error.to_string()))?;
    let layer = file.layer_data;
    let channels = VARIANCE_CHANNELS.map(|name| {
        let mut list = layer.channel_data.list.iter();
        list.find(|channel| channel.name == *name)
    });
    let [Some(red), Some(green), Some(blue)] = channels else {
        return Ok(None);
    };
    let side = |n: usize| u32::try_from(n).map_err(|_| refuse("it is too large".into()));
    let mut variance = Image::black(ImageSize {
        width: side(layer.size.width())?,
        height: side(layer.size.height())?,
    });
    let columns = [red, green, blue].map(|channel| channel.sample_data.values_as_f32());
    for (channel, values) in columns.into_iter().enumerate() {
        for (index, value) in values.enumerate() {
            let (x, y) = (index % layer.size.width(), index / layer.size.width());
            variance.pixel_mut(x as u32, y as u32)[channel] = value;
        }
    }
    Ok(Some(variance))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let mut image = Image::black(ImageSize {
            width: 3,
            height: 2,
        });
        *image.pixel_mut(2, 1) = [1.5, -0.25, 1e6];
        *image.pixel_mut(0, 0) = [0.1, 0.2, 0.3];
        let options = ExrOptions {
            attributes: vec![("cohort:strategy".into(), "roulette".into())],
            ..ExrOptions::default()
        };
        write_exr(&path, &image, &options).unwrap();
        assert_eq!(read_exr(&path).unwrap(), image);
        let meta = MetaData::read_from_file(&path, false).unwrap();
        let attribute = meta.headers[0]
            .own_attributes
            .other
            .get(&Text::from("cohort:strategy"));
        assert_eq!(
            attribute,
            Some(&AttributeValue::Text(Text::from("roulette")))
        );
    }

    #[test]
    fn unequal_sample_counts_get_a_channel() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let image = Image::black(ImageSize {
            width: 3,
            height: 1,
        });
        let options = ExrOptions {
            samples: Some(vec![4, 5, 6]),
            ..ExrOptions::default()
        };
        write_exr(&path, &image, &options).unwrap();
        let file = read_first_flat_layer_from_file(&path).unwrap();
        let channels = &file.layer_data.channel_data.list;
        let samples = channels.iter().find(|channel| channel.name == *"samples");
        assert_eq!(
            samples.unwrap().sample_data,
            FlatSamples::U32(vec![4, 5, 6])
        );
        assert_eq!(read_exr(&path).unwrap(), image);
    }

    #[test]
    fn a_variance_stands_beside_the_image() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let size = ImageSize {
            width: 3,
            height: 2,
        };
        let mut image = Image::black(size);
        *image.pixel_mut(1, 1) = [0.5, 0.25, 2.0];
        let mut variance = Image::black(size);
        *variance.pixel_mut(0, 1) = [1e-9, 2e-9, 3e-9];
        let mut options = ExrOptions {
            half_precision: true,
            ..ExrOptions::default()
        };
        write_exr(&path, &image, &options).unwrap();
        assert_eq!(read_exr_variance(&path).unwrap(), None);
        options.variance = Some(variance.clone());
        write_exr(&path, &image, &options).unwrap();
        assert_eq!(read_exr(&path).unwrap(), image);
        assert_eq!(read_exr_variance(&path).unwrap(), Some(variance));
    }

    #[test]
    fn moments_stand_beside_the_image() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let mut image = Image::black(ImageSize {
            width: 2,
            height: 1,
        });
        *image.pixel_mut(1, 0) = [1.0; 3];
        let mut second = image.clone();
        *second.pixel_mut(0, 0) = [7.0, 8.0, 1e6];
        let options = ExrOptions {
            half_precision: true,
            moments: Some(ExrMoments {
                name: "inner".into(),
                second,
            }),
            ..ExrOptions::default()
        };
        write_exr(&path, &image, &options).unwrap();
        let file = read_first_flat_layer_from_file(&path).unwrap();
        let channels = &file.layer_data.channel_data.list;
        let values = |name: &str| -> Vec<f32> {
            let channel = channels.iter().find(|channel| channel.name == *name);
            channel.unwrap().sample_data.values_as_f32().collect()
        };
        assert_eq!(values("m2_inner.Z"), [1e6, 1.0]);
        assert_eq!(values("m2_inner.X"), [7.0, 1.0]);
        // The white of sRGB.
        let white = [
            ("inner.X", 0.950_456),
            ("inner.Y", 1.0),
            ("inner.Z", 1.088_754),
        ];
        for (name, expected) in white {
            let [black, white] = values(name)[..] else {
                panic!()
            };
            assert_eq!(black, 0.0);
            assert!((white - expected).abs() < 1e-5, "{name}: {white}");
        }
        assert_eq!(channels.len(), 9);
        assert_eq!(read_exr(&path).unwrap(), image);
    }

    #[test]
    fn a_missing_file_is_an_error() {
        assert!(read_exr(Path::new("no such file.exr")).is_err());
        assert!(read_exr_variance(Path::new("no such file.exr")).is_err());
    }
}
