//! Where the random numbers of paths come from: a setting that every strategy can have.

use std::fmt::{self, Display};
use std::str::FromStr;

use serde::Serialize;
use thiserror::Error;

use super::sobol::COORDINATE_BITS;
use super::{RandomStream, SequencePoint, StreamKey};

/// How the random numbers of paths are chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum SamplerKind {
    /// Each independent of all others, from a Mersenne Twister as in the paper.
    #[default]
    Independent,
    /// The samples of a pixel are the points of one Owen-scrambled Sobol sequence: a path's every choice is a dimension, in
    /// which the samples are spread evenly. Pixels have scrambles of their own.
    Sobol,
}

/// A name that is no sampler.
#[derive(Debug, Error)]
#[error("there is no sampler `{name}`; there are independent and sobol")]
pub struct UnknownSampler {
    name: String,
}

impl SamplerKind {
    /// Every sampler.
    pub const ALL: [Self; 2] = [Self::Independent, Self::Sobol];

    /// The name on the command line and in metadata.
    pub fn name(self) -> &'static str {
        match self {
            Self::Independent => "independent",
            Self::Sobol => "sobol",
        }
    }
}

impl Display for SamplerKind {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for SamplerKind {
    type Err = UnknownSampler;

    fn from_str(text: &str) -> Result<Self, UnknownSampler> {
        let mut all = Self::ALL.into_iter();
        all.find(|kind| kind.name() == text)
            .ok_or_else(|| UnknownSampler {
                name: text.to_owned(),
            })
    }
}

/// What a path chooses: each use has dimensions of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// Where on the film, and which wavelengths.
    Camera,
    /// Where on the lens.
    Lens,
    /// Which light, and which point of it, from the vertex after this many reflections.
    Light(u32),
    /// The direction in which it leaves that vertex.
    Direction(u32),
}

impl Use {
    /// Its four dimensions in a sequence; the fourth of the light's is that of the walk's [`decision`], the fourth of the
    /// direction's that of the [material](Sampler::material_choice).
    fn dimensions(self) -> u32 {
        match self {
            Self::Camera => 0,
            // Beyond all depths: a scramble of its own.
            Self::Lens => 1 << 31,
            Self::Light(depth) => 2 * depth + 1,
            Self::Direction(depth) => 2 * depth + 2,
        }
    }
}

/// The random numbers of one batch.
pub struct Sampler {
    kind: SamplerKind,
    stream: RandomStream,
    key: StreamKey,
}

impl Sampler {
    /// The numbers of the batch of `key`.
    pub fn new(kind: SamplerKind, key: StreamKey) -> Self {
        Self {
            kind,
            stream: RandomStream::new(key),
            key,
        }
    }

    /// Whether the numbers are those of sequences. If not, points of sequences are never looked at.
    #[inline]
    pub fn has_sequences(&self) -> bool {
        self.kind == SamplerKind::Sobol
    }

    /// The point of sample number `index` of pixel number `pixel` of the batch's tile, over all passes.
    pub fn point(&self, pixel: u32, index: u64) -> SequencePoint {
        let seed = self.key.seed;
        let key = [seed as u32, (seed >> 32) as u32, self.key.tile, pixel];
        SequencePoint::new(key, index)
    }

    /// Up to three numbers in \[0, 1) for what the path at `point` does with them.
    #[inline(always)]
    pub fn numbers<const N: usize>(&mut self, point: SequencePoint, what: Use) -> [f32; N] {
        const { assert!(N <= 3, "the fourth dimension of a use is not its own") };
        match self.kind {
            SamplerKind::Independent => std::array::from_fn(|_| self.stream.uniform()),
            SamplerKind::Sobol => {
                let coordinates = point.coordinates(what.dimensions());
                std::array::from_fn(|i| coordinates[i])
            }
        }
    }

    /// As [`Self::numbers`] for each of the first `points`, `count` of them: `lanes` has one array per number, and a lane for each
    /// point.
    #[inline(always)]
    pub fn fill<const N: usize, const LANES: usize>(
        &mut self,
        points: &[SequencePoint; LANES],
        count: usize,
        what: Use,
        mut lanes: [&mut [f32; LANES]; N],
    ) {
        match self.kind {
            SamplerKind::Independent => {
                for lanes in &mut lanes {
                    self.stream.fill_uniform(&mut lanes[..count]);
                }
            }
            SamplerKind::Sobol => {
                for (lane, &point) in points[..count].iter().enumerate() {
                    let coordinates = point.coordinates(what.dimensions());
                    for (lanes, coordinate) in lanes.iter_mut().zip(coordinates) {
                        lanes[lane] = coordinate;
                    }
                }
            }
        }
    }

    /// A number in \[0, 1) with which the particle at `point` draws one of the materials that are mixed where it arrives after
    /// `depth` reflections.
    pub fn material_choice(&mut self, point: SequencePoint, depth: u32) -> f32 {
        match self.kind {
            SamplerKind::Independent => self.stream.uniform(),
            SamplerKind::Sobol => point.coordinate(Use::Direction(depth).dimensions(), 3),
        }
    }

    /// The stream of independent numbers.
    pub fn stream(&mut self) -> &mut RandomStream {
        &mut self.stream
    }
}

/// 32 random bits with which the particle at `point` decides about its children after `depth` reflections.
#[inline]
pub fn decision(point: SequencePoint, depth: u32, random: &mut RandomStream) -> u32 {
    let coordinate = point.coordinate(Use::Light(depth).dimensions(), 3);
    let high = (coordinate * (1 << COORDINATE_BITS) as f32) as u32;
    // A child that is less probable than the coordinate's last bit must stay possible.
    let low = random.bits() >> COORDINATE_BITS;
    high << (u32::BITS - COORDINATE_BITS) | low
}

#[cfg(test)]
mod tests {
    use super::*;

    const KEY: StreamKey = StreamKey {
        seed: 1,
        tile: 2,
        pass: 3,
    };

    #[test]
    fn independent_numbers_are_the_streams() {
        let mut sampler = Sampler::new(SamplerKind::Independent, KEY);
        let mut stream = RandomStream::new(KEY);
        let point = sampler.point(4, 5);
        let drawn: [f32; 3] = sampler.numbers(point, Use::Camera);
        assert_eq!(drawn, [(); 3].map(|()| stream.uniform()));
        assert_eq!(sampler.stream().bits(), stream.bits());
    }

    /// Every use has dimensions that no other has, and the walk's decision one of its own.
    #[test]
    fn uses_do_not_share_dimensions() {
        let mut sampler = Sampler::new(SamplerKind::Sobol, KEY);
        let point = sampler.point(4, 5);
        let mut all: Vec<f32> = Vec::new();
        for what in [
            Use::Camera,
            Use::Lens,
            Use::Light(0),
            Use::Direction(0),
            Use::Light(1),
            Use::Direction(1),
        ] {
            all.extend(sampler.numbers::<3>(point, what));
        }
        for depth in 0..2 {
            let bits = decision(point, depth, sampler.stream());
            all.push((bits >> 9) as f32 / (1 << COORDINATE_BITS) as f32);
            all.push(sampler.material_choice(point, depth));
        }
        for (index, one) in all.iter().enumerate() {
            assert!(!all[..index].contains(one), "{index}");
        }
    }

    /// The bits that a coordinate does not have are random: without them, what is less probable than 2^-23 could not happen.
    #[test]
    fn decisions_have_32_random_bits() {
        let mut sampler = Sampler::new(SamplerKind::Sobol, KEY);
        let point = sampler.point(4, 5);
        let drawn = [(); 4096].map(|()| decision(point, 0, sampler.stream()));
        let low: std::collections::BTreeSet<u32> = drawn.iter().map(|bits| bits & 511).collect();
        assert!(low.len() > 500, "{}", low.len());
        assert!(drawn.iter().all(|bits| bits >> 9 == drawn[0] >> 9));
    }

    /// The passes of a pixel go on with one sequence: of 16 samples in two passes, one lies in each sixteenth.
    #[test]
    fn passes_share_a_sequence() {
        let mut parts = [0; 16];
        for pass in 0..2 {
            let mut sampler = Sampler::new(SamplerKind::Sobol, StreamKey { pass, ..KEY });
            for index in 8 * u64::from(pass)..8 * (u64::from(pass) + 1) {
                let point = sampler.point(0, index);
                let [u] = sampler.numbers(point, Use::Direction(3));
                parts[(u * 16.0) as usize] += 1;
            }
        }
        assert_eq!(parts, [1; 16]);
    }

    #[test]
    fn samplers_have_names() {
        for kind in SamplerKind::ALL {
            assert_eq!(kind.to_string().parse::<SamplerKind>().unwrap(), kind);
        }
        let message = "halton".parse::<SamplerKind>().unwrap_err().to_string();
        assert!(message.contains("halton") && message.contains("sobol"));
    }
}
