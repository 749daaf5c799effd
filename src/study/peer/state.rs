//! What a peer has rendered so far: it goes on in turns, and can be kept in a file between them.

use serde::{Deserialize, Serialize};

use super::{MitsubaPeer, PeerError, SeedSequence};
use crate::film::Image;
use crate::render::StopFlag;
use crate::scene::ImageSize;

/// How many chunks a turn is made of, about: enough to learn the speed, few enough to cost nothing.
const CHUNKS_PER_TURN: f64 = 20.0;
/// Seconds of a chunk where the target is not a time.
const CHUNK_SECONDS: f64 = 1.0;

/// The sum of all chunks of one repetition.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PeerState {
    width: u32,
    height: u32,
    /// Per pixel and channel, the sum of the samples.
    sums: Vec<[f64; 3]>,
    samples_per_pixel: u64,
    seconds: f64,
    seeds: SeedSequence,
    /// Seconds of one sample of every pixel, in the last chunk.
    seconds_per_sample: Option<f64>,
}

/// Where a turn ends, counted from the beginning of the repetition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PeerTarget {
    /// At so many seconds of rendering. The turn ends where it comes nearest: at most half a sample per pixel off,
    /// as far as the speed can be foretold.
    Seconds(f64),
    /// At so many samples per pixel.
    SamplesPerPixel(u64),
}

impl PeerState {
    /// Nothing yet.
    pub fn new(size: ImageSize, seeds: SeedSequence) -> Self {
        Self {
            width: size.width,
            height: size.height,
            sums: vec![[0.0; 3]; size.pixels()],
            samples_per_pixel: 0,
            seconds: 0.0,
            seeds,
            seconds_per_sample: None,
        }
    }

    /// Renders on, chunk by chunk, until the target is reached or somebody asks to stop. After an error the chunks
    /// before it are kept.
    pub fn advance(
        &mut self,
        peer: &mut MitsubaPeer,
        target: PeerTarget,
        stop: &StopFlag,
    ) -> Result<(), PeerError> {
        if peer.size() != self.size() {
            return Err(PeerError::OtherSize {
                kept: self.size(),
                new: peer.size(),
            });
        }
        let chunk_seconds = match target {
            PeerTarget::Seconds(until) => (until - self.seconds) / CHUNKS_PER_TURN,
            PeerTarget::SamplesPerPixel(_) => CHUNK_SECONDS,
        };
        while !stop.is_raised() {
            let speed = self.seconds_per_sample.unwrap_or(peer.seconds_per_sample());
            let samples = self.next_chunk(target, chunk_seconds, speed);
            if samples == 0 {
                break;
            }
            let samples = samples.min(u64::from(peer.most_samples())) as u32;
            self.render(peer, samples)?;
        }
        Ok(())
    }

    /// Samples per pixel of the next chunk at `speed` seconds each; 0 at the target.
    fn next_chunk(&self, target: PeerTarget, chunk_seconds: f64, speed: f64) -> u64 {
        let chunk = ((chunk_seconds / speed) as u64).max(1);
        match target {
            // Half of what is left, at the end: the speed of a busy machine cannot be foretold, and what it gets wrong
            // then is a share of a small chunk.
            PeerTarget::Seconds(until) => {
                let left = ((until - self.seconds) / speed).round() as u64;
                chunk.min(left.div_ceil(2))
            }
            PeerTarget::SamplesPerPixel(until) => {
                chunk.min(until.saturating_sub(self.samples_per_pixel))
            }
        }
    }

    fn render(&mut self, peer: &mut MitsubaPeer, samples: u32) -> Result<(), PeerError> {
        let Some(seed) = self.seeds.next() else {
            return Ok(());
        };
        let chunk = peer.render(samples, seed)?;
        let count = f64::from(chunk.samples_per_pixel);
        for (sum, mean) in self.sums.iter_mut().zip(&chunk.image) {
            for (sum, mean) in sum.iter_mut().zip(mean) {
                *sum += f64::from(*mean) * count;
            }
        }
        self.samples_per_pixel += u64::from(chunk.samples_per_pixel);
        self.seconds += chunk.seconds;
        self.seconds_per_sample = Some(chunk.seconds / count);
        Ok(())
    }

    /// Size of the image.
    pub fn size(&self) -> ImageSize {
        ImageSize {
            width: self.width,
            height: self.height,
        }
    }

    /// Seconds of rendering so far.
    pub fn seconds(&self) -> f64 {
        self.seconds
    }

    /// Samples of each pixel so far.
    pub fn samples_per_pixel(&self) -> u64 {
        self.samples_per_pixel
    }

    /// The mean of all samples, linear sRGB; black before the first.
    pub fn image(&self) -> Image {
        let mut image = Image::black(self.size());
        let share = 1.0 / self.samples_per_pixel.max(1) as f64;
        for (index, sum) in self.sums.iter().enumerate() {
            let (x, y) = (index as u32 % self.width, index as u32 / self.width);
            *image.pixel_mut(x, y) = sum.map(|channel| (channel * share) as f32);
        }
        image
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Advances a state by what a renderer of this speed would take, which varies by a tenth from chunk to chunk.
    fn seconds_by(until: f64, overhead: f64, per_sample: f64) -> f64 {
        let size = ImageSize {
            width: 1,
            height: 1,
        };
        let mut state = PeerState::new(size, SeedSequence::new(size, 0, 0, 1));
        let mut speed = 3.0 * per_sample;
        for chunk in 0.. {
            let target = PeerTarget::Seconds(until);
            let samples = state.next_chunk(target, until / CHUNKS_PER_TURN, speed) as f64;
            if samples == 0.0 {
                break;
            }
            let varied = if chunk % 2 == 0 { 0.9 } else { 1.1 };
            let seconds = overhead + samples * per_sample * varied;
            state.seconds += seconds;
            speed = seconds / samples;
        }
        state.seconds
    }

    #[test]
    fn turns_end_within_one_percent() {
        for overhead in [0.0, 0.02] {
            for per_sample in [0.001, 0.02, 0.15] {
                let off = seconds_by(10.0, overhead, per_sample) / 10.0 - 1.0;
                assert!(off.abs() < 0.01, "{overhead} {per_sample}: {off}");
            }
        }
    }

    #[test]
    fn samples_are_counted_to_the_last() {
        let size = ImageSize {
            width: 1,
            height: 1,
        };
        let mut state = PeerState::new(size, SeedSequence::new(size, 0, 0, 1));
        let target = PeerTarget::SamplesPerPixel(25);
        assert_eq!(state.next_chunk(target, 1.0, 0.1), 10);
        state.samples_per_pixel = 20;
        assert_eq!(state.next_chunk(target, 1.0, 0.1), 5);
        state.samples_per_pixel = 25;
        assert_eq!(state.next_chunk(target, 1.0, 0.1), 0);
    }
}
