//! OpenEXR: the channels R, G, B (and A), or Y (and A), of the first layer that has them.

use std::io::{Read, Seek};

use exr::prelude::{
    AnyChannels, Error, FlatSamples, Layer, MetaData, ReadChannels, ReadLayers, Vec2,
};

use super::{Channels, Encoding, ImageFile, size};

/// What every OpenEXR file starts with.
pub(super) const MAGIC: &[u8] = &[0x76, 0x2f, 0x31, 0x01];

/// Reads an OpenEXR file.
pub(super) fn read(mut file: impl Read + Seek) -> Result<ImageFile, String> {
    let damaged = |error: Error| error.to_string();
    let headers = MetaData::read_from_buffered(&mut file, false)
        .map_err(damaged)?
        .headers;
    for header in &headers {
        size(
            header.layer_size.width() as u64,
            header.layer_size.height() as u64,
        )?;
    }
    file.rewind().map_err(|error| error.to_string())?;
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .non_parallel()
        .from_buffered(file)
        .map_err(damaged)?;
    image.layer_data.iter().find_map(layer).ok_or_else(|| {
        let names = headers
            .iter()
            .flat_map(|header| header.channels.list.iter())
            .map(|channel| channel.name.to_string());
        let names: Vec<String> = names.collect();
        format!(
            "it needs the channels R, G and B, or Y; it has: {}",
            names.join(", ")
        )
    })?
}

/// The image of a layer, or `None` where it has no channels of a known name.
fn layer(layer: &Layer<AnyChannels<FlatSamples>>) -> Option<Result<ImageFile, String>> {
    let find = |name: &str| {
        let mut channels = layer.channel_data.list.iter();
        channels.find(|channel| channel.name == *name)
    };
    let all = |names: &[&str]| -> Option<Vec<_>> { names.iter().map(|name| find(name)).collect() };
    let (channels, columns) = None
        .or_else(|| Some((Channels::Rgba, all(&["R", "G", "B", "A"])?)))
        .or_else(|| Some((Channels::Rgb, all(&["R", "G", "B"])?)))
        .or_else(|| Some((Channels::GreyAlpha, all(&["Y", "A"])?)))
        .or_else(|| Some((Channels::Grey, all(&["Y"])?)))?;
    let image = || {
        let size = size(layer.size.width() as u64, layer.size.height() as u64)?;
        if columns.iter().any(|channel| channel.sampling != Vec2(1, 1)) {
            return Err("channels of less resolution than the image are not supported".to_owned());
        }
        let count = channels.count();
        let mut values = vec![0.0; count * size.pixels()];
        for (first, channel) in columns.iter().enumerate() {
            let places = values[first..].iter_mut().step_by(count);
            for (place, value) in places.zip(channel.sample_data.values_as_f32()) {
                *place = value;
            }
        }
        Ok(ImageFile {
            size,
            channels,
            encoding: Encoding::Linear,
            values,
        })
    };
    Some(image())
}
