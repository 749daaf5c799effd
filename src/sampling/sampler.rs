//! Where the random numbers of paths come from: a setting that every strategy can have.

use std::fmt::{self, Display};
use std::str::FromStr;

use serde::Serialize;
use thiserror::Error;

use super::lattice::{lattice_coordinate, lattice_coordinates};
use super::random::to_uniform;
use super::sobol::{COORDINATE_BITS, scramble};
use super::{RandomStream, Ranks, SequencePoint, StreamKey};

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
    /// At every bounce, the particles of a pixel are sorted by where they are; neighbours get neighbouring points of one
    /// lattice, randomly shifted for each pixel, bounce and use (array-RQMC: L'Ecuyer, Lécot and Tuffin 2008).
    ArrayQmc,
}

/// A name that is no sampler.
#[derive(Debug, Error)]
#[error("there is no sampler `{name}`; there are independent, sobol and array-qmc")]
pub struct UnknownSampler {
    name: String,
}

impl SamplerKind {
    /// Every sampler.
    pub const ALL: [Self; 3] = [Self::Independent, Self::Sobol, Self::ArrayQmc];

    /// The name on the command line and in metadata.
    pub fn name(self) -> &'static str {
        match self {
            Self::Independent => "independent",
            Self::Sobol => "sobol",
            Self::ArrayQmc => "array-qmc",
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

    /// Whether it is that of a camera path at its start, which has no place to be sorted by.
    fn is_of_camera(self) -> bool {
        matches!(self, Self::Camera | Self::Lens)
    }
}

/// Which kind of points stands behind what a path at a vertex chooses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Points {
    None,
    Sobol,
    Lattice,
}

/// The sequences of one pixel, in one pass.
#[derive(Clone, Copy, Debug, Default)]
pub struct PixelSequences {
    /// The scramble of the sequence with which camera paths start.
    camera: u32,
    /// That with which they go on.
    path: u32,
    /// How many samples the pixel has had in all passes before.
    before: u64,
}

impl PixelSequences {
    /// The point with which sample number `sample` of the pass starts: for [`Use::Camera`] and [`Use::Lens`].
    #[inline(always)]
    pub fn camera_point(&self, sample: u32) -> SequencePoint {
        SequencePoint::new(self.camera, self.before + u64::from(sample))
    }

    /// The point with which the path of that sample goes on.
    #[inline(always)]
    pub fn path_point(&self, sample: u32) -> SequencePoint {
        SequencePoint::new(self.path, self.before + u64::from(sample))
    }

    /// The point of the first of the particles of the pixel that are numbered by [`Ranks`]. It counts the samples of all passes before, so that passes go
    /// on with one lattice. Beyond 2^32 that begins again.
    pub(super) fn first_rank(&self) -> SequencePoint {
        SequencePoint::ranked(self.path, self.before as u32)
    }
}

/// The random numbers of one batch.
pub struct Sampler {
    kind: SamplerKind,
    stream: RandomStream,
    /// What the sequences of a pixel depend on beside it and the lessons: the seed, in two words, and the tile.
    key: [u32; 3],
    lessons: u32,
}

impl Sampler {
    /// The numbers of the batch of `key`.
    ///
    /// Passes go on with the same sequences, until there is another of the `lessons` that the render learns from what it has traced: what was learned
    /// must not depend on numbers with which it is used. Only what a camera path starts with goes on through all lessons, for nothing that was learned
    /// has a say in it: whatever it is, the estimate from there on is right in the mean.
    pub fn new(kind: SamplerKind, key: StreamKey, lessons: u32) -> Self {
        Self {
            kind,
            stream: RandomStream::new(key),
            key: [key.seed as u32, (key.seed >> 32) as u32, key.tile],
            lessons,
        }
    }

    /// Whether the numbers are those of sequences. If not, points of sequences are never looked at.
    #[inline]
    pub fn has_sequences(&self) -> bool {
        self.kind != SamplerKind::Independent
    }

    /// Whether particles carry points of sequences from vertex to vertex, and not only where they draw one of several [materials](Self::material_choice).
    pub fn carries_points(&self) -> bool {
        self.kind == SamplerKind::Sobol
    }

    /// Who numbers the particles of each pixel anew at every vertex, if they do not keep their points: for a sampler that wants them
    /// [sorted](SamplerKind::ArrayQmc).
    pub fn ranks(&self) -> Option<Ranks> {
        (self.kind == SamplerKind::ArrayQmc).then(Ranks::default)
    }

    /// The sequences of pixel number `pixel` of the batch's tile, which has had `before` samples in all passes before.
    pub fn sequences(&self, pixel: u32, before: u64) -> PixelSequences {
        let [seed_low, seed_high, tile] = self.key;
        let after = |lessons| scramble([seed_low, seed_high, tile, lessons], pixel);
        PixelSequences {
            camera: after(0),
            path: after(self.lessons),
            before,
        }
    }

    fn points(&self, what: Use) -> Points {
        match self.kind {
            SamplerKind::Independent => Points::None,
            SamplerKind::ArrayQmc if !what.is_of_camera() => Points::Lattice,
            SamplerKind::Sobol | SamplerKind::ArrayQmc => Points::Sobol,
        }
    }

    /// Up to three numbers in \[0, 1) for what each of the first `points`, `count` of them, does with them: `lanes` has one array per
    /// number, and a lane for each point.
    #[inline(always)]
    pub fn fill<const N: usize, const LANES: usize>(
        &mut self,
        points: &[SequencePoint; LANES],
        count: usize,
        what: Use,
        mut lanes: [&mut [f32; LANES]; N],
    ) {
        const { assert!(N <= 3, "the fourth dimension of a use is not its own") };
        let set = what.dimensions();
        match self.points(what) {
            Points::None => {
                for lanes in &mut lanes {
                    self.stream.fill_uniform(&mut lanes[..count]);
                }
            }
            Points::Sobol => {
                for (lane, &point) in points[..count].iter().enumerate() {
                    for (lanes, coordinate) in lanes.iter_mut().zip(point.coordinates(set)) {
                        lanes[lane] = coordinate;
                    }
                }
            }
            Points::Lattice => {
                for (lane, &point) in points.iter().enumerate() {
                    let coordinates = lattice_coordinates::<N>(point, set);
                    for (lanes, coordinate) in lanes.iter_mut().zip(coordinates) {
                        lanes[lane] = to_uniform(coordinate);
                    }
                }
            }
        }
    }

    /// A number in \[0, 1) with which the particle at `point` draws one of the materials that are mixed where it arrives after
    /// `depth` reflections.
    pub fn material_choice(&mut self, point: SequencePoint, depth: u32) -> f32 {
        let what = Use::Direction(depth);
        match self.points(what) {
            Points::None => self.stream.uniform(),
            Points::Sobol => point.coordinate(what.dimensions(), 3),
            Points::Lattice => to_uniform(lattice_coordinate(point, what.dimensions(), 3)),
        }
    }

    /// By which numbers the particles at `points` decide about their children, if not by those of the stream.
    pub fn decisions<'p>(&self, points: &'p [SequencePoint]) -> Option<Decisions<'p>> {
        let kind = self.points(Use::Light(0));
        (kind != Points::None).then_some(Decisions {
            points,
            is_lattice: kind == Points::Lattice,
        })
    }

    /// The stream of independent numbers.
    pub fn stream(&mut self) -> &mut RandomStream {
        &mut self.stream
    }
}

/// Where the particles of a population stand in their sequences: those who decide alone do so by these.
#[derive(Clone, Copy, Debug)]
pub struct Decisions<'p> {
    points: &'p [SequencePoint],
    is_lattice: bool,
}

impl Decisions<'_> {
    /// For how many particles there are points.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Whether the particles of each pixel stand in the order of their places.
    pub fn are_sorted(&self) -> bool {
        self.is_lattice
    }

    /// 32 random bits with which particle number `index` decides about its children after `depth` reflections.
    #[inline]
    pub fn bits(&self, index: usize, depth: u32, random: &mut RandomStream) -> u32 {
        let (point, set) = (self.points[index], Use::Light(depth).dimensions());
        if self.is_lattice {
            return lattice_coordinate(point, set, 3);
        }
        let high = (point.coordinate(set, 3) * (1 << COORDINATE_BITS) as f32) as u32;
        // A child that is less probable than the coordinate's last bit must stay possible.
        let low = random.bits() >> COORDINATE_BITS;
        high << (u32::BITS - COORDINATE_BITS) | low
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KEY: StreamKey = StreamKey {
        seed: 1,
        tile: 2,
        pass: 3,
    };

    /// `N` numbers for what the path at `point` does with them.
    fn numbers<const N: usize>(sampler: &mut Sampler, point: SequencePoint, what: Use) -> [f32; N] {
        let mut lanes = [[0.0; 1]; N];
        sampler.fill(&[point], 1, what, lanes.each_mut());
        lanes.map(|[number]| number)
    }

    #[test]
    fn independent_numbers_are_the_streams() {
        let mut sampler = Sampler::new(SamplerKind::Independent, KEY, 0);
        let mut stream = RandomStream::new(KEY);
        let point = sampler.sequences(4, 0).camera_point(5);
        let drawn: [f32; 3] = numbers(&mut sampler, point, Use::Camera);
        assert_eq!(drawn, [(); 3].map(|()| stream.uniform()));
        assert!(sampler.decisions(&[point]).is_none() && sampler.ranks().is_none());
        assert_eq!(sampler.stream().bits(), stream.bits());
    }

    /// Every use has dimensions that no other has, and the walk's decision one of its own.
    #[test]
    fn uses_do_not_share_dimensions() {
        for kind in [SamplerKind::Sobol, SamplerKind::ArrayQmc] {
            let mut sampler = Sampler::new(kind, KEY, 0);
            let point = sampler.sequences(4, 5).camera_point(0);
            let mut all: Vec<f32> = Vec::new();
            for what in [
                Use::Camera,
                Use::Lens,
                Use::Light(0),
                Use::Direction(0),
                Use::Light(1),
                Use::Direction(1),
            ] {
                all.extend(numbers::<3>(&mut sampler, point, what));
            }
            for depth in 0..2 {
                let bits = decide(&mut sampler, point, depth);
                all.push((bits >> 9) as f32 / (1 << COORDINATE_BITS) as f32);
                all.push(sampler.material_choice(point, depth));
            }
            for (index, one) in all.iter().enumerate() {
                assert!(!all[..index].contains(one), "{kind}: {index}");
            }
        }
    }

    fn decide(sampler: &mut Sampler, point: SequencePoint, depth: u32) -> u32 {
        let points = [point];
        let decisions = sampler.decisions(&points).expect("there are points");
        decisions.bits(0, depth, sampler.stream())
    }

    /// The bits that a coordinate does not have are random: without them, what is less probable than 2^-23 could not happen.
    #[test]
    fn decisions_have_32_random_bits() {
        let mut sampler = Sampler::new(SamplerKind::Sobol, KEY, 0);
        let point = sampler.sequences(4, 0).path_point(5);
        let drawn = [(); 4096].map(|()| decide(&mut sampler, point, 0));
        let low: std::collections::BTreeSet<u32> = drawn.iter().map(|bits| bits & 511).collect();
        assert!(low.len() > 500, "{}", low.len());
        assert!(drawn.iter().all(|bits| bits >> 9 == drawn[0] >> 9));
    }

    /// The passes of a pixel go on with one sequence: of 16 samples in two passes, one lies in each sixteenth.
    #[test]
    fn passes_share_a_sequence() {
        let mut parts = [0; 16];
        for pass in 0..2 {
            let key = StreamKey { pass, ..KEY };
            let mut sampler = Sampler::new(SamplerKind::Sobol, key, 0);
            let before = 8 * u64::from(pass);
            for sample in 0..8 {
                let point = sampler.sequences(0, before).path_point(sample);
                let [u] = numbers(&mut sampler, point, Use::Direction(3));
                parts[(u * 16.0) as usize] += 1;
            }
        }
        assert_eq!(parts, [1; 16]);
    }

    /// What was learned from some numbers never meets them again; what it has no say in goes on.
    #[test]
    fn every_lesson_begins_other_sequences_but_for_the_camera() {
        for kind in [SamplerKind::Sobol, SamplerKind::ArrayQmc] {
            let drawn = [0, 1, 2].map(|lessons| {
                let mut sampler = Sampler::new(kind, KEY, lessons);
                let sequences = sampler.sequences(4, 5);
                let camera_point = sequences.camera_point(0);
                let point = match sampler.ranks() {
                    Some(mut ranks) => ranks.next(0, &[0], &[1], &[sequences]),
                    None => sequences.path_point(0),
                };
                let [film] = numbers::<1>(&mut sampler, camera_point, Use::Camera);
                let [lens] = numbers::<1>(&mut sampler, camera_point, Use::Lens);
                let [u] = numbers::<1>(&mut sampler, point, Use::Direction(1));
                [film, lens, u].map(f32::to_bits)
            });
            for (k, goes_on) in [true, true, false].into_iter().enumerate() {
                for (one, other) in [(0, 1), (0, 2), (1, 2)] {
                    assert_eq!(
                        drawn[one][k] == drawn[other][k],
                        goes_on,
                        "{kind}: {drawn:?}"
                    );
                }
            }
        }
    }

    /// The particles of a pixel are numbered from its samples in earlier passes on, and pixels have lattices of their own.
    #[test]
    fn ranks_go_on_from_pass_to_pass() {
        // Of particles that descend from these paths, four of which belong to each of two pixels.
        let ranks = |before, paths: &[u32]| {
            let sampler = Sampler::new(SamplerKind::ArrayQmc, KEY, 0);
            let mut ranks = sampler.ranks().expect("it sorts");
            let sequences = [7, 8].map(|pixel| sampler.sequences(pixel, before));
            let pixels = [0, 0, 0, 0, 1, 1, 1, 1];
            let next = |&path| ranks.next(path, &pixels, &[4, 8], &sequences);
            paths.iter().map(next).collect()
        };
        let whole: Vec<SequencePoint> = ranks(0, &[3, 0, 1, 3, 4, 7]);
        let later: Vec<SequencePoint> = ranks(2, &[2, 0]);
        assert_eq!(whole[2..4], later);
        assert!(whole[..4].iter().all(|point| !whole[4..].contains(point)));
    }

    #[test]
    fn samplers_have_names() {
        for kind in SamplerKind::ALL {
            assert_eq!(kind.to_string().parse::<SamplerKind>().unwrap(), kind);
        }
        let message = "halton".parse::<SamplerKind>().unwrap_err().to_string();
        assert!(message.contains("halton") && message.contains("array-qmc"));
    }
}
